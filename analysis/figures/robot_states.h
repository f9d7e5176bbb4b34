// What every robot did when, as scenarios with states annotate it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/run_result.h"

namespace gauntlet::analysis {

// One robot in one state.
struct StateSpell {
  int robot = 0;
  int state = 0;       // index into RobotStates::names
  double begin = 0.0;  // s
  double end = 0.0;    // s
};

struct RobotStates {
  std::vector<std::string> names;
  std::vector<StateSpell> spells;  // by robot, then by time; without gaps from the first one on
  int robots = 0;                  // one more than the highest number with a spell

  bool empty() const { return spells.empty(); }
};

// From the annotations "states": one per robot, its label the names separated by commas, its points
// (second, state) wherever the state changed. Empty when the run has none; what does not make sense in them
// is left out.
RobotStates StatesOf(const sim::RunResult& result);

// "#rrggbb" for the state with that index: the palette of Okabe and Ito (2008), told apart by colour-blind
// readers.
std::string_view StateColor(int state);

}  // namespace gauntlet::analysis
