#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using Arguments = std::vector<std::string>;

class FitCommand : public CommandLine {
 protected:
  Arguments With(const Arguments& more) const {
    Arguments arguments = {"fit", "flocking", "--targets", targets_, "--dir", Path("c")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void SetUp() override {
    CommandLine::SetUp();
    targets_ = Write("targets.toml", "[[target]]\nmetric = \"fitness\"\nvalue = 0.7\nn = 100\n");
  }

  std::string targets_;
};

TEST_F(FitCommand, PrintsItsExperimentForOthersToRun) {
  ASSERT_EQ(Run(With({"--vary", "controller_parameters.turn_rate=.5..2", "--budget", "2000",
                      "--print-experiment"})),
            kExitDone)
      << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("\nalgorithm = \"fit\" "));
  EXPECT_THAT(out_.str(), HasSubstr("\nvary = \"controller_parameters.turn_rate=0.5..2\" "));
  EXPECT_THAT(out_.str(),
              HasSubstr("\ntargets = \"cases=random statistic=mean metric=fitness value=0.7 n=100\" "));
  EXPECT_THAT(out_.str(), HasSubstr("\nruns = 2000 "));
  EXPECT_THAT(out_.str(), HasSubstr("\nsearch = \"genetic\" "));
}

TEST_F(FitCommand, NamesWhatIsMissingOrWrong) {
  const std::string vary = "controller_parameters.turn_rate=.5..2";
  const std::vector<std::pair<Arguments, std::string>> wrong = {
      {{"fit", "flocking", "--vary", vary}, "held against what? --targets FILE.toml"},
      {With({}), "what may vary? --vary KEY=LOW..HIGH"},
      {With({"--vary", "controller_parameters.turn_rate=2..1"}), "2 is not below 1"},
      {With({"--vary", "controller_parameters.turn_rate=0..99"}), "out of range"},
      {With({"--vary", "scenario_parameters.rejoin_time=0..1:log"}), "has no logarithm"},
      {With({"--vary", vary, "--vary", vary}), "twice"},
      {With({"--vary", "seed=1..2"}), "seed"},
      {With({"--vary", vary, "--set", "controller_parameters.turn_rate=1"}),
       "turn_rate is given by --set and varied by --vary"},
      {With({"--vary", vary, "--budget", "100"}),
       "100 runs are too few for a posterior over 1 key: at least 20 settings with 20 runs each are needed, "
       "400 "
       "runs in all"},
      {With({"--vary", vary, "--budget", "many"}),
       "--budget many: a whole number from 1 to 100000000 is needed"},
      {With({"--vary", vary, "--draws", "5"}), "--draws is for --predict"},
      {{"fit", "flocking", "--vary", vary, "--targets", Path("none.toml")}, "none.toml: No such file"}};
  for (const auto& [arguments, message] : wrong) ExpectUsageError(arguments, HasSubstr(message));
}

}  // namespace
}  // namespace gauntlet
