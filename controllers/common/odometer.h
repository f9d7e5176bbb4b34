// How a robot knows its own motion: exactly (thesis 3.3.2). Errors are SourceEstimate's.
#pragma once

#include <cstdint>

#include "sim/geometry/vec2.h"
#include "sim/headquarters.h"

namespace gauntlet::controllers {

// What a robot's body did in one tick.
struct BodyMotion {
  sim::Vec2 shift = sim::Vec2::Zero();  // m, in the frame of the body before it moved: x ahead, y left
  double turn = 0.0;                    // rad, counter-clockwise
};

// Where a point that was at `point` in the body's frame is after the body moved.
sim::Vec2 AfterMotion(const sim::Vec2& point, const BodyMotion& motion);

class Odometer {
 public:
  virtual ~Odometer() = default;
  // The motion since the last call, or since the start.
  virtual BodyMotion Next() = 0;
};

// Takes the motion from the simulation through Headquarters, pushes by others included, and hands out nothing
// else of it: no position and no heading.
class BodyOdometer : public Odometer {
 public:
  // `headquarters` outlives it.
  BodyOdometer(const sim::Headquarters& headquarters, sim::RobotIndex robot, const sim::Pose& start);

  BodyMotion Next() override;

 private:
  const sim::Headquarters& headquarters_;
  sim::RobotIndex robot_;
  sim::Pose last_;
};

}  // namespace gauntlet::controllers
