// Where a robot believes the source of its last item to be: thesis 3.3.2 has no odometry errors; Pini et al.
// 2014 and Buchanan et al. 2016 do.
#pragma once

#include "controllers/common/odometer.h"
#include "sim/geometry/vec2.h"
#include "sim/random/random_stream.h"

namespace gauntlet::controllers {

// In the robot's frame, m. With a `drift` the estimate moves to the left of the line from nest to source
// while the robot travels, as in the program that Buchanan et al. 2016 published (github edgarbuchanan/dps,
// read for its formulas): one wheel is measured too long by a share that is drawn per trip from a Rayleigh
// distribution with this scale (0.0027 there and in Pini et al. 2014), which bends a straight way w into an
// arc of curvature share / wheel distance; the estimate is off by twice the gap between the ends of the arc
// and of the way, and w counts 1 cm where the robot drives 0.8: about 1.6 w^2 share / wheel distance. 0 =
// exact. Not for sharing between threads.
class SourceEstimate {
 public:
  explicit SourceEstimate(double drift) : drift_(drift) {}

  // The robot got an item where it stands, the nest at `nest_bearing`, rad: a new trip, and with it a new
  // error.
  void Begin(double nest_bearing, sim::RandomStream& random);
  // What the body did. `travelling`: to the nest or back to the source; errors grow on no other way.
  void Move(const BodyMotion& motion, bool travelling);

  const sim::Vec2& value() const { return value_; }

 private:
  sim::Vec2 Error() const;

  double drift_;
  double share_ = 0.0;                        // of this trip
  double way_ = 0.0;                          // m travelled on this trip
  sim::Vec2 exact_ = sim::Vec2::Zero();       // m
  sim::Vec2 from_nest_ = sim::Vec2::UnitX();  // direction from the nest to the source
  sim::Vec2 value_ = sim::Vec2::Zero();       // m
};

}  // namespace gauntlet::controllers
