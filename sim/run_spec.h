// Everything a run depends on. Same RunSpec, same RunResult, bit for bit.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "sim/arena/test_case.h"
#include "sim/robot/disturbances.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

// Parameter name -> value in SI units; booleans are 0 or 1. Resolved: every parameter of the scenario or
// controller stands here, so a later change of a default cannot change a stored run. Left out are those that
// came later than stored runs and have their default, which is what was done before.
using Parameters = std::map<std::string, double>;

// Which physics simulates a run; see sim/physics/physics_engine.h.
enum class PhysicsKind { kBox2d, kRelaxation, kImpulse };

// What is tested, and how it is simulated: what runs share that differ in their cases and seeds.
struct RunSettings {
  std::string scenario;         // registry name
  std::string scenario_plugin;  // SHA-256 of the library that brings the scenario, as `plugin` below
  // What the scenario consists of beyond its parameters, in the form that it writes itself; "": it is built
  // in as a whole.
  std::string definition;
  // What must hold beyond what the scenario says, as controllers/requirements reads it; "": nothing.
  std::string requirements;
  Parameters scenario_parameters;
  std::string controller;  // registry name of the controller under test
  Parameters controller_parameters;
  std::string plugin;  // SHA-256 of the library that brings the controller, hexadecimal; "": it is built in
  PhysicsKind physics = PhysicsKind::kImpulse;
  Disturbances disturbances;

  bool operator==(const RunSettings&) const = default;
};

struct RunSpec : RunSettings {
  TestCase test_case;
  std::uint64_t seed = 0;
  // No influence on the hash:
  bool record_trajectory = false;  // return every pose of every tick
  bool count_contacts = false;     // return RunResult::contacts
};

}  // namespace gauntlet::sim
