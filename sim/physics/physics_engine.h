// Physics behind an interface: wheel speeds in, poses out. One engine per run; nothing is shared between
// runs.
#pragma once

#include <memory>
#include <span>

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/vec2.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

struct WheelSpeeds {
  double left = 0.0;   // m/s
  double right = 0.0;  // m/s
};

class PhysicsEngine {
 public:
  virtual ~PhysicsEngine() = default;
  // Fixed bodies first, then robots in id order: the order is part of the result.
  virtual void AddBox(const OrientedBox& box) = 0;
  virtual RobotIndex AddRobot(const Pose& pose) = 0;
  // One tick of 0.1 s. `commands` has one entry per robot.
  virtual void Step(std::span<const WheelSpeeds> commands) = 0;
  virtual Pose PoseOf(RobotIndex robot) const = 0;
};

// Box2D 2.4 with the drive model of ARGoS' dynamics2d.
std::unique_ptr<PhysicsEngine> MakeBox2dEngine();

}  // namespace gauntlet::sim
