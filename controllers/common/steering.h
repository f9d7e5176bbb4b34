// From a desired bearing to a wheel command. Pure functions; bearings in rad from the heading, in (-pi, pi].
#pragma once

#include "sim/geometry/vec2.h"

namespace gauntlet::controllers {

// What Actuators::Drive takes.
struct DriveCommand {
  double forward = 0.0;  // m/s
  double turn = 0.0;     // rad/s, counter-clockwise
};

// ARGoS' wheel turning parameters: below `straight` drive on, beyond `hard` rotate on the spot.
struct SteeringThresholds {
  double straight = 0.0;   // rad
  double hard = 0.0;       // rad, > straight
  double turn_rate = 0.0;  // rad/s on the spot; 0 = 2 * speed / wheel distance, one wheel each way at `speed`
};

// The common steering primitive: straight at `speed`, an arc that is slower and tighter the
// larger the bearing, or a turn on the spot at the turn rate. Never turns past the bearing
// within one tick while it drives an arc.
DriveCommand Steer(double bearing, double speed, const SteeringThresholds& thresholds);

// The three reactions of Moeslinger et al. 2011 (thesis 4.7.1): straight, turn left, turn right.
struct Reactions {
  double speed = 0.0;                 // m/s, straight on
  double turn_rate = 0.0;             // rad/s, while turning
  double straight_within = 0.0;       // rad, a smaller bearing means straight on
  double turning_speed_factor = 0.0;  // forward speed while turning, relative to `speed`
};

// Straight on, or a turn towards the bearing, without forward motion when the bearing lies behind
// (beyond 90 degrees).
DriveCommand React(double bearing, const Reactions& reactions);
// The same towards `direction` (any length, in the robot's frame) without working out its bearing;
// `straight_edge` = UnitVector(reactions.straight_within).
DriveCommand React(const sim::Vec2& direction, const sim::Vec2& straight_edge, const Reactions& reactions);

// Follows a waypoint: turns at up to `max_turn_rate` towards the bearing and drives once the bearing is
// within `drive_within`.
DriveCommand TurnThenDrive(double bearing, double speed, double max_turn_rate, double drive_within);

}  // namespace gauntlet::controllers
