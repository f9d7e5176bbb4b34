#include "slurm/slurm_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/process.h"

namespace gauntlet::slurm {
namespace {

using testing::HasSubstr;

class CommandLineSlurmTest : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(scratch_ / "sbatch") << "#!/bin/sh\nenv > '" << scratch_ / "environment"
                                       << "'\ncat > '" << scratch_ / "script"
                                       << "'\necho 12\n";
    std::filesystem::permissions(scratch_ / "sbatch", std::filesystem::perms::owner_all);
  }
  void TearDown() override { setenv("PATH", path_.c_str(), 1); }
  std::string Read(const std::string& name) const {
    std::ifstream in(scratch_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const std::string path_ = getenv("PATH");
  testing_support::TemporaryDirectory scratch_;
};

TEST_F(CommandLineSlurmTest, AnEnclosingJobsVariablesStayOut) {
  setenv("PATH", (scratch_.path() + ":" + path_).c_str(), 1);
  setenv("SLURM_JOB_ID", "77", 1);
  setenv("SBATCH_PARTITION", "elsewhere", 1);
  setenv("SLURM_CONF", "/etc/slurm.conf", 1);
  const Result<std::string> job = CommandLineSlurm().Submit("#!/bin/sh\nexit\n", {});
  unsetenv("SLURM_JOB_ID");
  unsetenv("SBATCH_PARTITION");
  unsetenv("SLURM_CONF");
  ASSERT_TRUE(job.ok()) << job.error().message;
  EXPECT_EQ(*job, "12");
  EXPECT_EQ(Read("script"), "#!/bin/sh\nexit\n");
  EXPECT_THAT(Read("environment"), testing::Not(HasSubstr("SLURM_JOB_ID")));
  EXPECT_THAT(Read("environment"), testing::Not(HasSubstr("SBATCH_PARTITION")));
  EXPECT_THAT(Read("environment"), HasSubstr("SLURM_CONF=/etc/slurm.conf"));
}

// Bash does so where it takes its stdin for a network's.
TEST_F(CommandLineSlurmTest, TheUsersBashrcIsNotRead) {
  const std::string home = getenv("HOME");
  std::ofstream(scratch_ / ".bashrc") << "echo rubbish\nexport PATH=/nowhere\n";
  setenv("PATH", (scratch_.path() + ":" + path_).c_str(), 1);
  setenv("HOME", scratch_.path().c_str(), 1);
  unsetenv("SHLVL");
  const Result<std::string> job = CommandLineSlurm().Submit("#!/bin/sh\nexit\n", {});
  setenv("HOME", home.c_str(), 1);
  ASSERT_TRUE(job.ok()) << job.error().message;
  EXPECT_EQ(*job, "12");
}

TEST_F(CommandLineSlurmTest, AMachineWithoutSlurmIsToldSo) {
  setenv("PATH", (scratch_ / "nowhere").c_str(), 1);
  const Result<std::string> job = CommandLineSlurm().Submit("#!/bin/sh\nexit\n", {});
  ASSERT_FALSE(job.ok());
  EXPECT_EQ(job.error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(job.error().message, "there is no sbatch in PATH: is Slurm installed on this machine?");
}

}  // namespace
}  // namespace gauntlet::slurm
