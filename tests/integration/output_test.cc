// What readers, full devices and hopeless searches do to the programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

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
