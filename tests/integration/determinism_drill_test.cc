// The same campaign gives the same state_hash, whatever happens to its processes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

// Ctrl-C stops a campaign and names what resumes it.
void InterruptAndResume(const SmallCampaign& campaign, const std::string& dir) {
  std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(campaign, dir, 2));
  ASSERT_TRUE(Serves(dir)) << master->Err();
  master->Signal(SIGINT);
  const ProcessResult stopped = master->Wait();
  EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
  EXPECT_THAT(stopped.err, testing::HasSubstr("gauntlet resume " + dir));
  const ProcessResult resumed = Gauntlet({"resume", dir, "--workers", "3", "--quiet"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
}

void ResumeWhatHasFinished(const std::string& dir) {
  const nlohmann::json before = Show(dir);
  EXPECT_TRUE(before["finished"].get<bool>());
  EXPECT_EQ(Gauntlet({"resume", dir, "--quiet"}).exit_code, 0);
  EXPECT_EQ(Show(dir), before);
}

// For every shipped behaviour and every search.
class DeterminismDrill : public testing::TestWithParam<SmallCampaign> {};

INSTANTIATE_TEST_SUITE_P(Experiments, DeterminismDrill,
                         testing::Values(SmallCampaign{}, SmallForaging(), SmallPartitioning(),
                                         SmallSteadyState(), SmallArchive(), SmallRandom(), SmallFit(),
                                         SmallCommand(), SmallEvaluation()),
                         [](const testing::TestParamInfo<SmallCampaign>& parameter) {
                           return parameter.param.name;
                         });

// One test of all, so that what they are compared with is computed once.
TEST_P(DeterminismDrill, StateHashIsThatOfTheUndisturbedCampaign) {
  const TemporaryDirectory scratch;
  const std::string undisturbed = scratch / "undisturbed";
  ASSERT_EQ(Gauntlet(EvolveArguments(GetParam(), undisturbed, 1)).exit_code, 0);
  const std::string hash = StateHash(undisturbed);
  ASSERT_EQ(hash.size(), 64U);
  {
    SCOPED_TRACE("a finished campaign is resumed");
    ResumeWhatHasFinished(undisturbed);
  }
  {
    SCOPED_TRACE("another number of workers");
    ASSERT_EQ(Gauntlet(EvolveArguments(GetParam(), scratch / "five", 5)).exit_code, 0);
    EXPECT_EQ(StateHash(scratch / "five"), hash);
  }
  {
    SCOPED_TRACE("another seed");
    SmallCampaign other = GetParam();
    other.seed = "8";
    ASSERT_EQ(Gauntlet(EvolveArguments(other, scratch / "other", 2)).exit_code, 0);
    EXPECT_NE(StateHash(scratch / "other"), hash);
  }
  {
    SCOPED_TRACE("killed masters");
    EvolveThroughMasterKills(GetParam(), scratch / "masters", 2, 4, 1, std::chrono::milliseconds(600));
    EXPECT_EQ(StateHash(scratch / "masters"), hash);
  }
  {
    SCOPED_TRACE("killed workers and runners");
    EvolveThroughWorkerKills(GetParam(), scratch / "workers", 2, 6, 2, std::chrono::milliseconds(150));
    EXPECT_EQ(StateHash(scratch / "workers"), hash);
  }
  {
    SCOPED_TRACE("interrupted");
    InterruptAndResume(GetParam(), scratch / "interrupted");
    EXPECT_EQ(StateHash(scratch / "interrupted"), hash);
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
