// A scenario: the arena's demands, the swarm, the end, the metrics and the fitness of one behaviour under
// test. One object per run.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "sim/arena/arena.h"
#include "sim/arena/validity.h"
#include "sim/observer.h"
#include "sim/robot/controller.h"
#include "sim/robot/grippers.h"
#include "sim/robot/surroundings.h"
#include "sim/run_result.h"
#include "sim/run_start.h"

namespace gauntlet::sim {

struct RobotSetup {
  Pose pose;
  Color beacon = Color::kBlack;  // lit from tick 0
  // Half side, in m, of the world-aligned square the robot's camera sees (ARGoS: camera height *
  // tan(aperture)).
  double camera_range = 0.0;
  std::unique_ptr<Controller> controller;
  double radio_range = foot_bot::kRangeAndBearingRange;  // m, how far its messages are heard
  bool bodies_block_radio = true;     // it hears no message through another robot, as in ARGoS
  DeviceSet equipment = kAllDevices;  // its controller must not ask for more
  bool under_test = true;             // false: it belongs to the scenario, as the prey of a flock does
};

// Fitness, metrics, failure, robots' `lost` flags and annotations of a finished run.
struct Outcome {
  double fitness = 0.0;
  std::vector<std::pair<std::string, double>> metrics;
  SwarmFailure failure;
  std::vector<bool> lost;  // per robot
  std::vector<Annotation> annotations;
  // Why the run cannot be judged, with the values that are to blame; not empty: all else is meaningless.
  std::string complaint;
};

// What a scenario sees and moves between physics and sensing.
struct Interaction {
  const Observer& observer;          // its newest tick has the poses that will be sensed
  std::span<const Signals> signals;  // per robot, as in action in this tick
  Grippers& grippers;
};

class Scenario : public Surroundings {
 public:
  virtual const Arena& arena() const = 0;
  // The run ends at this tick at the latest.
  virtual Tick tick_limit() const = 0;
  // The swarm in robot order. `headquarters` outlives the robots. Error: refused, the message begins with the
  // rule's name and a colon.
  virtual Result<std::vector<RobotSetup>> CreateSwarm(const Headquarters& headquarters) = 0;
  // For those who rebuild the scenario elsewhere.
  virtual std::vector<GroundArea> ground_areas() const { return {}; }
  // In every tick after physics, before sensing: hand items over, change lights and radio beacons.
  virtual void Interact(const Interaction& /*interaction*/) {}
  // After every tick: has the run come to its end?
  virtual bool Finished(const Observer& observer) = 0;
  virtual Outcome Evaluate(const Observer& observer) = 0;
};

// Adds to the outcome of a run that is over, and may change whether it failed. `under_test`: per robot.
using Judge = std::function<void(const Scenario& scenario, const Observer& observer,
                                 const std::vector<bool>& under_test, Outcome& outcome)>;

}  // namespace gauntlet::sim
