// The same campaign gives the same state_hash, whatever happens to its processes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

// Every drill is for every shipped behaviour and every search.
class DeterminismDrill : public testing::TestWithParam<SmallCampaign> {};

INSTANTIATE_TEST_SUITE_P(Experiments, DeterminismDrill,
                         testing::Values(SmallCampaign{}, SmallForaging(), SmallPartitioning(),
                                         SmallSteadyState(), SmallArchive(), SmallRandom(),
                                         SmallEvaluation()),
                         [](const testing::TestParamInfo<SmallCampaign>& parameter) {
                           return parameter.param.name;
                         });

TEST_P(DeterminismDrill, StateHashDoesNotDependOnTheNumberOfWorkers) {
  for (const int workers : {1, 5}) {
    const TemporaryDirectory scratch;
    const ProcessResult result = Gauntlet(EvolveArguments(GetParam(), scratch / "c", workers));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(StateHash(scratch / "c"), UndisturbedHash(GetParam())) << workers << " workers";
  }
}

TEST_P(DeterminismDrill, AnotherSeedGivesAnotherStateHash) {
  const TemporaryDirectory scratch;
  SmallCampaign other = GetParam();
  other.seed = "8";
  ASSERT_EQ(Gauntlet(EvolveArguments(other, scratch / "c", 2)).exit_code, 0);
  EXPECT_NE(StateHash(scratch / "c"), UndisturbedHash(GetParam()));
}

TEST_P(DeterminismDrill, KilledMasterResumesToTheSameStateHash) {
  const TemporaryDirectory scratch;
  EvolveThroughMasterKills(GetParam(), scratch / "c", 2, 4, 1, std::chrono::milliseconds(900));
  EXPECT_EQ(StateHash(scratch / "c"), UndisturbedHash(GetParam()));
}

TEST_P(DeterminismDrill, KilledWorkersAndRunnersDoNotChangeTheStateHash) {
  const TemporaryDirectory scratch;
  EvolveThroughWorkerKills(GetParam(), scratch / "c", 2, 6, 2, std::chrono::milliseconds(200));
  EXPECT_EQ(StateHash(scratch / "c"), UndisturbedHash(GetParam()));
}

TEST_P(DeterminismDrill, InterruptedCampaignExitsWith3AndResumesToTheSameStateHash) {
  const TemporaryDirectory scratch;
  const SmallCampaign& campaign = GetParam();
  const std::string dir = scratch / "c";
  std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(campaign, dir, 2));
  ASSERT_TRUE(Serves(dir)) << master->Err();
  master->Signal(SIGINT);
  const ProcessResult stopped = master->Wait();
  EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
  EXPECT_THAT(stopped.err, testing::HasSubstr("gauntlet resume " + dir));
  const ProcessResult resumed = Gauntlet({"resume", dir, "--workers", "3", "--quiet"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(StateHash(dir), UndisturbedHash(GetParam()));
}

TEST_P(DeterminismDrill, ResumingAFinishedCampaignChangesNothing) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  ASSERT_EQ(Gauntlet(EvolveArguments(GetParam(), dir, 2)).exit_code, 0);
  const nlohmann::json before = Show(dir);
  EXPECT_EQ(Gauntlet({"resume", dir, "--quiet"}).exit_code, 0);
  EXPECT_EQ(Show(dir), before);
  EXPECT_TRUE(before["finished"].get<bool>());
}

}  // namespace
}  // namespace gauntlet::testing_support
