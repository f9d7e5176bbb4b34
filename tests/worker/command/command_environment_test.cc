// What programs find in their environment.
#include "worker/command/command_environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/process.h"
#include "tests/worker/command/command_folder.h"

namespace gauntlet::worker {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing_support::TemporaryDirectory;

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

TEST(CommandEnvironmentTest, WhatSetupStartsDoesNotStay) {
  if (testing_support::kSanitized) GTEST_SKIP();
  const auto environment = EnvironmentAfterSetup(WithSetup("sleep 600 & export STARTED=$!"));
  ASSERT_TRUE(environment.ok());
  for (const std::string& entry : *environment) {
    if (entry.starts_with("STARTED=")) EXPECT_FALSE(testing_support::Alive(std::atoi(entry.c_str() + 8)));
  }
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
