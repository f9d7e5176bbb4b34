// Items: none appears, vanishes or is counted twice, in any tick, whatever robots do and whoever dies.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "controllers/partitioning/partitioning_registry.h"
#include "controllers/registry.h"
#include "sim/simulation.h"
#include "tests/controllers/run_support.h"

namespace gauntlet {
namespace {

using testing_support::Metric;
using testing_support::WatchedScenario;

// How a robot ends.
enum class End { kNever, kFreezes, kFallsSilent, kStopsMoving };

// A robot that works until a tick and then does not.
class Mortal : public sim::Controller {
 public:
  Mortal(std::unique_ptr<sim::Controller> controller, End end, sim::Tick tick)
      : controller_(std::move(controller)), end_(end), tick_(tick) {}

  sim::DeviceSet Devices() const override { return controller_->Devices(); }
  void Step(const sim::ControlStep& step) override {
    const bool over = end_ != End::kNever && step.tick >= tick_;
    if (!over || end_ == End::kStopsMoving) controller_->Step(step);
    if (!over) return;
    step.actuators.Drive(0.0, 0.0);
    if (end_ == End::kFallsSilent) step.actuators.message = {};
  }

 private:
  std::unique_ptr<sim::Controller> controller_;
  End end_;
  sim::Tick tick_;
};

// The scenario with a bookkeeper, who looks into every gripper before and after the scenario moved items.
class PartitionBookkeeper : public WatchedScenario {
 public:
  PartitionBookkeeper(std::unique_ptr<sim::Scenario> scenario, controllers::PartitioningSettings settings,
                      double handover_reach)
      : WatchedScenario(std::move(scenario)), settings_(settings), handover_reach_(handover_reach) {}

  // The robots that end, by number.
  std::vector<std::pair<End, sim::Tick>> ends;

  Result<std::vector<sim::RobotSetup>> CreateSwarm(const sim::Headquarters& headquarters) override {
    auto swarm = WatchedScenario::CreateSwarm(headquarters);
    if (!swarm.ok()) return swarm;
    held_.assign(swarm->size(), false);
    for (std::size_t i = 0; i < std::min(ends.size(), swarm->size()); ++i) {
      auto& controller = (*swarm)[i].controller;
      controller = std::make_unique<Mortal>(std::move(controller), ends[i].first, ends[i].second);
    }
    return swarm;
  }
  void Interact(const sim::Interaction& interaction) override {
    const sim::Tick tick = interaction.observer.last_tick();
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (interaction.grippers.Holds(static_cast<sim::RobotIndex>(i)) != held_[i]) {
        Complain(tick, i, "an item moved while the scenario did not look");
      }
    }
    WatchedScenario::Interact(interaction);
    const auto robots = interaction.observer.Latest();
    std::vector<std::size_t> gained;
    std::vector<std::size_t> lost;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      const bool holds = interaction.grippers.Holds(static_cast<sim::RobotIndex>(i));
      if (holds && !held_[i]) gained.push_back(i);
      if (!holds && held_[i]) lost.push_back(i);
      held_[i] = holds;
    }
    for (const std::size_t i : lost) {
      const sim::Vec2 place = robots[i].position();
      if ((place - settings_.Nest()).norm() <= settings_.nest_radius) {
        ++dropped;
        continue;
      }
      // The one that it named; several may hand over in one tick.
      const std::size_t partner = controllers::DecodePartition(interaction.signals[i].message).partner;
      const auto taker = std::find_if(gained.begin(), gained.end(), [&](std::size_t other) {
        return other == partner && (robots[other].position() - place).norm() <= handover_reach_;
      });
      if (taker == gained.end()) {
        Complain(tick, i, "an item gone beside the nest");
        continue;
      }
      gained.erase(taker);
      ++transfers;
    }
    for (const std::size_t i : gained) {
      ++taken;
      if ((robots[i].position() - settings_.Food()).norm() > settings_.pickup_distance) {
        Complain(tick, i, "an item from nowhere");
      }
    }
    if (taken != dropped + Held()) Complain(tick, 0, "items do not add up");
  }

  int Held() const { return static_cast<int>(std::count(held_.begin(), held_.end(), true)); }

  int taken = 0;
  int dropped = 0;
  int transfers = 0;
  std::string complaint;  // the first one

 private:
  void Complain(sim::Tick tick, std::size_t robot, const char* what) {
    if (complaint.empty()) complaint = fmt::format("tick {}, robot {}: {}", tick, robot, what);
  }

  controllers::PartitioningSettings settings_;
  double handover_reach_;
  std::vector<bool> held_;
};

// Small and quick, so that items change hands: 2.4 m from the source to the nest, hand-overs of 3 s every 0.8
// m.
sim::RunSpec QuickSpec(const std::string& controller, std::uint64_t seed) {
  sim::RunSpec spec;
  spec.scenario = "task-partitioning";
  spec.controller = controller;
  spec.seed = seed;
  spec.scenario_parameters = {{"nest_food_distance", 2.4}, {"time_limit", 150.0}};
  spec.controller_parameters = {
      {"transfer_time", 3.0}, {"least_handover_distance", 0.7}, {"wait_time", 30.0}};
  const char* length =
      controller == "task-partitioning-dynamic" ? "start_partition_length" : "partition_length";
  spec.controller_parameters[length] = 0.8;
  return spec;
}

controllers::PartitioningSettings SettingsOf(const sim::RunSpec& spec) {
  const auto& table = controllers::PartitioningParameters();
  return table.Read(*controllers::ResolveParameters(table.infos(), spec.scenario_parameters));
}

constexpr double kHandoverReach = 0.30 + 1e-9;  // m

void AddBoxes(sim::RunSpec& spec) {
  const controllers::PartitioningSettings settings = SettingsOf(spec);
  const auto requirements = settings.Requirements({});
  sim::RandomStream random(spec.seed, sim::StreamPurpose::kTest);
  const int tries = static_cast<int>(random.Below(7));
  testing_support::AddRandomBoxes(spec.test_case, requirements, random, tries, 6);
}

RC_GTEST_PROP(PartitioningItems, AddUpInEveryTickWhateverHappensToTheRobots, (std::uint64_t seed)) {
  const auto variants = controllers::PartitioningControllers();
  const auto variant = *rc::gen::inRange<std::size_t>(0, variants.size());
  sim::RunSpec spec = QuickSpec(std::string(variants[variant].name), seed);
  spec.test_case.robots = *rc::gen::inRange(1, 11);
  spec.scenario_parameters["start_mode"] = *rc::gen::inRange(0, 2);
  AddBoxes(spec);
  auto scenario = controllers::CreateScenario(spec);
  RC_ASSERT(scenario.ok());
  PartitionBookkeeper bookkeeper(std::move(*scenario), SettingsOf(spec), kHandoverReach);
  for (int i = 0; i < *spec.test_case.robots; ++i) {
    const auto end = static_cast<End>(*rc::gen::weightedElement<int>({{3, 0}, {1, 1}, {1, 2}, {1, 3}}));
    bookkeeper.ends.emplace_back(end, *rc::gen::inRange(100, 1500));
  }
  const sim::RunResult result = sim::Simulate(bookkeeper, spec.seed, false);
  if (result.verdict == sim::Verdict::kRefused) RC_DISCARD("no room to start");
  RC_ASSERT(result.verdict == sim::Verdict::kCompleted);
  RC_ASSERT(bookkeeper.complaint == std::string());
  RC_ASSERT(result.fitness == bookkeeper.dropped);
  RC_ASSERT(Metric(result, "food_taken") == bookkeeper.taken);
  RC_ASSERT(Metric(result, "food_carried") == bookkeeper.Held());
  RC_ASSERT(Metric(result, "transfers") == bookkeeper.transfers);
  RC_ASSERT(Metric(result, "food_lost") == 0.0);
  RC_TAG(bookkeeper.transfers > 0 ? "with transfers" : "without transfers");
}

// What the property is worth: in its arena items do change hands.
TEST(PartitioningItems, ChangeHandsInTheArenaOfTheProperty) {
  for (const controllers::ControllerInfo& controller : controllers::PartitioningControllers()) {
    const sim::RunSpec spec = QuickSpec(std::string(controller.name), 1);
    auto scenario = controllers::CreateScenario(spec);
    ASSERT_TRUE(scenario.ok());
    PartitionBookkeeper bookkeeper(std::move(*scenario), SettingsOf(spec), kHandoverReach);
    sim::Simulate(bookkeeper, spec.seed, false);
    EXPECT_EQ(bookkeeper.complaint, "");
    EXPECT_GE(bookkeeper.transfers, 2) << controller.name;
    EXPECT_GE(bookkeeper.dropped, 1) << controller.name;
  }
}

// A giver or a receiver that dies at any moment of a hand-over: it ends, and the item is in one hand.
TEST(PartitioningItems, ADeathInTheMiddleOfAHandOverLosesNothing) {
  for (const End end : {End::kFreezes, End::kFallsSilent, End::kStopsMoving}) {
    for (int robot = 0; robot < 6; ++robot) {
      const sim::RunSpec spec = QuickSpec("task-partitioning", 3);
      auto scenario = controllers::CreateScenario(spec);
      ASSERT_TRUE(scenario.ok());
      PartitionBookkeeper bookkeeper(std::move(*scenario), SettingsOf(spec), kHandoverReach);
      bookkeeper.ends.assign(6, {End::kNever, 0});
      bookkeeper.ends[static_cast<std::size_t>(robot)] = {end, 200 + 37 * robot};
      const sim::RunResult result = sim::Simulate(bookkeeper, spec.seed, false);
      EXPECT_EQ(result.verdict, sim::Verdict::kCompleted);
      EXPECT_EQ(bookkeeper.complaint, "") << robot;
    }
  }
}

}  // namespace
}  // namespace gauntlet
