// The robots' grippers, and which of them holds an item. An item is a token: it has no body. Where items come
// from and where they go is the scenario's business, which moves them between physics and sensing.
#pragma once

#include <vector>

#include "base/check.h"
#include "sim/robot/devices.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

class Grippers {
 public:
  // equipped[i]: robot i has a gripper.
  explicit Grippers(const std::vector<bool>& equipped) : hands_(equipped.size()) {
    for (std::size_t i = 0; i < equipped.size(); ++i) hands_[i].equipped = equipped[i];
  }

  // Commanded closed, as of the last tick's control; false without a gripper.
  bool Closed(RobotIndex robot) const { return At(robot).closed; }
  bool Holds(RobotIndex robot) const { return At(robot).holds; }
  // Puts an item into an empty gripper, closed or not; the robot must have one.
  void Give(RobotIndex robot) {
    GAUNTLET_CHECK(At(robot).equipped && !At(robot).holds, "an item needs an empty gripper");
    hands_[static_cast<std::size_t>(robot)].holds = true;
  }
  // Takes away the item that the gripper holds.
  void Take(RobotIndex robot) {
    GAUNTLET_CHECK(At(robot).holds, "no item to take");
    hands_[static_cast<std::size_t>(robot)].holds = false;
  }
  // The item of `from` goes over to the empty gripper of `to`.
  void HandOver(RobotIndex from, RobotIndex to) {
    Take(from);
    Give(to);
  }

  // For the simulation loop.
  void SetClosed(RobotIndex robot, bool closed) {
    hands_[static_cast<std::size_t>(robot)].closed = closed && At(robot).equipped;
  }

 private:
  struct Hand {
    bool equipped = false;
    bool closed = false;
    bool holds = false;
  };
  const Hand& At(RobotIndex robot) const { return hands_[static_cast<std::size_t>(robot)]; }

  std::vector<Hand> hands_;
};

}  // namespace gauntlet::sim
