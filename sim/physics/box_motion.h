// A kinematic box, and what is left of its path in a tick: what all engines know of it.
#pragma once

#include <cmath>

#include "base/check.h"
#include "sim/geometry/oriented_box.h"
#include "sim/geometry/trigonometry.h"
#include "sim/physics/physics_engine.h"

namespace gauntlet::sim {

struct BoxMotion {
  OrientedBox box;
  double heading = 0.0;      // rad in (-pi, pi]
  Vec2 move = Vec2::Zero();  // m, in what is left of this tick
  double turn = 0.0;         // rad, likewise

  explicit BoxMotion(const OrientedBox& place) : box(place), heading(AngleOf(place.axis)) {}

  // See PhysicsEngine::MoveBox.
  void SendTo(const Pose& end) {
    move = end.position - box.center;
    turn = WrapAngle(end.heading - heading);
    GAUNTLET_CHECK(move.squaredNorm() <= kMaxBoxMove * kMaxBoxMove * (1.0 + 1e-9) &&
                       std::abs(turn) <= kMaxBoxTurn * (1.0 + 1e-9),
                   "a kinematic box goes too far in a tick");
  }
  bool Goes() const { return move != Vec2::Zero() || turn != 0.0; }
  void Place(const Vec2& center, double new_heading) {
    heading = WrapAngle(new_heading);
    box.center = center;
    box.axis = UnitVector(heading);
  }
  // The first of the equal steps in which the rest of the way is gone, so that the end is exact to rounding.
  void Advance(std::size_t steps_left) {
    const double share = 1.0 / static_cast<double>(steps_left);
    const Vec2 step = share * move;
    const double step_turn = share * turn;
    Place(box.center + step, heading + step_turn);
    move -= step;
    turn -= step_turn;
  }
};

}  // namespace gauntlet::sim
