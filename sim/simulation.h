// The simulation loop: act, physics, observe, sense, control; tick order as in ARGoS3 (commands of tick t
// move the robot in tick t + 1).
#pragma once

#include <cstdint>

#include "sim/run_result.h"
#include "sim/run_spec.h"
#include "sim/scenario.h"
#include "sim/sensors/sensor_probe.h"

namespace gauntlet::sim {

// The parts of a run, in order; those between the first and the last make a tick.
enum class Phase { kStart, kPhysics, kObserve, kInteract, kSense, kControl, kResult };

// Told when a phase begins, and within kSense when a device's sensors begin; for benchmarks (the simulation
// itself has no clock).
class PhaseProbe : public SensorProbe {
 public:
  virtual void Begin(Phase phase) = 0;
  void BeginDevice(Device /*device*/) override {}
  // After the last phase of a tick.
  virtual void EndTick() = 0;
};

// How a run is simulated, beside its scenario and seed.
struct SimulationOptions {
  PhysicsKind physics = PhysicsKind::kImpulse;
  Disturbances disturbances = {};
  PhaseProbe* probe = nullptr;  // told of every phase
  bool count_contacts = false;
  Judge judge = nullptr;  // after the scenario
};

// Simulates the scenario to its end. A function of scenario, seed, physics and disturbances alone. Never
// throws.
// A swarm that cannot be simulated (no robots, a robot outside the interior or inside an obstacle, a device
// that this simulator lacks, noise or a fault that cannot be) is refused; a wheel speed that is not finite or
// beyond foot_bot::kMaxWheelSpeed ends the run with the verdict kInvalidCommand, and so does a light of the
// scenario or a radio beacon that is not finite, and a fitness or metric that is none, and a robot that gets
// out of the walls. The message names robot, light or beacon, tick and value.
RunResult Simulate(Scenario& scenario, std::uint64_t seed, bool record_trajectory,
                   const SimulationOptions& options = {});

}  // namespace gauntlet::sim
