// Physics behind an interface: wheel speeds in, poses out. One engine per run; nothing is shared between
// runs.
#pragma once

#include <memory>
#include <span>

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/vec2.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

// Index of a kinematic box, in the order in which they were added.
using BoxIndex = int;

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
  // A box that goes where MoveBox sends it, whatever stands in its way: robots are pushed.
  virtual BoxIndex AddKinematicBox(const OrientedBox& box) = 0;
  virtual RobotIndex AddRobot(const Pose& pose) = 0;
  // Where a kinematic box is when the next Step ends; it gets there at a constant speed and turn rate. At
  // most kMaxBoxMove and kMaxBoxTurn from where it is. Without a call before a Step the box rests.
  virtual void MoveBox(BoxIndex box, const Pose& end) = 0;
  // One tick of 0.1 s. `commands` has one entry per robot.
  virtual void Step(std::span<const WheelSpeeds> commands) = 0;
  virtual Pose PoseOf(RobotIndex robot) const = 0;
  // Of a kinematic box. Valid until the next Step.
  virtual const OrientedBox& BoxAt(BoxIndex box) const = 0;
};

// Hand-written: contacts and drives as in ARGoS' dynamics2d.
std::unique_ptr<PhysicsEngine> MakeImpulseEngine();
// Box2D 2.4 with the drive model of ARGoS' dynamics2d.
std::unique_ptr<PhysicsEngine> MakeBox2dEngine();
// Hand-written: the same drive, contacts by relaxation of positions, without friction. An oracle in tests;
// `physics = "relaxation"` is taken without being named to users.
std::unique_ptr<PhysicsEngine> MakeRelaxationEngine();

}  // namespace gauntlet::sim
