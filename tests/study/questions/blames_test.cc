// What is said of the obstacles of a case.
// Covers: analysis/figures/blame_figure.cc, search/given/layout_question.cc
#include "study/questions/blames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "search/given/case_blame.h"
#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

using testing::EndsWith;
using namespace testing_support;  // NOLINT(google-build-using-namespace)

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

// Without wall 1 the case does not fail. Two robots: one stays at wall 0, the other is lost at wall 1.
std::vector<CaseAnswer> Blamed(bool fails, int replicates = 10) {
  return Answers(
      BlameExperiment(Flocking(), replicates), {Walls(3, "run 8")},
      [fails](const EvaluationRequest& request) {
        sim::RunResult result = Ended(fails && Has(request.test_case, 1));
        result.robots.resize(2);
        result.robots[0].waypoints = {{-0.4, 0.0}, {-0.4, 0.0}};
        result.robots[1].lost = true;
        result.robots[1].waypoints = {{0.72, 0.0}, {0.78, 0.0}};
        return result;
      },
      KeyOfCase);
}

TEST(BlameIn, CountsWhatEachObstacleDoesAndWhereRobotsWere) {
  const Blame blame = BlameIn(Blamed(/*fails=*/true).front());
  EXPECT_EQ(blame.whole.failures, 10);
  ASSERT_EQ(blame.singles.size(), 3U);
  EXPECT_FALSE(blame.singles[0].to_blame);
  EXPECT_TRUE(blame.singles[1].to_blame);
  EXPECT_EQ(blame.singles[1].effect, 1.0);
  EXPECT_EQ(blame.failing_robots, 10U);
  EXPECT_EQ(blame.singles[0].touched, 0U);
  EXPECT_EQ(blame.singles[1].touched, 10U);
  EXPECT_EQ(blame.stuck.size(), 10U);
  EXPECT_EQ(blame.runs, 40U);
  EXPECT_NE(Blamed(true).front().key, Blamed(true, 11).front().key);
}

TEST(BlameQuestion, TellsASentenceATableAndAPicture) {
  const Told told = BlameQuestion().tell({}, {}, Blamed(/*fails=*/true)).value();
  EXPECT_EQ(ToText(told.section),
            "  run 8 fails in 10 of 10 runs. Obstacle 2 does it: without 2 it fails in 0 of 10.\n"
            "  without obstacle  fails in  change in points (95 %)            failing robots were at it\n"
            "  1                 10 of 10           0 (-28 to +28)                                  0 %\n"
            "  2                  0 of 10       -100 (-100 to -61)  to blame                      100 %\n"
            "  3                 10 of 10           0 (-28 to +28)                                100 %\n"
            "  40 runs.\n");
  ASSERT_EQ(told.files.size(), 1U);
  EXPECT_EQ(told.files[0].path, "d/asked/1/run-8-blame.svg");
  EXPECT_EQ(told.section.pictures.size(), 1U);
  const auto second = nlohmann::json::parse(told.json).at("obstacles").at(1);
  EXPECT_EQ(second.at("number"), 2);
  EXPECT_EQ(second.at("failure_without"), nlohmann::json({0, 10}));
  EXPECT_EQ(second.at("touched"), nlohmann::json({10, 10}));
}

TEST(BlameQuestion, RefusesACaseThatDoesNotFail) {
  const Told told = BlameQuestion().tell({}, {}, Blamed(/*fails=*/false)).value();
  EXPECT_EQ(ToText(told.section), "  run 8 failed in 0 of 10 runs: there is nothing to blame.\n");
  EXPECT_TRUE(told.files.empty());
  EXPECT_TRUE(told.section.pictures.empty());
  EXPECT_EQ(told.conclusion, Conclusion::kRefused);
}

}  // namespace
}  // namespace gauntlet
