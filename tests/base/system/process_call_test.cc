#include "base/system/process_call.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace gauntlet::slurm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

TEST(CallProcess, CarriesInputOutputErrorsAndExitCode) {
  const Result<CallOutput> output =
      CallProcess({"/bin/sh", "-c", "cat; echo oops >&2; exit 3"}, "hello", seconds(20));
  ASSERT_TRUE(output.ok()) << output.error().message;
  EXPECT_EQ(output->out, "hello");
  EXPECT_EQ(output->err, "oops\n");
  EXPECT_EQ(output->exit_code, 3);
}

TEST(CallProcess, MoreThanAPipeHoldsPassesBothWays) {
  const std::string big(1 << 20, 'x');
  const Result<CallOutput> output = CallProcess({"/bin/cat"}, big, seconds(20));
  ASSERT_TRUE(output.ok()) << output.error().message;
  EXPECT_EQ(output->out, big);
}

TEST(CallProcess, KeepsSomeOfWhatOthersSayAndAllOfWhatOurProgramsSay) {
  constexpr std::size_t kSize = std::size_t{20} << 20;
  const std::vector<std::string> talker = {"/usr/bin/head", "-c", std::to_string(kSize), "/dev/zero"};
  const Result<CallOutput> others = CallProcess(talker, "", seconds(20));
  ASSERT_TRUE(others.ok()) << others.error().message;
  EXPECT_EQ(others->out.size(), std::size_t{16} << 20);
  const Result<CallOutput> ours = CallProcess(talker, "", std::nullopt, Callee::kPartOfUs);
  ASSERT_TRUE(ours.ok()) << ours.error().message;
  EXPECT_EQ(ours->out.size(), kSize);
}

TEST(CallProcess, AProgramThatReadsNothingDoesNoHarm) {
  const Result<CallOutput> output = CallProcess({"/bin/true"}, std::string(1 << 20, 'x'), seconds(20));
  ASSERT_TRUE(output.ok()) << output.error().message;
  EXPECT_EQ(output->exit_code, 0);
}

TEST(CallProcess, EndsWhatDoesNotEnd) {
  const auto before = std::chrono::steady_clock::now();
  const Result<CallOutput> output = CallProcess({"/bin/sleep", "600"}, "", milliseconds(200));
  ASSERT_FALSE(output.ok());
  EXPECT_THAT(output.error().message, HasSubstr("no answer within 200 ms"));
  EXPECT_LT(std::chrono::steady_clock::now() - before, seconds(60));
}

TEST(CallProcess, NamesAProgramThatIsNotThere) {
  const Result<CallOutput> output = CallProcess({"sbatch-that-is-nowhere"}, "", seconds(5));
  ASSERT_FALSE(output.ok());
  EXPECT_EQ(output.error().kind, ErrorKind::kNotFound);
  EXPECT_THAT(output.error().message, HasSubstr("sbatch-that-is-nowhere"));
}

TEST(CallProcess, AnEnclosingJobsVariablesStayOut) {
  setenv("SLURM_JOB_ID", "77", 1);
  setenv("SBATCH_PARTITION", "elsewhere", 1);
  setenv("SLURM_CONF", "/etc/slurm.conf", 1);
  const Result<CallOutput> output = CallProcess({"/usr/bin/env"}, "", seconds(20));
  unsetenv("SLURM_JOB_ID");
  unsetenv("SBATCH_PARTITION");
  unsetenv("SLURM_CONF");
  ASSERT_TRUE(output.ok());
  EXPECT_THAT(output->out, testing::Not(HasSubstr("SLURM_JOB_ID")));
  EXPECT_THAT(output->out, testing::Not(HasSubstr("SBATCH_PARTITION")));
  EXPECT_THAT(output->out, HasSubstr("SLURM_CONF=/etc/slurm.conf"));
}

}  // namespace
}  // namespace gauntlet::slurm
