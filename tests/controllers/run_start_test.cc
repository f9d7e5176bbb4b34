#include "controllers/run_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "controllers/registry.h"

namespace gauntlet::controllers {
namespace {

using testing::HasSubstr;

sim::RunSpec LightFlocking() {
  sim::RunSpec spec;
  spec.scenario = "light-flocking";
  spec.controller = "light-flocking";
  return spec;
}

// A plug-in as a master knows it: nothing of it is in this process, but somebody answers for it.
class ForeignScenario : public testing::Test {
 protected:
  ForeignScenario() {
    asked_.clear();
    no_room_for_.clear();
    PluginInfo plugin{
        .hash = std::string(64, 'a'), .file = "libfar.so", .description = "", .controllers = {}};
    plugin.scenarios = {{.name = "far-away",
                         .description = "",
                         .default_controller = "light-flocking",
                         .metrics = {},
                         .any_controller = true}};
    plugin.begin = [](const sim::RunSpec& spec) -> Result<sim::RunBeginning> {
      asked_.push_back(spec.seed);
      if (std::ranges::count(no_room_for_, spec.seed) > 0)
        return sim::RunBeginning{{}, InvalidInput("no-room-to-spawn: here")};
      sim::RunStart start;
      start.robots.resize(3);
      return sim::RunBeginning{{.start = {0.5, 0.0}}, start};
    };
    EXPECT_TRUE(AddPlugin(plugin).ok());
    spec_.scenario = "far-away";
    spec_.scenario_plugin = plugin.hash;
    spec_.controller = "light-flocking";
    spec_.seed = 77;
  }

  static inline std::vector<std::uint64_t> asked_;
  static inline std::vector<std::uint64_t> no_room_for_;
  sim::RunSpec spec_;
};

TEST(RequirementsOf, AreThoseOfTheScenariosRow) {
  sim::RunSpec spec = LightFlocking();
  spec.scenario_parameters = {{"corner_distance", 1.0}};
  const auto requirements = RequirementsOf(spec);
  ASSERT_TRUE(requirements.ok());
  EXPECT_EQ(requirements->start, sim::Vec2(2.0, 2.0));
  spec.scenario = "light-floking";
  EXPECT_EQ(RequirementsOf(spec).error().message,
            "unknown scenario 'light-floking'; did you mean 'light-flocking'?");
}

TEST(BeginningOf, HasDemandsAlsoOfARunThatCannotBegin) {
  sim::RunSpec spec = LightFlocking();
  spec.test_case.obstacles = {{0.0, 0.0, 7.0, 0.2, 0.0}};
  const auto beginning = BeginningOf(spec);
  ASSERT_TRUE(beginning.ok());
  EXPECT_EQ(beginning->requirements.start, sim::Vec2(2.5, 2.5));
  ASSERT_FALSE(beginning->start.ok());
  EXPECT_EQ(beginning->start.error().message,
            "no-path: obstacle 1 (x 0 m, y 0 m, 7 x 0.2 m at 0 degrees) leaves no path from (2.5, 2.5) to "
            "(-2.5, -2.5) for a robot's body");
}

TEST_F(ForeignScenario, IsFoundInItsPluginOnly) {
  EXPECT_EQ(FindScenario("far-away"), nullptr);
  ASSERT_NE(FindScenario("far-away", spec_.scenario_plugin), nullptr);
  EXPECT_EQ(FindScenario("light-flocking", spec_.scenario_plugin), nullptr);
}

TEST_F(ForeignScenario, IsNotBuiltHere) {
  const auto scenario = CreateScenario(spec_);
  ASSERT_FALSE(scenario.ok());
  EXPECT_THAT(scenario.error().message, HasSubstr("is not loaded"));
  spec_.scenario_plugin = std::string(64, 'b');
  EXPECT_THAT(RequirementsOf(spec_).error().message, HasSubstr("is not loaded"));
}

TEST_F(ForeignScenario, StartsWhereItsOwnSeedSays) {
  ASSERT_TRUE(StartOf(spec_).ok());
  EXPECT_THAT(asked_, testing::ElementsAre(77u));
}

// Specs that differ in their seed alone are one question.
TEST_F(ForeignScenario, IsAskedAboutDemandsAndNumbersWithTheSameSeedForAll) {
  EXPECT_EQ(RequirementsOf(spec_)->start, sim::Vec2(0.5, 0.0));
  EXPECT_EQ(CountSwarm(spec_).value().robots, 3u);
  spec_.seed = 78;
  EXPECT_EQ(CountSwarm(spec_).value().robots, 3u);
  EXPECT_THAT(asked_, testing::ElementsAre(1u, 1u, 1u));
}

TEST_F(ForeignScenario, IsGivenFiveSeedsToFindRoom) {
  no_room_for_ = {1, 2};
  EXPECT_EQ(CountSwarm(spec_).value().robots, 3u);
  no_room_for_ = {1, 2, 3, 4, 5};
  EXPECT_EQ(CountSwarm(spec_).error().message, "no-room-to-spawn: here");
}

TEST(AddPlugin, RefusesAScenarioWithTheNameOfABuiltInOne) {
  PluginInfo plugin{.hash = std::string(64, 'c'), .file = "libmine.so", .description = "", .controllers = {}};
  plugin.scenarios = {
      {.name = "flocking", .description = "", .default_controller = "flocking", .metrics = {}}};
  const Status added = AddPlugin(plugin);
  ASSERT_FALSE(added.ok());
  EXPECT_EQ(
      added.error().message,
      "the plug-in libmine.so brings a scenario 'flocking', which is the name of a built-in one: give it "
      "a name of its own");
}

}  // namespace
}  // namespace gauntlet::controllers
