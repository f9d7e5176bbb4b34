// What a robot shows and says to others, as in action during a tick.
#pragma once

#include <array>

#include "sim/robot/controller.h"

namespace gauntlet::sim {

struct Signals {
  Color beacon = Color::kBlack;
  std::array<Color, foot_bot::kRingLeds> ring{};
  Payload message{};
  bool silent = false;  // no message is sent: its radio is dead

  bool RingLit() const { return ring != std::array<Color, foot_bot::kRingLeds>{}; }
};

}  // namespace gauntlet::sim
