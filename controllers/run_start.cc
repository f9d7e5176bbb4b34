#include "controllers/run_start.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>

#include "controllers/registry.h"

namespace gauntlet::controllers {
namespace {

// Whoever answers for the spec's scenario in another process; nullptr: its row is here.
const std::function<Result<sim::RunBeginning>(const sim::RunSpec&)>* ElsewhereOf(const sim::RunSpec& spec) {
  const PluginInfo* plugin = spec.scenario_plugin.empty() ? nullptr : FindPlugin(spec.scenario_plugin);
  return plugin == nullptr || !plugin->begin ? nullptr : &plugin->begin;
}

// Whatever depends on no seed is asked with this one.
constexpr std::uint64_t kAnySeed = 1;

sim::RunSpec WithSeed(sim::RunSpec spec, std::uint64_t seed) {
  spec.seed = seed;
  return spec;
}

Result<sim::ArenaRequirements> RequirementsHere(const sim::RunSpec& spec) {
  TRY(const ScenarioInfo* scenario, ScenarioOf(spec));
  if (!scenario->requirements) return InvalidInput("the plug-in " + spec.scenario_plugin + " is not loaded");
  TRY(const sim::Parameters parameters, ResolveParameters(scenario->parameters, spec.scenario_parameters));
  return scenario->requirements(parameters, spec.test_case);
}

Result<sim::RunStart> StartHere(const sim::RunSpec& spec) {
  TRY(const auto scenario, CreateScenario(spec));
  const sim::Observer observer(0, 0);
  TRY(const auto swarm, scenario->CreateSwarm(sim::Headquarters(observer)));
  sim::RunStart start;
  for (const sim::RobotSetup& robot : swarm) {
    start.robots.push_back({.pose = robot.pose,
                            .camera_range = robot.camera_range,
                            .radio_range = robot.radio_range,
                            .bodies_block_radio = robot.bodies_block_radio,
                            .devices = robot.controller->Devices(),
                            .under_test = robot.under_test});
  }
  start.lights.assign(scenario->lights().begin(), scenario->lights().end());
  start.radio_beacons = scenario->radio_beacons().size();
  start.ground_areas = scenario->ground_areas();
  start.tick_limit = scenario->tick_limit();
  return start;
}

}  // namespace

Result<sim::ArenaRequirements> RequirementsOf(const sim::RunSpec& spec) {
  const auto* elsewhere = ElsewhereOf(spec);
  if (elsewhere == nullptr) return RequirementsHere(spec);
  TRY(const sim::RunBeginning beginning, (*elsewhere)(WithSeed(spec, kAnySeed)));
  return beginning.requirements;
}

Result<sim::RunStart> StartOf(const sim::RunSpec& spec) {
  const auto* elsewhere = ElsewhereOf(spec);
  if (elsewhere == nullptr) return StartHere(spec);
  TRY(sim::RunBeginning beginning, (*elsewhere)(spec));
  return std::move(beginning.start);
}

Result<sim::SwarmSize> CountSwarm(const sim::RunSpec& spec) {
  constexpr std::uint64_t kSeeds = 5;
  const std::uint64_t first = ElsewhereOf(spec) == nullptr ? spec.seed : kAnySeed;
  Error error;
  for (std::uint64_t i = 0; i < kSeeds; ++i) {
    const Result<sim::RunStart> start = StartOf(WithSeed(spec, first + i));
    if (start.ok()) {
      const auto tested = std::ranges::count(start->robots, true, &sim::StartingRobot::under_test);
      return sim::SwarmSize{.robots = start->robots.size(), .under_test = static_cast<std::size_t>(tested)};
    }
    error = start.error();
  }
  return error;
}

Result<sim::RunBeginning> BeginningOf(const sim::RunSpec& spec) {
  TRY(const sim::ArenaRequirements requirements, RequirementsHere(spec));
  return sim::RunBeginning{requirements, StartHere(spec)};
}

}  // namespace gauntlet::controllers
