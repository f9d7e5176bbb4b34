#include "controllers/run_start.h"

#include <cstdint>

#include "controllers/registry.h"

namespace gauntlet::controllers {

Result<RunStart> StartOf(const sim::RunSpec& spec) {
  const auto scenario = CreateScenario(spec);
  if (!scenario.ok()) return scenario.error();
  const sim::Observer observer(0, 0);
  const auto swarm = (*scenario)->CreateSwarm(sim::Headquarters(observer));
  if (!swarm.ok()) return swarm.error();
  RunStart start;
  for (const sim::RobotSetup& robot : *swarm) {
    start.robots.push_back({.pose = robot.pose,
                            .camera_range = robot.camera_range,
                            .radio_range = robot.radio_range,
                            .bodies_block_radio = robot.bodies_block_radio,
                            .devices = robot.controller->Devices(),
                            .under_test = robot.under_test});
  }
  start.lights.assign((*scenario)->lights().begin(), (*scenario)->lights().end());
  start.radio_beacons = (*scenario)->radio_beacons().size();
  start.ground_areas = (*scenario)->ground_areas();
  start.tick_limit = (*scenario)->tick_limit();
  return start;
}

Result<std::size_t> CountSwarm(const sim::RunSpec& spec) {
  constexpr std::uint64_t kSeeds = 5;
  Error error;
  for (std::uint64_t i = 0; i < kSeeds; ++i) {
    sim::RunSpec trial = spec;
    trial.seed += i;
    const Result<RunStart> start = StartOf(trial);
    if (start.ok()) return start->robots.size();
    error = start.error();
  }
  return error;
}

}  // namespace gauntlet::controllers
