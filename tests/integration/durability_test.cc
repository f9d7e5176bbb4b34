// Losses of power, kills of everything, clocks that jump: short forms. Long ones: long_drill_test.cc.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/durability_drill.h"
#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

TEST(Durability, WhatWasAcknowledgedSurvivesLossesOfPower) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 8;
  const DurabilityReport report = EvolveThroughPowerLosses(
      campaign, scratch / "c", 8, 1, std::chrono::milliseconds(kSanitized ? 4000 : 400));
  fmt::print("{} kills, {} runs acknowledged before one, {} of them leased again, {} simulated, {} runs\n",
             report.kills, report.acknowledged, report.leased_again, report.simulated, report.runs);
  EXPECT_GE(report.kills, 4);
  EXPECT_GT(report.acknowledged, 0);
  EXPECT_EQ(report.leased_again, 0);
}

// The shim is no dummy: without it a kill loses nothing, with it even a clean end loses what was not
// synchronised.
TEST(Durability, TheShimLosesWhatWasNotSynchronised) {
  const TemporaryDirectory scratch;
  const std::string script = "printf written > " + scratch.path() + "/file";
  const ProcessResult plain = RunProcess({"/bin/sh", "-c", script});
  EXPECT_EQ(ReadFile(scratch / "file"), "written") << plain.err;
  const ProcessResult lossy =
      RunProcess({"/bin/sh", "-c", script},
                 {"LD_PRELOAD=" + FaultShimPath(), "GAUNTLET_FAULT_LOSE_UNSYNCED=" + scratch.path()});
  EXPECT_EQ(ReadFile(scratch / "file"), "") << lossy.err;
}

TEST(Durability, KillsOfMastersAndWorkersTogetherLoseNothing) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 10;
  const MassacreReport report = EvolveThroughMassacre(
      campaign, scratch / "c", 2, 5, 10, 2, std::chrono::milliseconds(700), std::chrono::milliseconds(100));
  fmt::print("{} masters and {} workers killed, {} runs, {} evaluations, {} of stored runs\n",
             report.master_kills, report.worker_kills, report.runs, report.evaluations,
             report.evaluated_after_stored);
  EXPECT_EQ(report.master_kills, 5);
  EXPECT_EQ(report.worker_kills, 10);
  EXPECT_EQ(report.evaluated_after_stored, 0);
  EXPECT_GE(report.evaluations, report.runs);
}

// A wall clock that jumps by up to a day at every look at it, in master and workers: it is shown in logs and
// status, and decides nothing.
TEST(Durability, AWallClockThatJumpsDecidesNothing) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  const ProcessResult result =
      RunProcess(GauntletCommand(EvolveArguments(campaign, scratch / "c", 2)),
                 {"LD_PRELOAD=" + FaultShimPath(), "GAUNTLET_FAULT_CLOCK_JUMPS=86400"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(StateHash(scratch / "c"), UndisturbedHash(campaign));
  EXPECT_THAT(MasterLog(scratch / "c"), testing::Not(testing::HasSubstr("worker-lost")));
}

}  // namespace
}  // namespace gauntlet::testing_support
