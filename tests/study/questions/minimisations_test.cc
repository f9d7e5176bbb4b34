// What is left of cases, without a process: the key, and what is told.
// Covers: analysis/figures/layout_strip.cc, study/questions/smallest_layouts.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "search/given/case_minimiser.h"
#include "study/questions/question_table.h"
#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

using namespace testing_support;  // NOLINT(google-build-using-namespace)

// Walls 2 and 5 together break the swarm.
sim::RunResult Trap(const EvaluationRequest& request) {
  return Ended(Has(request.test_case, 2) && Has(request.test_case, 5));
}

std::vector<CaseAnswer> Minimised(const Simulation& simulate, bool shorten = false) {
  return Answers(MinimisationOf(Flocking(), shorten), {Walls(8)}, simulate, KeyOfCase);
}

Told TellMinimised(const std::vector<CaseAnswer>& answers) {
  return MinimiseQuestion().tell({.place = "no-such-campaign"}, {}, answers).value();
}

TEST(MinimiseQuestion, OfWhatItIsAskedForTheKeyIs) {
  EXPECT_NE(Minimised(Trap).front().key, Minimised(Trap, /*shorten=*/true).front().key);
}

TEST(MinimiseQuestion, TellsWhatIsLeftAndKeepsIt) {
  const Told told = TellMinimised(Minimised(Trap));
  EXPECT_EQ(ToText(told.section),
            "  case    failed  obstacles  left  which     fails  probability (95 %)  runs\n"
            "  run 17  5 of 5          8     2  3 6    30 of 30   89 to 100 %         105\n");
  ASSERT_EQ(told.files.size(), 2U);
  EXPECT_EQ(told.files[0].path, "d/asked/1/run-17-minimised.json");
  EXPECT_EQ(told.files[1].what, "how it came about");
  EXPECT_EQ(told.section.pictures.size(), 1U);
  const auto json = nlohmann::json::parse(told.json).at("cases").at(0);
  EXPECT_EQ(json.at("run"), 17);
  EXPECT_EQ(json.at("original"), nlohmann::json({{"obstacles", 8}, {"k", 5}, {"n", 5}}));
  EXPECT_EQ(json.at("minimised").at("obstacles"), 2);
  EXPECT_EQ(json.at("kept_same_way"), true);
  const auto& left = json.at("minimised").at("case");
  EXPECT_EQ(left.at("name"), "run 17, minimised");
  EXPECT_EQ(left.at("lineage").at("parent").at("name"), "run 17");
  EXPECT_EQ(left.at("lineage").at("steps").back().at("obstacles"), nlohmann::json({3, 6}));
  EXPECT_EQ(told.conclusion, Conclusion::kDone);
}

TEST(MinimiseQuestion, RefusesWhatDoesNotFailAndWhatFailsWithoutObstacles) {
  const Told passes = TellMinimised(Minimised([](const EvaluationRequest&) { return Ended(false); }));
  EXPECT_EQ(
      ToText(passes.section),
      "  case    failed  obstacles  left  which  fails  probability (95 %)  runs\n"
      "  run 17  0 of 6          8     -             -                         6  not minimised: it does "
      "not fail often enough\n");
  EXPECT_EQ(passes.conclusion, Conclusion::kRefused);
  const Told empty = TellMinimised(Minimised([](const EvaluationRequest&) { return Ended(true); }));
  EXPECT_EQ(nlohmann::json::parse(empty.json).at("cases").at(0).at("remark"),
            "not minimised: the EMPTY ARENA FAILS TOO, in 4 of 4 runs");
  EXPECT_TRUE(empty.files.empty());
}

}  // namespace
}  // namespace gauntlet
