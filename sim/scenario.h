// A scenario: the arena's demands, the swarm, the end, the metrics and the fitness of one behaviour under
// test. One object per run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/arena/validity.h"
#include "sim/base/result.h"
#include "sim/headquarters.h"
#include "sim/observer.h"
#include "sim/robot/controller.h"
#include "sim/run_result.h"

namespace gauntlet::sim {

struct RobotSetup {
  Pose pose;
  Color beacon = Color::kBlack;  // lit from tick 0
  // Half side, in m, of the world-aligned square the robot's camera sees (ARGoS: camera height *
  // tan(aperture)).
  double camera_range = 0.0;
  std::unique_ptr<Controller> controller;
};

// Fitness, metrics, failure, robots' `lost` flags and annotations of a finished run.
struct Outcome {
  double fitness = 0.0;
  std::vector<std::pair<std::string, double>> metrics;
  SwarmFailure failure;
  std::vector<bool> lost;  // per robot
  std::vector<Annotation> annotations;
};

class Scenario {
 public:
  virtual ~Scenario() = default;
  virtual const Arena& arena() const = 0;
  // The run ends at this tick at the latest.
  virtual Tick tick_limit() const = 0;
  // The swarm in robot order. `headquarters` outlives the robots. Error: refused, the message begins with the
  // rule's name and a colon.
  virtual Result<std::vector<RobotSetup>> CreateSwarm(const Headquarters& headquarters) = 0;
  // After every tick: has the run come to its end?
  virtual bool Finished(const Observer& observer) = 0;
  virtual Outcome Evaluate(const Observer& observer) = 0;
};

}  // namespace gauntlet::sim
