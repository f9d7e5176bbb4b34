#include "controllers/partitioning/partition_message.h"

#include <limits>

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

TEST(PartitionMessage, SurvivesItsTenBytes) {
  for (int state = 0; state < kPartitioningStates; ++state) {
    for (int step = 0; step < kHandoverSteps; ++step) {
      const PartitionMessage message{.from_robot = true,
                                     .state = static_cast<PartitioningState>(state),
                                     .carrying = step % 2 == 1,
                                     .step = static_cast<HandoverStep>(step),
                                     .self = 99,
                                     .partner = static_cast<std::uint8_t>(state),
                                     .partition_length = 0.1F + static_cast<float>(state)};
      EXPECT_EQ(DecodePartition(Encode(message)), message);
    }
  }
}

TEST(PartitionMessage, WhatNobodyCanHaveSaidComesFromNobody) {
  EXPECT_FALSE(DecodePartition({}).from_robot);
  EXPECT_FALSE(DecodePartition({6}).from_robot);
  EXPECT_FALSE(DecodePartition({1, 0, 5}).from_robot);
  EXPECT_TRUE(DecodePartition({1, 0, 4}).from_robot);
}

}  // namespace
}  // namespace gauntlet::controllers
