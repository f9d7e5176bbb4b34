// A run spec and a run result that use every field.
#pragma once

#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet {

inline sim::RunSpec SampleSpec() {
  sim::RunSpec spec;
  spec.test_case.name = "sample \"case\"";
  spec.test_case.side_x = 7.0;
  spec.test_case.wall_thickness = 0.25;
  spec.test_case.obstacles = {{1.0, 2.0, 0.5, 0.1, 45.0}, {0.1, 1.0 / 3.0, 0.7, 0.0, 359.0}};
  spec.test_case.obstacles[1].path = {{0.5, 0.25}, {1.0, -1.0 / 3.0}};
  spec.test_case.obstacles[1].speed = 0.02;
  spec.test_case.obstacles[0].light = sim::Color::kRed;
  spec.test_case.spawn_area = sim::Rectangle{{0.5, 0.25}, {1.5, 2.5}};
  spec.test_case.robots = 12;
  spec.scenario = "flocking";
  spec.scenario_parameters = {{"duration", 200.0}, {"birds", 10.0}};
  spec.controller = "bird";
  spec.controller_parameters = {{"speed", 0.07}};
  spec.seed = 0xfedcba9876543210ULL;
  spec.record_trajectory = true;
  spec.physics = sim::PhysicsKind::kRelaxation;
  spec.disturbances.noise = {{sim::Device::kProximity, {.uniform = 0.01, .gaussian = 0.02}},
                             {sim::Device::kRangeAndBearing, {.drop = 0.1}}};
  spec.disturbances.faults = {{.robot = 3, .device = sim::Device::kWheels, .tick = 500},
                              {.robot = 0, .device = {}, .tick = 7}};
  spec.disturbances.random_faults = {
      .count = 2, .device = sim::Device::kLeds, .tick = 3, .role = sim::FaultyRole::kAll};
  return spec;
}

inline sim::RunResult SampleResult(double fitness) {
  sim::RunResult result;
  result.message = "";
  result.fitness = fitness;
  result.metrics = {{"zeta", 1.5}, {"alpha", -0.0}};
  result.failure = {true, 7, "split at an obstacle"};
  result.ticks = 2000;
  result.robots = {{{{1, 2}, 0.5}, {{3, 4}, -0.5}, 12.5, false, {{1, 2}, {3, 4}}},
                   {{{5, 6}, 1.5}, {{7, 8}, -1.5}, 2.5, true, {{5, 6}, {6, 7}, {7, 8}}}};
  result.annotations = {{"path", "the prey's", {{0, 0}, {1, 1}}, 0.0, -1, {}},
                        {"disc", "goal", {{2, 2}}, 0.3, 17, {0, 1}}};
  result.trajectory_hash = 0x123456789abcdef0ULL;
  result.trajectory = {{{1, 2, 0.1, 0.2}, {3, 4, 0.3, 0.4}}, {{5, 6, 0.5, 0.6}, {7, 8, 0.7, 0.8}}};
  result.cpu_seconds = 0.015;
  sim::SetHashes(result);
  return result;
}

}  // namespace gauntlet
