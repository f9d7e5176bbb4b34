// What tells installations of a program apart.
#include "worker/command/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/hash.h"
#include "tests/support/paths.h"
#include "tests/support/sanitizer.h"
#include "tests/worker/command/command_folder.h"

namespace gauntlet::worker {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using testing_support::ProcessResult;
using testing_support::RunProcess;

constexpr const char* kProbingWorker = GAUNTLET_BINARY_DIR "/gauntlet-worker";

std::uint64_t HashOfText(std::string_view text) {
  Fnv1a64 hash;
  hash.AddBytes(text);
  return hash.value();
}

class ProbeTest : public testing::Test {
 protected:
  void SetUp() override {
    if (testing_support::kSanitized) GTEST_SKIP() << "the sanitizers' threads";
  }
  Result<std::uint64_t> Probe(const controllers::command::Definition& definition) {
    CommandFiles files(folder_.settings());
    return ProbeOf(files, folder_.Add(definition));
  }
  controllers::command::Definition WithProbe(std::vector<std::string> probe) {
    controllers::command::Definition definition = ShellDefinition("true");
    definition.probe = std::move(probe);
    return definition;
  }

  CommandFolder folder_;
};

TEST_F(ProbeTest, IsAHashOfWhatIsPrintedToStdout) {
  const auto probed = Probe(WithProbe({"sh", "-c", "echo version 3; echo noise >&2"}));
  ASSERT_TRUE(probed.ok()) << probed.error().message;
  EXPECT_EQ(*probed, HashOfText("version 3\n"));
}

TEST_F(ProbeTest, FindsTheFilesAndTheSetup) {
  auto definition = WithProbe({"tool.sh"});
  definition.files = {folder_.AddFile("tool.sh", "#!/bin/sh\necho $EDITION\n", true)};
  definition.setup = "export EDITION=second";
  const auto probed = Probe(definition);
  ASSERT_TRUE(probed.ok()) << probed.error().message;
  EXPECT_EQ(*probed, HashOfText("second\n"));
}

TEST_F(ProbeTest, AFailureIsToldWithWhatWasPrinted) {
  const auto probed = Probe(WithProbe({"sh", "-c", "echo no license; exit 3"}));
  ASSERT_FALSE(probed.ok());
  EXPECT_EQ(probed.error().message, "the command's probe ended with exit code 3\nno license\n");
}

TEST_F(ProbeTest, WithoutOneTheProgramIsLookedFor) {
  auto definition = ShellDefinition("true");
  ASSERT_TRUE(Probe(definition).ok());
  EXPECT_EQ(*Probe(definition), HashOfText(""));
  definition.run[0] = "tool.sh";
  ASSERT_FALSE(Probe(definition).ok());
  EXPECT_THAT(Probe(definition).error().message, StartsWith("the program tool.sh cannot be started"));
  definition.files = {folder_.AddFile("tool.sh", "#!/bin/sh\n", true)};
  EXPECT_TRUE(Probe(definition).ok());
}

TEST_F(ProbeTest, StandsAmongGoldenHashesAndEndsNobodysChildren) {
  const std::string hash = folder_.Add(WithProbe({"echo", "one"}));
  const pid_t child = fork();
  if (child == 0) {
    while (true) pause();
  }
  const GoldenHashFunction built_in = [](const std::vector<std::string>& names) {
    proto::GoldenHashes golden;
    for (const std::string& name : names) golden[name] = 5;
    if (names.empty()) golden["all"] = 6;
    return golden;
  };
  const auto both = GoldenHashesOf({"flocking", "command:" + hash}, built_in, folder_.settings());
  ASSERT_TRUE(both.ok()) << both.error().message;
  EXPECT_EQ(*both, (proto::GoldenHashes{{"flocking", 5}, {"command:" + hash, HashOfText("one\n")}}));
  EXPECT_EQ(GoldenHashesOf({"command:" + hash}, built_in, folder_.settings())->size(), 1U);
  EXPECT_EQ(*GoldenHashesOf({}, built_in, {}), (proto::GoldenHashes{{"all", 6}}));
  EXPECT_FALSE(GoldenHashesOf({"command:" + hash}, built_in, {}).ok());
  EXPECT_TRUE(testing_support::Alive(child));
  kill(child, SIGKILL);
}

TEST_F(ProbeTest, AWorkerPrintsIt) {
  const std::string hash = folder_.Add(WithProbe({"echo", "one"}));
  const ProcessResult golden =
      RunProcess({kProbingWorker, "--golden", "command:" + hash, "--plugin", folder_.PathOf(hash)});
  EXPECT_EQ(golden.exit_code, 0) << golden.err;
  EXPECT_EQ(golden.out, proto::WriteGoldenHashes({{"command:" + hash, HashOfText("one\n")}}));
  const ProcessResult without = RunProcess({kProbingWorker, "--golden", "command:" + hash});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_EQ(without.err,
            "gauntlet-worker: the run needs the command " + hash + ": give its file by --plugin\n");
}

}  // namespace
}  // namespace gauntlet::worker
