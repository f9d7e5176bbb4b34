#include "controllers/partitioning/partition_length.h"

#include <cmath>

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

PartitionLengthSettings Signed() {
  return {.rule = PartitionLengthSettings::Rule::kSigned,
          .start = 0.5,
          .least = 0.5,
          .most = 3.5,
          .gain = 20.0,
          .balance = 50.0};
}

TEST(PartitionLength, StaticNeverChanges) {
  PartitionLength length({.start = 2.0});
  length.Succeed();
  length.Fail();
  length.Fail();
  EXPECT_EQ(length.value(), 2.0);
}

TEST(PartitionLength, SignedGoesTenCentimetresUpOrDownWithinItsLimits) {
  PartitionLength length(Signed());
  length.Fail();
  EXPECT_EQ(length.value(), 0.5);
  length.Succeed();
  EXPECT_NEAR(length.value(), 0.6, 1e-12);
  for (int i = 0; i < 50; ++i) length.Succeed();
  EXPECT_EQ(length.value(), 3.5);
  length.Fail();
  EXPECT_NEAR(length.value(), 3.4, 1e-12);
  PartitionLengthSettings biased = Signed();
  biased.balance = 80.0;
  PartitionLength careful(biased);
  careful.Succeed();
  EXPECT_NEAR(careful.value(), 0.54, 1e-12);
}

TEST(PartitionLength, ExponentialTakesSmallerStepsTheLongerItSucceeds) {
  PartitionLengthSettings settings = Signed();
  settings.rule = PartitionLengthSettings::Rule::kExponential;
  settings.decay = 0.16;
  PartitionLength length(settings);
  length.Succeed();
  EXPECT_NEAR(length.value(), 0.5 + 0.2 * std::exp(-0.16), 1e-12);
  double last = length.value();
  double step = 1.0;
  for (int i = 0; i < 12; ++i) {
    length.Succeed();
    EXPECT_LE(length.value() - last, step + 1e-12);
    step = length.value() - last;
    last = length.value();
  }
  EXPECT_NEAR(step, 0.2 * std::exp(-1.6), 1e-12) << "the row counts to 10";
}

}  // namespace
}  // namespace gauntlet::controllers
