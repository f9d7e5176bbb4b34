#include "report/tables/distinct_failures.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gauntlet {
namespace {

Confirmation Confirmed(RunId run, int failures, const std::string& mechanism, const std::string& place) {
  Confirmation one{.name = "run " + std::to_string(run),
                   .run = run,
                   .tally = {.failures = failures, .passes = 20 - failures},
                   .verdict = failures == 0 ? FailureVerdict::kPass : FailureVerdict::kFail,
                   .interval = {failures / 40.0, failures / 20.0},
                   .campaign = "c/confirm/1"};
  for (int i = 0; i < failures; ++i)
    one.failed.push_back({10 * run + static_cast<RunId>(i), {mechanism, place}});
  return one;
}

std::string Told(const CampaignAnswers& answers, std::size_t most) {
  std::string text;
  for (const Section& one : TellDistinctFailures(answers, most, "gauntlet")) text += ToText(one);
  return text;
}

TEST(DistinctFailuresTest, AreToldByWhatHappensAndByPlaceToughestFirst) {
  const CampaignAnswers answers{
      .confirmations = {Confirmed(4, 12, "stood still", "near (1.0, 0.0)"),
                        Confirmed(8, 20, "got lost", "near (1.0, 0.0)"), Confirmed(9, 0, "", "")},
      .smallest_layouts = {}};
  EXPECT_EQ(
      Told(answers, 1),
      "\n2 distinct failures by what happens, in 2 cases with 10 failed runs or more\n"
      "     failure   cases  share  of their failed runs  toughest     fails  smallest  to see it\n"
      "  1  got lost      1   50 %              20 of 20  run 8     20 of 20         -  gauntlet replay "
      "c/confirm/1 80 --svg mechanism-1.svg\n"
      "  and 1 more; see show --json\n"
      "  Failed runs of one case agree in it by 1.00 (kappa: 0 = no more often than runs of different cases, "
      "1 =\n  always).\n"
      "\n1 distinct failure by place, in 2 cases with 10 failed runs or more\n"
      "     failure          cases  share  of their failed runs  toughest     fails  smallest  to see it\n"
      "  1  near (1.0, 0.0)      2  100 %              32 of 32  run 8     20 of 20         -  gauntlet "
      "replay "
      "c/confirm/1 80 --svg place-1.svg\n"
      "  How well it repeats is not known: there is one case, or all failed runs are alike in it.\n");
  const DistinctFailures distinct = DistinctFailuresOf(answers.confirmations, {});
  EXPECT_EQ(
      DistinctFailuresTable(distinct.All()).ToJson().at(0).dump(),
      R"j({"feature":"mechanism","name":"got lost","cases":["run 8"],"share":0.5,"confidence":1.0,"run":8,)j"
      R"j("k":20,"n":20,"interval":[0.5,1.0],"smallest":null,"confirmed":true,)j"
      R"j("example":{"campaign":"c/confirm/1","run":80}})j");
  EXPECT_EQ(FailureGroupingsTable(distinct).ToJson().at(1).dump(),
            R"({"feature":"place","agreement":null,"used":true,"distinct":1,"mixed":0})");
}

TEST(DistinctFailuresTest, OfTooFewFailedRunsTheToughestCasesAreTold) {
  const CampaignAnswers answers{
      .confirmations = {Confirmed(4, 5, "stood still", ""), Confirmed(8, 6, "got lost", "")},
      .smallest_layouts = {}};
  EXPECT_EQ(Told(answers, 1),
            "\n2 of 2 cases that failed again have too few failed runs to say which failure each is\n"
            "  case    failed  probability (95 %)  verdict\n"
            "  run 8  6 of 20   15 to  30 %        fail\n"
            "  It takes 10. `gauntlet confirm` with --replicates 20, or with more where they seldom fail, "
            "simulates more of\n  them.\n"
            "  and 1 more; see show --json\n");
}

TEST(DistinctFailuresTest, WhatTellsNothingApartIsSaid) {
  CampaignAnswers mixed{
      .confirmations = {Confirmed(4, 10, "stood still", ""), Confirmed(5, 12, "stood still", "")},
      .smallest_layouts = {}};
  for (Confirmation& one : mixed.confirmations) {
    for (std::size_t i = 0; i < one.failed.size() / 2; ++i) one.failed[i].features.mechanism = "got lost";
  }
  EXPECT_EQ(
      Told(mixed, 1),
      "\nWhat happens does not tell these failures apart\n"
      "  Failed runs of one case agree in it by 0.00 (kappa: 0 = no more often than runs of different cases, "
      "1 =\n  always), which takes 0.5 at least.\n"
      "  Most frequent: got lost, in 11 of 22 failed runs.\n"
      "\nWhere it happens is not known of these failures\n"
      "  The scenario declares no place that its runs fail at.\n");
}

TEST(DistinctFailuresTest, OfCasesThatFailNoMoreThereIsNoTable) {
  const CampaignAnswers answers{.confirmations = {Confirmed(9, 0, "", "")}, .smallest_layouts = {}};
  EXPECT_EQ(Told(answers, 20), "\nNo distinct failure: with fresh seeds no run of 1 case failed\n");
  EXPECT_EQ(Told({}, 20), "") << "nobody has asked";
}

}  // namespace
}  // namespace gauntlet
