// Colours of ARGoS' interface as numbers, which is what our LEDs carry. Colours that our simulator has a name
// for keep their number; others get the next free one when they are first lit, so all robots of a run share a
// palette.
#pragma once

#include <vector>

#include "sim/arena/color.h"

#include <argos3/core/utility/datatypes/color.h>

namespace gauntlet::argos_form {

class Palette {
 public:
  Palette();

  // Opacity counts. Throws argos::CARGoSException at the 257th colour.
  sim::Color NumberOf(const argos::CColor& color);
  // Of a number that was given out.
  const argos::CColor& ColorOf(sim::Color number) const { return colors_[static_cast<std::size_t>(number)]; }

 private:
  std::vector<argos::CColor> colors_;
};

}  // namespace gauntlet::argos_form
