// What evaluate says of cases, and which it asks about.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "study/questions/question_table.h"
#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

using Json = nlohmann::json;
using namespace testing_support;  // NOLINT(google-build-using-namespace)

CaseRun RunWith(RunId id, const sim::RunResult& result) {
  return {.id = id, .seed = 1ULL << 60, .result = result};
}

// One is simulated, one crashes, one breaks a rule, one is not there.
std::vector<CaseAnswer> Evaluated() {
  std::vector<CaseAnswer> cases(4);
  cases[0].name = "good.json";
  sim::RunResult result = Ended(false);
  result.metrics = {{"angular_order", 0.9}};
  result.hash = 0xabc;
  cases[0].runs.push_back(RunWith(1, result));
  result.fitness = 0.25;
  result.failure = {true, 7, "70-80 degrees apart"};
  cases[0].runs.push_back(RunWith(2, result));
  cases[1].name = "crashed.json";
  sim::RunResult crash;
  crash.verdict = sim::Verdict::kCrashed;
  crash.message = "signal 11";
  cases[1].runs.push_back(RunWith(3, crash));
  cases[2].name = "blocked.argos";
  cases[2].refused_rule = "no-path";
  cases[2].refused = "there is no path from start to goal";
  cases[3].name = "missing.json";
  cases[3].refused = "missing.json: no such file";
  return cases;
}

Told TellEvaluated(const std::vector<CaseAnswer>& cases) {
  return EvaluateQuestion().tell({}, {.directory = "d"}, cases).value();
}

TEST(EvaluateQuestion, HasTheJsonOfTheContract) {
  const Json cases = Json::parse(TellEvaluated(Evaluated()).json).at("cases");
  ASSERT_EQ(cases.size(), 4U);
  EXPECT_EQ(cases[0].at("file"), "good.json");
  EXPECT_EQ(cases[0].at("fitness"), 0.375);
  EXPECT_TRUE(cases[0].at("refused").is_null());
  EXPECT_TRUE(cases[0].at("error").is_null());
  EXPECT_EQ(cases[0].at("runs").at(1),
            Json({{"id", 2},
                  {"seed", "1152921504606846976"},
                  {"fitness", 0.25},
                  {"verdict", "completed"},
                  {"metrics", {{"angular_order", 0.9}}},
                  {"failure", {{"total", true}, {"type", 7}, {"label", "70-80 degrees apart"}}},
                  {"hash", "0000000000000abc"}}));
  EXPECT_TRUE(cases[0].at("runs").at(0).at("failure").at("type").is_null());
  EXPECT_TRUE(cases[1].at("fitness").is_null());
  EXPECT_TRUE(cases[1].at("runs").at(0).at("fitness").is_null());
  EXPECT_EQ(cases[1].at("runs").at(0).at("verdict"), "crashed");
  EXPECT_EQ(cases[1].at("runs").at(0).at("message"), "signal 11");
  EXPECT_EQ(cases[2].at("refused"), "no-path");
  EXPECT_EQ(cases[3].at("error"), "missing.json: no such file");
}

TEST(EvaluateQuestion, TextThatIsNotUtf8IsReplacedRatherThanRefused) {
  std::vector<CaseAnswer> cases = Evaluated();
  cases[0].name = "bad\xff.json";
  EXPECT_EQ(Json::parse(TellEvaluated(cases).json).at("cases")[0].at("file"), "bad\uFFFD.json");
}

TEST(EvaluateQuestion, NamesRefusalsTheMeanAndTheRunToLookAt) {
  const Told told = TellEvaluated(Evaluated());
  EXPECT_EQ(ToText(told.section),
            "  file           fitness  runs  total failures  first run\n"
            "  good.json        0.375     2               1          1\n"
            "  crashed.json         -     1               0          3  1 without a result: crashed\n"
            "  blocked.argos        -     -               -          -  refused: no-path\n"
            "  missing.json         -     -               -          -  error\n"
            "  1 case: mean fitness 0.375, 1 of 3 runs total failures\n"
            "  gauntlet replay d 2 --svg run-2.svg  # see the toughest of these runs\n"
            "  gauntlet show d --json               # everything, for scripts\n");
  EXPECT_THAT(told.messages,
              testing::ElementsAre("blocked.argos: refused, no-path: there is no path from start to goal",
                                   "missing.json: no such file"));
  EXPECT_EQ(told.conclusion, Conclusion::kDone);
  EXPECT_EQ(TellEvaluated({Evaluated()[2]}).conclusion, Conclusion::kRefused);
}

TEST(EvaluateQuestion, TellsTheCombinationsOfASweepApart) {
  std::vector<CaseAnswer> cases(4);
  for (std::size_t i = 0; i < 4; ++i) {
    cases[i].name = i % 2 == 0 ? "a.json" : "none.json";
    cases[i].refused = i % 2 == 0 ? "" : "none.json: no such file";
  }
  cases[0].runs = {RunWith(1, Ended(false))};
  cases[2].runs = {RunWith(2, Ended(true))};
  Asking asking{.experiments = {{"faults=1:leds@0", {}}, {"faults=2:leds@0", {}}}};
  asking.experiments[1].experiment.seed = 5;
  const Told told = EvaluateQuestion().tell(asking, {.directory = "d"}, cases).value();
  EXPECT_EQ(ToText(told.section) + told.details,
            "  settings         file       fitness  runs  total failures  first run\n"
            "  faults=1:leds@0  a.json       0.500     1               0          1\n"
            "  faults=1:leds@0  none.json        -     -               -          -  error\n"
            "  faults=2:leds@0  a.json       0.000     1               1          2\n"
            "  faults=2:leds@0  none.json        -     -               -          -  error\n"
            "  gauntlet replay d 2 --svg run-2.svg  # see the toughest of these runs\n"
            "  gauntlet show d --json               # everything, for scripts\n"
            "\n"
            "  settings         cases  mean fitness  runs  total failures\n"
            "  faults=1:leds@0      1         0.500     1               0\n"
            "  faults=2:leds@0      1         0.000     1               1\n");
  EXPECT_THAT(told.messages, testing::ElementsAre("none.json: no such file"));
  const Json json = Json::parse(told.json);
  EXPECT_EQ(json.at("cases")[2].at("settings"), "faults=2:leds@0");
  EXPECT_EQ(json.at("sweep")[1], Json({{"settings", "faults=2:leds@0"},
                                       {"seed", "5"},
                                       {"cases", 1},
                                       {"fitness", 0.0},
                                       {"runs", 1},
                                       {"total_failures", 1}}));
}

TEST(EvaluateQuestion, PrintsFortyRowsAndTheMeanOfAll) {
  std::vector<CaseAnswer> cases;
  for (RunId run = 1; run <= 60; ++run) {
    cases.emplace_back().name = "a";
    cases.back().runs.push_back(RunWith(run, Ended(run > 45)));
  }
  const Told told = TellEvaluated(cases);
  EXPECT_EQ(told.section.table.size(), 40U);
  EXPECT_THAT(told.section.sentences,
              testing::ElementsAre("and 20 more; --json tells all",
                                   "60 cases: mean fitness 0.375, 15 of 60 runs total failures"));
  EXPECT_EQ(Json::parse(told.json).at("cases").size(), 60U);
}

}  // namespace
}  // namespace gauntlet
