// What readers, full devices and hopeless searches do to the programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

ProcessResult Shell(const std::string& script) {
  return RunProcess({"/bin/bash", "-c", script}, {"G=" + GauntletPath()});
}

TEST(OutputTest, AStandardOutputThatCannotBeWrittenExits4) {
  for (const std::string place : {"> /dev/full", ">&-"}) {
    const ProcessResult result = Shell("\"$G\" list " + place);
    EXPECT_EQ(result.exit_code, 4) << place;
    EXPECT_THAT(result.err, HasSubstr("standard output: cannot be written")) << place;
  }
}

TEST(OutputTest, AReaderThatLeftIsNoFailure) {
  const ProcessResult result = Shell("\"$G\" list --json | true; exit ${PIPESTATUS[0]}");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
}

TEST(OutputTest, AClosedProgressPipeDoesNotStopTheCampaign) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 2;
  std::string command = "\"$G\"";
  for (const std::string& argument : EvolveArguments(campaign, scratch / "c", 2)) {
    if (argument != "--quiet") command += " '" + argument + "'";
  }
  // The pipe of stderr has no reader from the beginning.
  const std::string code = scratch / "code";
  const ProcessResult status =
      Shell("{ " + command + " > /dev/null; echo $? > '" + code + "'; } 2>&1 | true; cat '" + code + "'");
  EXPECT_EQ(status.out, "0\n") << status.err;
}

TEST(OutputTest, NothingThatIsStoredIsOverwritten) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  ASSERT_EQ(
      Gauntlet({"random", "flocking", "--cases", "2", "--workers", "2", "--quiet", "--dir", dir}).exit_code,
      0);
  fs::copy_file(dir + "/campaign.db", scratch / "copy.svg");
  fs::create_symlink(dir + "/campaign.db", scratch / "link.svg");
  const std::string database = ReadFile(dir + "/campaign.db");
  for (const std::string& output : {dir + "/campaign.db", dir + "/experiment.toml", dir + "/plugins/new.so",
                                    scratch / "copy.svg", scratch / "link.svg"}) {
    for (const std::vector<std::string>& command : {std::vector<std::string>{"report", dir, "-o", output},
                                                    {"replay", dir, "1", "--svg", output},
                                                    {"compare", dir, dir, "--svg", output},
                                                    {"export", dir, "--format", "csv", "--out", output}}) {
      const ProcessResult refused = Gauntlet(command);
      EXPECT_EQ(refused.exit_code, 2) << command[0] << " " << output;
      EXPECT_THAT(refused.err, HasSubstr("not overwritten: name another file"))
          << command[0] << " " << output;
    }
  }
  EXPECT_EQ(ReadFile(dir + "/campaign.db"), database);
  EXPECT_EQ(ReadFile(scratch / "copy.svg"), database);
  EXPECT_FALSE(fs::exists(dir + "/plugins"));
  EXPECT_EQ(Gauntlet({"replay", dir, "1", "--svg", dir + "/picture.svg"}).exit_code, 0)
      << "no file of the campaign";
  EXPECT_EQ(Gauntlet({"replay", dir, "1", "--svg", dir + "/picture.svg"}).exit_code, 0) << "as any file";
}

// Who opens one waits for the other side.
TEST(OutputTest, ANamedPipeIsNeitherWrittenNorReadByItsName) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  ASSERT_EQ(
      Gauntlet({"random", "flocking", "--cases", "1", "--workers", "1", "--quiet", "--dir", dir}).exit_code,
      0);
  const std::string pipe = scratch / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::vector<std::string>& command : {std::vector<std::string>{"replay", dir, "1", "--svg", pipe},
                                                  {"evaluate", "flocking", "--case", pipe}}) {
    const ProcessResult refused = Gauntlet(command);
    EXPECT_EQ(refused.exit_code, 2) << command[0];
    EXPECT_THAT(refused.err, HasSubstr(pipe + " is a named pipe")) << command[0];
  }
  const ProcessResult piped =
      Shell("\"$G\" replay '" + dir + "' 1 --svg >(wc -c > '" + scratch / "bytes" +
            "') > /dev/null && \"$G\" replay '" + dir + "' 1 --svg /dev/stdout | grep -c '</svg>'");
  EXPECT_EQ(piped.exit_code, 0) << piped.err;
  EXPECT_EQ(piped.out, "1\n");
}

// 34 birds find room in the empty arena, so the search begins, but not between 60 obstacles.
TEST(OutputTest, ASearchWithoutAnyResultSaysWhyAndExits1) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  const ProcessResult result =
      Gauntlet({"evolve", "flocking", "--set", "scenario_parameters.birds=34", "--set", "genome.genes=60",
                "--generations", "2", "--population", "4", "--workers", "2", "--dir", dir});
  EXPECT_EQ(result.exit_code, 1) << result.err;

  const nlohmann::json reasons = Show(dir)["runs_without_result"];
  ASSERT_EQ(reasons.size(), 1U);
  EXPECT_EQ(reasons[0]["verdict"], "refused");
  EXPECT_EQ(reasons[0]["rule"], "no-room-to-spawn");
  EXPECT_EQ(reasons[0]["runs"], 8);

  const ProcessResult replayed = Gauntlet({"replay", dir, "1", "--svg", scratch / "r.svg"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_EQ(replayed.out,
            "flocking, run 1: reproduced\n"
            "\n"
            "  test case    1 (generation 1)\n"
            "  seed         7199637972916648790\n"
            "  outcome      refused: no-room-to-spawn: only 16 of 34 robots fit into the reachable part of "
            "(1.526, 1.526) to (3.474, 3.474) m, the enlarged spawn area\n"
            "  verdict      refused\n"
            "  stored hash  233732584dda2ecf\n"
            "  new hash     233732584dda2ecf  (the same)\n");
}

}  // namespace
}  // namespace gauntlet::testing_support
