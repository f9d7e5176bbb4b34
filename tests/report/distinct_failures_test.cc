#include "report/tables/distinct_failures.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gauntlet {
namespace {

Confirmation Confirmed(RunId run, int failures, int passes, FailureVerdict verdict) {
  Confirmation one{.name = "run " + std::to_string(run),
                   .run = run,
                   .tally = {.failures = failures, .passes = passes},
                   .verdict = verdict,
                   .interval = {failures / 10.0, 0.75}};
  if (failures > 0) {
    one.example = {.scenario = "flocking",
                   .way = {.kind = 0, .place = sim::Vec2(static_cast<double>(run), 0.0)},
                   .campaign = "c/confirm/1",
                   .run = 10 * run};
  }
  return one;
}

TEST(DistinctFailuresTest, AreCountedAndToldToughestFirst) {
  const CampaignAnswers answers{
      .confirmations = {Confirmed(4, 3, 2, FailureVerdict::kFail), Confirmed(8, 5, 0, FailureVerdict::kFail),
                        Confirmed(9, 0, 6, FailureVerdict::kPass)},
      .smallest_layouts = {}};
  EXPECT_EQ(ToText(TellDistinctFailures(answers, 1, "gauntlet")),
            "\n2 distinct failures (2 confirmed) in 3 cases with fresh seeds\n"
            "     toughest   fails  cases  what happens     smallest  to see it\n"
            "  1  run 8     5 of 5      1  near (8.0, 0.0)         -  gauntlet replay c/confirm/1 80 --svg "
            "failure-1.svg\n"
            "  and 1 more; see show --json\n");
  const auto rows = DistinctFailuresTable(DistinctFailures(answers.confirmations, {})).ToJson();
  EXPECT_EQ(rows.at(0).dump(),
            R"j({"k":5,"n":5,"interval":[0.5,0.75],"cases":["run 8"],"what":"near (8.0, 0.0)",)j"
            R"j("smallest":null,"confirmed":true,"example":{"campaign":"c/confirm/1","run":80}})j");
}

TEST(DistinctFailuresTest, OfCasesThatFailNoMoreThereIsNoTable) {
  const CampaignAnswers answers{.confirmations = {Confirmed(9, 0, 6, FailureVerdict::kPass)},
                                .smallest_layouts = {}};
  EXPECT_EQ(ToText(TellDistinctFailures(answers, 20)),
            "\nNo distinct failure: with fresh seeds no run of 1 case failed\n");
  EXPECT_EQ(ToText(TellDistinctFailures({}, 20)), "") << "nobody has asked";
}

}  // namespace
}  // namespace gauntlet
