// A robot that spreads out by a field after Howard, Mataric and Sukhatme (DARS 2002): neighbours and
// obstacles push it away until it is at rest.
#pragma once

#include <optional>

#include "controllers/common/random_walk.h"
#include "controllers/common/steering.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers::coverage {

struct CoverageSettings {
  double neighbour_range = 0.0;  // m between centres, from here on neighbours do not push
  double obstacle_push = 0.0;    // 1/m^2, of a proximity reading of 1
  double gain = 0.0;             // m^3/s, speed per force
  double max_speed = 0.0;        // m/s, also that of the walk
  double rest_speed = 0.0;       // m/s, a slower robot is at rest
  std::optional<RandomWalkParameters> walk = std::nullopt;  // of a robot at rest; nothing: it stands
};

// The force on a robot, in its own frame (x ahead, y left), 1/m^2: a message from r m away pushes away from
// its sender with 1/r^2 - 1/neighbour_range^2, a proximity reading away from what it looks at with
// obstacle_push * reading. That both repel is the source's; the laws are chosen.
sim::Vec2 FieldForce(const sim::SensorReadings& readings, const CoverageSettings& settings);

// Steers along the force at gain * |force|, at most max_speed. Slower than rest_speed it is at rest: it
// stands, and says kStandingMessage, or walks at random. Not for sharing between threads.
class CoverageController : public sim::Controller {
 public:
  explicit CoverageController(const CoverageSettings& settings);
  sim::DeviceSet Devices() const override;
  void Step(const sim::ControlStep& step) override;
  double ListeningRange() const override { return settings_.neighbour_range; }

 private:
  CoverageSettings settings_;
  SteeringThresholds steering_;
  RandomWalk walk_;
};

}  // namespace gauntlet::controllers::coverage
