// Physics behind an interface: wheel speeds in, poses out. One engine per run; nothing is shared between
// runs.
#pragma once

#include <memory>
#include <span>

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/vec2.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

// Index of a movable or kinematic box, in the order in which both kinds were added.
using BoxIndex = int;

// What ARGoS' movable boxes have: friction against robots as a robot, and a ground that holds them back.
namespace movable_box {
inline constexpr double kMass = 1.0;           // kg, of the boxes measured in ARGoS
inline constexpr double kGroundForce = 1.49;   // N
inline constexpr double kGroundTorque = 1.49;  // N m
inline constexpr double kFriction = 0.7;       // contact friction; of a pair: the product
}  // namespace movable_box

// Steps of a solver in a tick; with one, crowded robots overlap by more than 10 mm.
inline constexpr int kStepsPerTick = 2;

// Furthest that a kinematic box goes in a tick (its centre, m; its heading, rad).
inline constexpr double kMaxBoxMove = 0.1;
inline constexpr double kMaxBoxTurn = 0.3;

class PhysicsEngine {
 public:
  virtual ~PhysicsEngine() = default;
  // Boxes first, then robots in id order: the order is part of the result.
  // A fixed box.
  virtual void AddBox(const OrientedBox& box) = 0;
  // A box that stands on the floor and can be pushed by robots. `mass` in kg, positive.
  virtual BoxIndex AddMovableBox(const OrientedBox& box, double mass) = 0;
  // A box that goes where MoveBox sends it, whatever stands in its way: robots and movable boxes are pushed.
  virtual BoxIndex AddKinematicBox(const OrientedBox& box) = 0;
  virtual RobotIndex AddRobot(const Pose& pose) = 0;
  // Where a kinematic box is when the next Step ends; it gets there at a constant speed and turn rate. At
  // most kMaxBoxMove and kMaxBoxTurn from where it is. Without a call before a Step the box rests.
  virtual void MoveBox(BoxIndex box, const Pose& end) = 0;
  // One tick of 0.1 s. `commands` has one entry per robot.
  virtual void Step(std::span<const WheelSpeeds> commands) = 0;
  virtual Pose PoseOf(RobotIndex robot) const = 0;
  // Of a movable or kinematic box. Valid until the next Step.
  virtual const OrientedBox& BoxAt(BoxIndex box) const = 0;
};

// Hand-written: contacts and drives as in ARGoS' dynamics2d, for robots among boxes that they cannot push;
// AddMovableBox is a broken invariant.
std::unique_ptr<PhysicsEngine> MakeImpulseEngine();
// Box2D 2.4 with the drive model of ARGoS' dynamics2d. Has boxes that robots push.
std::unique_ptr<PhysicsEngine> MakeBox2dEngine();
// Hand-written: the same drive, contacts by relaxation of positions, without friction; pushed boxes
// neither turn nor meet other boxes. An oracle in tests, and `--set physics=relaxation`.
std::unique_ptr<PhysicsEngine> MakeRelaxationEngine();

}  // namespace gauntlet::sim
