// How a robot knows its own motion: thesis 3.3.2 has no odometry errors; Pini et al. 2014 have them.
#pragma once

#include <cstdint>

#include "sim/geometry/vec2.h"
#include "sim/headquarters.h"
#include "sim/random/random_stream.h"

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
  // A new way begins, and with it a new error.
  virtual void BeginTrip(sim::RandomStream& random) = 0;
};

// Takes the motion from the simulation through Headquarters, pushes by others included, and hands out nothing
// else of it: no position and no heading. With a `drift` one wheel, drawn per trip, is measured too long by a
// share that is drawn per trip from a Rayleigh distribution with this scale (Buchanan et al. 2016; Pini et
// al. 2014: 0.0027). 0 = exact.
class BodyOdometer : public Odometer {
 public:
  // `headquarters` outlives it.
  BodyOdometer(const sim::Headquarters& headquarters, sim::RobotIndex robot, const sim::Pose& start,
               double drift);

  BodyMotion Next() override;
  void BeginTrip(sim::RandomStream& random) override;

 private:
  const sim::Headquarters& headquarters_;
  sim::RobotIndex robot_;
  sim::Pose last_;
  double drift_;
  double left_error_ = 0.0;   // share of the way
  double right_error_ = 0.0;  // share of the way
};

}  // namespace gauntlet::controllers
