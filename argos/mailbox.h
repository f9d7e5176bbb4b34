// What the robots of a run say to one another by more bytes than a simulated message carries: the bytes stay
// here, and the message says where.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/robot/controller.h"

namespace gauntlet::argos_form {

class Mailbox {
 public:
  // Keeps the bytes until the robot has put others twice: who hears the message in the next tick may read it
  // after the robot has put those of that tick. What to send for them.
  sim::Payload Put(sim::RobotIndex robot, std::span<const std::uint8_t> bytes);

  // The bytes behind a message; empty for one that does not come from here, such as a scenario's own.
  std::span<const std::uint8_t> Get(const sim::Payload& message) const;

 private:
  struct Box {
    std::vector<std::uint8_t> slots[2];
    std::uint8_t newest = 0;
  };
  std::vector<Box> boxes_;  // by robot
};

}  // namespace gauntlet::argos_form
