#include "search/experiment/command_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet {
namespace {

using testing::HasSubstr;

constexpr const char* kCommand =
    "scenario = \"command\"\n"
    "[command]\n"
    "run = [\"sim\", \"{case}\"]\n"
    "metrics = [\"items\"]\n"
    "fitness = \"items\"\n"
    "failure = \"items < 5\"\n";

std::string ComplaintOf(const std::string& more, const std::vector<std::string>& sets = {}) {
  const auto command = ReadCommand({kCommand + more, "my.toml"}, sets);
  return command.ok() ? "" : command.error().message;
}

TEST(CommandTable, BecomesADefinition) {
  const auto command = ReadCommand(
      {std::string(kCommand) + "cores = 2\nplace = { x = \"items\", y = \"items\", same_within = 1 }\n"
                               "[[command.parameter]]\nname = \"speed\"\nhigh = 1\n"
                               "[[command.parameter]]\nname = \"range\"\nhigh = 2.5\n",
       "my.toml"},
      {"command.wall_limit=30", "search.runs=5", "command.parameter.2.default=1"});
  ASSERT_TRUE(command.ok()) << command.error().message;
  ASSERT_TRUE(command->has_value());
  EXPECT_EQ((*command)->run, (std::vector<std::string>{"sim", "{case}"}));
  EXPECT_EQ((*command)->cores, 2);
  EXPECT_EQ((*command)->wall_limit, 30.0);
  ASSERT_EQ((*command)->parameters.size(), 2U);
  EXPECT_EQ((*command)->parameters[1].name, "range");
  EXPECT_EQ((*command)->parameters[1].default_value, 1.0);
  EXPECT_EQ((*command)->place->same_within, 1.0);
}

TEST(CommandTable, AnExperimentWithoutItHasNone) {
  const auto command = ReadCommand({"scenario = \"flocking\"\n", "my.toml"}, {"command.cores=2"});
  ASSERT_TRUE(command.ok());
  EXPECT_FALSE(command->has_value());
}

TEST(CommandTable, SaysWhereWhatIsWrongStands) {
  EXPECT_THAT(ComplaintOf("cores = 0\n"), HasSubstr("my.toml:7:1: cores = 0"));
  EXPECT_THAT(ComplaintOf("[[command.metric]]\nname = \"a\"\nfrom = \"log:(\"\n"),
              HasSubstr("my.toml:9:1: the metric 'a'"));
  EXPECT_THAT(ComplaintOf("corse = 1\n"),
              HasSubstr("my.toml:7:1: [command]: unknown key 'corse'; did you mean 'cores'?"));
  EXPECT_THAT(ComplaintOf("", {"command.cores=two"}), HasSubstr("--set command.cores=two: cores = \"two\""));
  EXPECT_THAT(ComplaintOf("", {"command.metric.2.name=b"}), HasSubstr("numbered 1, 2, 3"));
  EXPECT_THAT(ComplaintOf("", {"command.cores.x=1"}), HasSubstr("--set command.cores.x=1"));
  EXPECT_THAT(ComplaintOf("cores = 2001-01-01\n"), HasSubstr("is a date or time, expected"));
  EXPECT_THAT(ComplaintOf("cores = \n"), HasSubstr("my.toml:7"));
}

TEST(CommandTable, EveryListedKeyIsInIt) {
  for (const KeyInfo& key : CommandKeys()) EXPECT_TRUE(InCommand(key.path)) << key.path;
  EXPECT_FALSE(InCommand("commands.run"));
}

}  // namespace
}  // namespace gauntlet
