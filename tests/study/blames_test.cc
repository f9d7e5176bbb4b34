// What is said of the obstacles of a case.
#include "study/questions/blames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet {
namespace {

using testing::EndsWith;

FailureTally Failed(int failures, int runs) {
  return {.failures = failures, .passes = runs - failures, .errors = 0};
}

// Obstacles, and how often of 30 runs the case fails without each; to blame when in fewer than 24.
Blame BlameOf(const std::vector<int>& without) {
  Blame blame;
  blame.name = "run 8";
  blame.whole = Failed(30, 30);
  for (const int failures : without) {
    BlamedPart& part = blame.singles.emplace_back();
    part.obstacles = {blame.singles.size() - 1};
    part.without = Failed(failures, 30);
    part.to_blame = failures < 24;
  }
  return blame;
}

TEST(DescribeBlame, SaysWhatDoesItAndWhatOnlyContributes) {
  EXPECT_EQ(DescribeBlame(BlameOf({30, 2, 29})),
            "run 8 fails in 30 of 30 runs. Obstacle 2 does it: without 2 it fails in 2 of 30.");
  EXPECT_THAT(
      DescribeBlame(BlameOf({14, 2, 29})),
      EndsWith("Obstacles 1 and 2 do it: without 1 it fails in 14 of 30, without 2 it fails in 2 of 30."));
  EXPECT_THAT(DescribeBlame(BlameOf({21, 30})),
              EndsWith("runs. Obstacle 1 contributes to it: without 1 it fails in 21 of 30."));
  EXPECT_THAT(
      DescribeBlame(BlameOf({21, 3, 15})),
      EndsWith("Obstacle 2 does it: without 2 it fails in 3 of 30. Obstacles 1 and 3 contribute to it: "
               "without 1 it fails in 21 of 30, without 3 it fails in 15 of 30."));
  EXPECT_THAT(DescribeBlame(BlameOf({30})), EndsWith("No obstacle and no pair of them explains it."));
}

}  // namespace
}  // namespace gauntlet
