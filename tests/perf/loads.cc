#include "tests/perf/loads.h"

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "controllers/registry.h"
#include "search/cases/case_file.h"
#include "tests/support/paths.h"
#include "tests/support/toy_scenario.h"

namespace gauntlet::perf {
namespace {

namespace fs = std::filesystem;
using sim::Device;
using sim::Vec2;

sim::TestCase CaseIn(const fs::path& file) {
  auto loaded = LoadCase(file);
  GAUNTLET_CHECK(loaded.ok(), loaded.ok() ? "" : loaded.error().message);
  return loaded->test_case;
}

sim::TestCase ShippedCase(const std::string& name) {
  return CaseIn(fs::path(GAUNTLET_SOURCE_DIR) / "tests/perf/cases" / (name + ".json"));
}

// The scenario and the controller of that name.
Load LoadOf(std::string name, std::string what, std::uint64_t runs, const std::string& behaviour,
            sim::TestCase test_case, const sim::Parameters& given = {},
            const std::string& requirements = "") {
  sim::RunSpec spec;
  spec.requirements = requirements;
  spec.test_case = std::move(test_case);
  spec.scenario = behaviour;
  spec.scenario_parameters =
      controllers::ResolveParameters(controllers::FindScenario(behaviour)->parameters, given).value();
  spec.controller = behaviour;
  spec.controller_parameters =
      controllers::ResolveParameters(controllers::FindController(behaviour)->parameters, {}).value();
  const auto run = [spec](std::uint64_t seed, const sim::SimulationOptions& options) mutable {
    if (options.probe != nullptr) options.probe->Begin(sim::Phase::kStart);
    spec.seed = seed;
    auto scenario = controllers::CreateScenario(spec);
    GAUNTLET_CHECK(scenario.ok(), scenario.ok() ? "" : scenario.error().message);
    sim::SimulationOptions judged = options;
    judged.judge = controllers::JudgeOf(spec).value();
    return sim::Simulate(**scenario, seed, false, judged);
  };
  return {std::move(name), std::move(what), runs, run};
}

// Toy robots all over the default arena with the 8 obstacles of a first generation.
Load Toys(std::string name, std::string what, const sim::ToyRobot& robot, sim::Tick ticks) {
  const auto run = [robot, ticks](std::uint64_t seed, const sim::SimulationOptions& options) {
    if (options.probe != nullptr) options.probe->Begin(sim::Phase::kStart);
    constexpr int kRobots = 20;
    sim::RandomStream random(seed, sim::StreamPurpose::kTest);
    sim::TestCase test_case;
    test_case.obstacles = sim::RandomObstacles(8, random);
    auto swarm = sim::RandomRobots(kRobots, test_case, Vec2::Zero(), 2.9, robot.behaviour, random);
    for (sim::ToyRobot& one : swarm) {
      const sim::Pose pose = one.pose;
      one = robot;
      one.pose = pose;
    }
    sim::ToyScenario scenario(test_case, std::move(swarm), ticks);
    scenario.lamps = {{.position = {-2.5, -2.5}, .intensity = 3.0}};
    scenario.floor = [](const Vec2& point) { return point.x() > 0.0 ? 0.0 : 1.0; };
    return sim::Simulate(scenario, seed, false, options);
  };
  return {std::move(name), std::move(what), 2, run};
}

sim::Behaviour BlindWalk(double speed) {
  return [speed, turn_ticks = 0, turn_rate = 0.0](const sim::ControlStep& step) mutable {
    if (turn_ticks == 0 && step.random.Chance(0.02)) {
      turn_ticks = static_cast<int>(step.random.Below(25));
      turn_rate = step.random.Chance(0.5) ? 0.8 : -0.8;
    }
    step.actuators.Drive(speed, turn_ticks > 0 ? turn_rate : 0.0);
    if (turn_ticks > 0) --turn_ticks;
  };
}

}  // namespace

std::vector<Load> ShippedLoads() {
  std::vector<Load> loads;
  for (const auto& [experiment, runs] :
       {std::pair{"flocking", 6U}, {"foraging", 2U}, {"task-partitioning", 4U}}) {
    for (const std::string kind : {"evolved", "random"}) {
      const std::string name = std::string(experiment) + "-" + kind;
      loads.push_back(
          LoadOf(name, std::string(experiment) + ", " + kind + " case", runs, experiment, ShippedCase(name)));
    }
  }
  return loads;
}

Load RequiredLoad() {
  return LoadOf("flocking-required", "flocking, random case, three nested windows over a count", 6,
                "flocking", ShippedCase("flocking-random"), {},
                "near = count(distance_to(center) < 3)\n"
                "stay = always[0,300] eventually[0,60] always[0,30] near >= 6\n");
}

std::vector<Load> ArgosLoads() {
  sim::TestCase jam = ShippedCase("jam");
  std::string layout = "in a pocket";
  if (const char* folder = std::getenv("GAUNTLET_ARGOS_CASES")) {
    layout = "in environment1";
    const fs::path file = fs::path(folder) / "environment1.argos";
    jam = CaseIn(fs::exists(file) ? file : fs::path(folder) / "env1.argos");
  }
  sim::TestCase few = jam;
  jam.robots = 11;
  few.robots = 6;
  const sim::ToyRobot walker = {.pose = {},
                                .behaviour = sim::RandomWalk(0.1),
                                .devices = Device::kWheels | Device::kProximity | Device::kLight |
                                           Device::kMotorGround | Device::kRangeAndBearing};
  return {LoadOf("light-flocking-11", "light-flocking of 11, 200 s, " + layout, 4, "light-flocking",
                 std::move(jam), {{"time_limit", 200.0}}),
          LoadOf("light-flocking-6", "light-flocking of 6, 800 s, " + layout, 2, "light-flocking",
                 std::move(few), {{"time_limit", 800.0}}),
          Toys("walkers-20", "20 random walkers with proximity, light, ground, radio, 800 s", walker, 8000)};
}

std::vector<Load> CrowdLoads() {
  const sim::ToyRobot blind = {.pose = {}, .behaviour = BlindWalk(0.1), .devices = Device::kWheels};
  std::vector<Load> loads = ArgosLoads();
  loads.resize(1);
  loads.push_back(Toys("blind-20", "20 blind walkers, 200 s", blind, 2000));
  return loads;
}

}  // namespace gauntlet::perf
