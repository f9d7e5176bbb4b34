// Items: none appears, vanishes or is counted twice, in any tick.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "controllers/foraging/foraging_registry.h"
#include "controllers/registry.h"
#include "sim/simulation.h"
#include "tests/controllers/run_support.h"

namespace gauntlet {
namespace {

using testing_support::Metric;
using testing_support::WatchedScenario;

// The foraging scenario with a bookkeeper, who looks into every gripper before and after the scenario moved
// items.
class Bookkeeper : public WatchedScenario {
 public:
  Bookkeeper(std::unique_ptr<sim::Scenario> scenario, const controllers::ForagingSettings& settings,
             int robots)
      : WatchedScenario(std::move(scenario)),
        settings_(settings),
        held_(static_cast<std::size_t>(robots), false) {}

  void Interact(const sim::Interaction& interaction) override {
    const sim::Tick tick = interaction.observer.last_tick();
    const auto robots = interaction.observer.Latest();
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (interaction.grippers.Holds(static_cast<sim::RobotIndex>(i)) != held_[i]) {
        Say(tick, i, "an item moved while the scenario did not look");
      }
    }
    WatchedScenario::Interact(interaction);
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const bool holds = interaction.grippers.Holds(static_cast<sim::RobotIndex>(i));
      const sim::Vec2 place = robots[i].position();
      if (holds && !held_[i]) {
        if ((place - settings_.Food()).norm() > settings_.pickup_distance) {
          Say(tick, i, "an item taken beyond the reach of the food");
        }
        if (last_taken_ >= 0 && tick - last_taken_ < settings_.serving_interval) {
          Say(tick, i, "two items within one interval");
        }
        last_taken_ = tick;
        ++taken;
      }
      if (!holds && held_[i]) {
        if ((place - settings_.Nest()).norm() > settings_.nest_radius) {
          Say(tick, i, "an item dropped beside the nest");
        }
        ++dropped;
      }
      held_[i] = holds;
    }
    if (taken != dropped + Held()) Say(tick, 0, "items do not add up");
  }

  int Held() const { return static_cast<int>(std::count(held_.begin(), held_.end(), true)); }

  int taken = 0;
  int dropped = 0;
  std::string complaint;  // the first one

 private:
  void Say(sim::Tick tick, std::size_t robot, const char* what) {
    if (complaint.empty()) complaint = fmt::format("tick {}, robot {}: {}", tick, robot, what);
  }

  controllers::ForagingSettings settings_;
  std::vector<bool> held_;
  sim::Tick last_taken_ = -1;
};

// Small and quick, so that items flow: nest and food 2 m apart, an item every 3 s.
sim::RunSpec BusySpec(std::uint64_t seed) {
  sim::RunSpec spec;
  spec.scenario = "foraging";
  spec.seed = seed;
  spec.scenario_parameters = {{"nest_food_distance", 2.0}, {"time_limit", 120.0}, {"serving_interval", 3.0}};
  return spec;
}

void AddRandomObstacles(sim::RunSpec& spec, const controllers::ForagingSettings& settings) {
  const auto requirements = settings.Requirements({});
  sim::RandomStream random(spec.seed, sim::StreamPurpose::kTest);
  const int tries = static_cast<int>(random.Below(9));
  testing_support::AddRandomBoxes(spec.test_case, requirements, random, tries, 8);
}

RC_GTEST_PROP(ForagingItems, AddUpInEveryTickOfRandomArenas, (std::uint64_t seed)) {
  sim::RunSpec spec = BusySpec(seed);
  const auto variants = controllers::ForagingControllers();
  spec.controller = std::string(variants[*rc::gen::inRange<std::size_t>(0, variants.size())].name);
  const int robots = *rc::gen::inRange(1, 13);
  spec.test_case.robots = robots;
  const auto parameters = controllers::ResolveParameters(controllers::ForagingScenarioInfo().parameters,
                                                         spec.scenario_parameters);
  RC_ASSERT(parameters.ok());
  const controllers::ForagingSettings settings = controllers::ForagingParameters().Read(*parameters);
  AddRandomObstacles(spec, settings);
  auto scenario = controllers::CreateScenario(spec);
  RC_ASSERT(scenario.ok());
  Bookkeeper bookkeeper(std::move(*scenario), settings, robots);
  const sim::RunResult result = sim::Simulate(bookkeeper, spec.seed, false);
  if (result.verdict == sim::Verdict::kRefused) RC_DISCARD("no room around the nest");
  RC_ASSERT(result.verdict == sim::Verdict::kCompleted);
  RC_ASSERT(bookkeeper.complaint == std::string());
  RC_ASSERT(result.fitness == bookkeeper.dropped);
  RC_ASSERT(Metric(result, "food_taken") == bookkeeper.taken);
  RC_ASSERT(Metric(result, "food_carried") == bookkeeper.Held());
  RC_ASSERT(Metric(result, "food_lost") == 0.0);
  RC_TAG(bookkeeper.dropped > 0 ? "with drops" : "without drops");
}

// What the property is worth: in the arena above items do flow.
TEST(ForagingItems, FlowInTheArenaOfTheProperty) {
  sim::RunSpec spec = BusySpec(1);
  spec.controller = "foraging-basic";
  spec.test_case.robots = 8;
  const auto parameters = controllers::ResolveParameters(controllers::ForagingScenarioInfo().parameters,
                                                         spec.scenario_parameters);
  ASSERT_TRUE(parameters.ok());
  auto scenario = controllers::CreateScenario(spec);
  ASSERT_TRUE(scenario.ok());
  Bookkeeper bookkeeper(std::move(*scenario), controllers::ForagingParameters().Read(*parameters), 8);
  sim::Simulate(bookkeeper, spec.seed, false);
  EXPECT_EQ(bookkeeper.complaint, "");
  EXPECT_GE(bookkeeper.taken, 4);
  EXPECT_GE(bookkeeper.dropped, 4);
}

}  // namespace
}  // namespace gauntlet
