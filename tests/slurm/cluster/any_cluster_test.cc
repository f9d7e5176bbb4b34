// The short ones of the drills on clusters other than Slurm's.
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <fstream>

#include "tests/slurm/cluster/any_cluster.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_P(AnyClusterTest, ASubmittedSearchEndsLikeALocalOneAndLeavesNothing) {
  const SmallCampaign campaign;
  const std::string hash = LocalHash(campaign);
  const ProcessResult here = Gauntlet(
      SubmitArguments(campaign, "here", {site_->Setting(), "max_allocations=3", "query_interval=1"}));
  EXPECT_EQ(here.exit_code, 0) << here.err;
  EXPECT_EQ(StateHash(dir()), hash);
  EXPECT_TRUE(QueueEmpties());

  // The shell, the scheduler and the patterns of names read it each in their own way.
  const std::string odd = scratch_ / "it's \"50%\" [1-9] \\ odd";
  std::vector<std::string> arguments =
      SubmitArguments(campaign, "job", {site_->Setting(), "query_interval=1"});
  std::ranges::replace(arguments, dir(), odd);
  const ProcessResult job = Gauntlet(arguments);
  ASSERT_EQ(job.exit_code, 0) << job.err;
  EXPECT_TRUE(Eventually(
      [&] {
        return Gauntlet({"status", odd}).out.find(": finished") != std::string::npos;
      },
      std::chrono::seconds(120)))
      << Gauntlet({"status", odd}).out;
  EXPECT_EQ(StateHash(odd), hash);
  EXPECT_TRUE(QueueEmpties());
  int ends = 0;
  for (const auto& file : std::filesystem::directory_iterator(odd + "/log"))
    ends += file.path().extension() == ".exit" ? 1 : 0;
  EXPECT_GE(ends, 2) << "the master and a worker";
}

TEST_P(AnyClusterTest, WhereNothingEverStartsTheMasterEndsResumably) {
  const ProcessResult result = Gauntlet(SubmitArguments(
      {}, "here", {site_->Setting("give_up_after = 1"), "worker_command=false", "query_interval=1"}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("without a word from any worker"), HasSubstr("exit code 1"),
                                HasSubstr("Go on with")));
  EXPECT_TRUE(QueueEmpties());
}

INSTANTIATE_TEST_SUITE_P(, AnyClusterTest, testing::Values("sge", "pbs", "ssh"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace gauntlet::testing_support
