// Path planning by an artificial potential field (Khatib 1986; thesis 5.5.2.2): a goal that attracts and
// obstacles that repel. Pure functions in the robot's frame (x ahead, y left).
#pragma once

#include "controllers/common/proximity.h"
#include "controllers/common/steering.h"
#include "sim/geometry/vec2.h"

namespace gauntlet::controllers {

struct PotentialFieldSettings {
  double least_push = 0.0;  // a sum of readings shorter than this repels nobody
  bool analytic = false;    // Khatib's law instead of a unit vector
  double reach = 0.10;      // m, Khatib's d0: obstacles farther off do not repel
  double balance = 0.05;    // m, where the repulsion of Khatib's law equals the attraction, which is 1
};

// Away from what is near: a unit vector, or Khatib's eta * (1/d - 1/d0) / d^2 with d from the largest reading
// and eta such that its length is 1 at `balance`. Zero when nothing is near enough.
sim::Vec2 Repulsion(const ProximitySum& near, const PotentialFieldSettings& settings);

// The form of Buchanan's dps code: away from what is near, a unit vector; straight ahead when
// nothing is, or only something faint (a sum below 0.5) dead ahead (within 5 degrees).
sim::Vec2 Diffusion(const ProximitySum& near);

// Drives along unit(goal) + repulsion; turns left on the spot when the two cancel out.
DriveCommand FollowField(double goal_bearing, const sim::Vec2& repulsion, double speed,
                         const SteeringThresholds& steering);

}  // namespace gauntlet::controllers
