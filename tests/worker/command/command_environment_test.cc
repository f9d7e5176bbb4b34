// What programs find in their environment.
#include "worker/command/command_environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "tests/support/process.h"
#include "tests/worker/command/command_folder.h"

namespace gauntlet::worker {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Not;
using testing::StartsWith;

controllers::command::Definition WithSetup(const std::string& setup) {
  controllers::command::Definition definition = ShellDefinition("true");
  definition.setup = setup;
  return definition;
}

TEST(CommandEnvironmentTest, WithoutSetupItIsOurOwn) {
  setenv("GAUNTLET_TEST", "two words", 1);
  const auto environment = EnvironmentAfterSetup(WithSetup(""));
  ASSERT_TRUE(environment.ok());
  EXPECT_THAT(*environment, Contains("GAUNTLET_TEST=two words"));
  unsetenv("GAUNTLET_TEST");
}

TEST(CommandEnvironmentTest, WhatSetupExportsIsKept) {
  if (testing_support::kSanitized) GTEST_SKIP();
  setenv("GAUNTLET_TEST", "ours", 1);
  const auto environment = EnvironmentAfterSetup(WithSetup(
      "echo noise; echo noise >&2\nexport A=$GAUNTLET_TEST B=$'two\\nlines'\nunset GAUNTLET_TEST\nC=3"));
  unsetenv("GAUNTLET_TEST");
  ASSERT_TRUE(environment.ok()) << environment.error().message;
  EXPECT_THAT(*environment,
              AllOf(Contains("A=ours"), Contains("B=two\nlines"), Contains(StartsWith("PATH="))));
  EXPECT_THAT(*environment, Not(Contains(StartsWith("GAUNTLET_TEST="))));
  EXPECT_THAT(*environment, Not(Contains("C=3")));
}

TEST(CommandEnvironmentTest, ASetupThatFailsIsToldWithWhatItPrinted) {
  if (testing_support::kSanitized) GTEST_SKIP();
  for (const char* setup : {"echo no license; exit 3", "echo no license >&2; (exit 3)",
                            "set -e; echo no license; (exit 3); true"}) {
    const auto environment = EnvironmentAfterSetup(WithSetup(setup));
    ASSERT_FALSE(environment.ok()) << setup;
    EXPECT_EQ(environment.error().message, "the command's setup ended with exit code 3\nno license\n");
  }
  EXPECT_FALSE(EnvironmentAfterSetup(WithSetup("export A='")).ok());
}

// Runners end with programs that crash, and are started anew: the setup is not.
TEST(CommandEnvironmentTest, TheProcessesOfAWorkerRunASetupOnce) {
  if (testing_support::kSanitized) GTEST_SKIP();
  const testing_support::TemporaryDirectory folder;
  const std::string count = folder / "count";
  const std::string hash(64, 'a');
  const auto definition =
      WithSetup("echo once >> " + count + "; [ $(wc -l < " + count + ") -ge 2 ] && export A=1");
  const PluginSettings settings{.setups = MakeSharedSetups()};
  ASSERT_TRUE(settings.setups);
  EXPECT_FALSE(SharedEnvironment(settings, hash, definition).ok()) << "what failed is tried again";
  const auto other = SharedEnvironment(settings, std::string(64, 'b'), WithSetup("export B=2"));
  ASSERT_TRUE(other.ok());
  for (int runner = 0; runner < 3; ++runner) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const auto environment = SharedEnvironment(settings, hash, definition);
      _exit(environment.ok() && std::ranges::count(*environment, "A=1") == 1 ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  std::string counted;
  std::getline(std::ifstream(count), counted, '\0');
  EXPECT_EQ(counted, "once\nonce\n");
  EXPECT_THAT(*SharedEnvironment(settings, std::string(64, 'b'), WithSetup("exit 1")), Contains("B=2"));
}

TEST(CommandEnvironmentTest, WhatSetupStartsDoesNotStay) {
  if (testing_support::kSanitized) GTEST_SKIP();
  const auto environment = EnvironmentAfterSetup(WithSetup("sleep 600 & export STARTED=$!"));
  ASSERT_TRUE(environment.ok());
  const auto started = std::ranges::find_if(
      *environment, [](const std::string& entry) { return entry.starts_with("STARTED="); });
  ASSERT_NE(started, environment->end());
  EXPECT_FALSE(testing_support::Alive(std::atoi(started->substr(8).c_str())));
}

TEST(CommandEnvironmentTest, ARunHasItsFolderAndItsCores) {
  controllers::command::Definition definition = WithSetup("");
  definition.cores = 3;
  EXPECT_THAT(
      EnvironmentOfRun({"HOME=/root", "HOMER=odyssey", "MKL_NUM_THREADS=64", "A=1"}, "/tmp/run", definition),
      testing::UnorderedElementsAre("HOME=/tmp/run", "TMPDIR=/tmp/run", "PWD=/tmp/run", "HOMER=odyssey",
                                    "A=1", "OMP_NUM_THREADS=3", "OPENBLAS_NUM_THREADS=3", "MKL_NUM_THREADS=3",
                                    "NUMEXPR_NUM_THREADS=3"));
}

}  // namespace
}  // namespace gauntlet::worker
