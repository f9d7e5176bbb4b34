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
  EXPECT_THAT(result.out, HasSubstr("NO RUN GAVE A RESULT"));
  EXPECT_THAT(result.out, HasSubstr("8 of 8 refused: no-room-to-spawn: "));
  EXPECT_THAT(result.err, HasSubstr("none of the 8 runs gave a result, most often: no-room-to-spawn: "));

  const nlohmann::json reasons = Show(dir)["runs_without_result"];
  ASSERT_EQ(reasons.size(), 1U);
  EXPECT_EQ(reasons[0]["verdict"], "refused");
  EXPECT_EQ(reasons[0]["rule"], "no-room-to-spawn");
  EXPECT_EQ(reasons[0]["runs"], 8);

  const ProcessResult replayed = Gauntlet({"replay", dir, "1", "--svg", scratch / "r.svg"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_THAT(replayed.out, HasSubstr("reproduced"));
  EXPECT_THAT(replayed.out, HasSubstr("no-room-to-spawn: "));
}

}  // namespace
}  // namespace gauntlet::testing_support
