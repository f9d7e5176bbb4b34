#include "search/experiment/definition_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/system/regular_file.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/support/paths.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

constexpr const char* kGathering = R"(scenario = "generic"
[generic]
fitness = "largest_cluster / robots"
failure = "largest_cluster < 0.5 * robots"
[[generic.light]]
x = -2
color = "red"
[[generic.light]]
[[generic.ground]]
radius = 0.5
)";

Result<Experiment> Read(const std::string& text, const std::vector<std::string>& sets = {}) {
  return ParseExperiment(text, "gather.toml", sets, BuiltInCatalogue());
}

std::string TableError(const std::string& text, const std::vector<std::string>& sets = {}) {
  const Result<Experiment> experiment = Read(text, sets);
  return experiment.ok() ? "" : experiment.error().message;
}

TEST(DefinitionTable, BecomesTheDefinitionOfTheExperimentsRuns) {
  const Result<Experiment> experiment = Read(kGathering);
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->controller, "light-flocking");
  EXPECT_EQ(
      experiment->definition,
      "fitness = largest_cluster / robots\nfailure = largest_cluster < 0.5 * robots\n"
      "light.1.x = -2\nlight.1.y = 0\nlight.1.height = 0.5\nlight.1.intensity = 3\nlight.1.color = red\n"
      "light.2.x = 0\nlight.2.y = 0\nlight.2.height = 0.5\nlight.2.intensity = 3\nlight.2.color = black\n"
      "ground.1.x = 0\nground.1.y = 0\nground.1.radius = 0.5\nground.1.length = 0\nground.1.width = 0\n"
      "ground.1.grey = 0\n");
  EXPECT_EQ(SpecOf(*experiment, {}, 1).definition, experiment->definition);
}

TEST(DefinitionTable, IsWrittenAsItIsRead) {
  const Result<Experiment> experiment = Read(kGathering, {"generic.reached=clusters == 1"});
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  const Result<Experiment> again = Read(WriteExperiment(*experiment, {}, BuiltInCatalogue()));
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(again->definition, experiment->definition);
}

TEST(DefinitionTable, IsChangedBySets) {
  const Result<Experiment> changed =
      Read(kGathering, {"generic.light.2.x=1.5", "generic.fitness=1", "generic.nest.1.radius=1"});
  ASSERT_TRUE(changed.ok()) << changed.error().message;
  EXPECT_THAT(changed->definition, HasSubstr("light.2.x = 1.5\n"));
  EXPECT_THAT(changed->definition, HasSubstr("fitness = 1\n"));
  EXPECT_THAT(changed->definition, HasSubstr("nest.1.radius = 1\n"));
}

TEST(DefinitionTable, IsTheSameFromItsSettings) {
  const Result<Experiment> experiment = Read(kGathering);
  std::vector<std::string> sets = {"scenario=generic"};
  for (const auto& [key, value] : DefinitionSettings(experiment->definition))
    sets.push_back(key + "=" + value);
  EXPECT_EQ(Read("", sets)->definition, experiment->definition);
}

TEST(DefinitionTable, ErrorsNameThePlace) {
  const std::string text = kGathering;
  EXPECT_EQ(
      TableError(text, {"generic.failure=largest_clutser < 3"}),
      "--set generic.failure=largest_clutser < 3: failure = \"largest_clutser < 3\": character 1: unknown "
      "measure 'largest_clutser'; did you mean 'largest_cluster'?");
  EXPECT_EQ(TableError(text + "grey = 2\n"),
            "gather.toml:11:1: ground.1.grey = 2.0 is out of range, allowed 0 to 1");
  EXPECT_EQ(TableError(text + "[[generic.lihgt]]\n"),
            "gather.toml:11:1: [generic]: unknown key 'lihgt'; did you mean 'light'?");
  EXPECT_EQ(TableError(text + "x = [1]\n"),
            "gather.toml:11:1: generic.ground.1.x is an array, expected a number or text");
  EXPECT_EQ(TableError("scenario = \"generic\"\n"),
            "gather.toml: [generic] fitness is missing: a formula such as \"largest_cluster / robots\"");
  EXPECT_EQ(TableError("scenario = \"flocking\"\n[generic]\nfitness = \"1\"\n"),
            "gather.toml:3:1: generic.fitness defines the scenario 'generic', and this is 'flocking'");
}

constexpr const char* kRequired =
    "scenario = \"flocking\"\n"
    "[requirements]\n"
    "failure = \"not stay\"\n"
    "near = \"\"\"count(distance_to(goal) < 1)\n  >= 8\"\"\"\n"
    "stay = \"eventually always[0,30] near\"\n";

TEST(RequirementTable, StandsInItsOrderWithTheFailureLast) {
  const Result<Experiment> experiment = Read(kRequired);
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->requirements,
            "near = count(distance_to(goal) < 1)   >= 8\nstay = eventually always[0,30] near\n"
            "failure = not stay\n");
  EXPECT_EQ(SpecOf(*experiment, {}, 1).requirements, experiment->requirements);
  EXPECT_EQ(Read("scenario = \"flocking\"\n")->requirements, "");
}

TEST(RequirementTable, IsWrittenAsItIsRead) {
  const Result<Experiment> experiment =
      Read(kRequired, {"requirements.soon=eventually near", "requirements.step=tick"});
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_THAT(experiment->requirements, testing::StartsWith("step = tick\nnear"));
  EXPECT_EQ(Read(WriteExperiment(*experiment, {}, BuiltInCatalogue()))->requirements,
            experiment->requirements);
  std::vector<std::string> sets = {"scenario=flocking"};
  for (const auto& [key, value] : RequirementSettings(experiment->requirements))
    sets.push_back(key + "=" + value);
  EXPECT_EQ(Read("", sets)->requirements, experiment->requirements);
}

TEST(RequirementTable, IsChangedAndTakenBackBySets) {
  EXPECT_THAT(Read(kRequired, {"requirements.near=count(x > 1) > 2"})->requirements,
              testing::StartsWith("near = count(x > 1) > 2\nstay"));
  EXPECT_THAT(Read(kRequired, {"requirements.failure="})->requirements, testing::EndsWith("near\n"));
}

TEST(RequirementTable, TheTablesOfThePageCanBeRead) {
  const std::string page = ReadRegularFile(GAUNTLET_SOURCE_DIR "/docs/requirements.md").value();
  int tables = 0;
  for (std::size_t at = 0; (at = page.find("```toml\n", at)) != std::string::npos; ++tables) {
    at += 8;
    EXPECT_EQ(TableError("scenario = \"flocking\"\n" + page.substr(at, page.find("```", at) - at)), "");
  }
  EXPECT_EQ(tables, 2);
}

TEST(RequirementTable, ErrorsNameThePlace) {
  EXPECT_EQ(
      TableError(kRequired, {"requirements.stay=always[3,1] near"}),
      "--set requirements.stay=always[3,1] near: requirements.stay = \"always[3,1] near\": character 11: the "
      "window [3,1] ends before it begins");
  EXPECT_EQ(TableError("scenario = \"flocking\"\n[requirements]\na = 3\n"),
            "gather.toml:3:1: requirements.a is a whole number, expected a formula as text");
  EXPECT_THAT(TableError("scenario = \"flocking\"\n[requirements]\na = \"count(x > 1)\"\n"),
              HasSubstr("gather.toml: [requirements] has no sentence that could be violated"));
}

TEST(RequirementTable, TellsOfWindowsThatAreTooLong) {
  EXPECT_THAT(WindowsBeyondTheRun(*Read(kRequired)), testing::IsEmpty());
  EXPECT_THAT(
      WindowsBeyondTheRun(*Read(kRequired, {"requirements.soon=eventually[0,1e6] near"})),
      testing::ElementsAre(HasSubstr("the window [0,1e+06] reaches beyond a run, which lasts 900 s")));
}

TEST(RequirementTable, MakesAnotherSearch) {
  const auto identity = [](const std::vector<std::string>& sets) {
    return SearchIdentity(SetupOf(*Read(kRequired, sets)));
  };
  EXPECT_NE(identity({}), identity({"requirements.near=count(x > 1) > 2"}));
}

}  // namespace
}  // namespace gauntlet
