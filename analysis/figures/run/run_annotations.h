// What the annotations of a run say: which are drawn how, and what every robot did when.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "analysis/figures/run/run_figure.h"

namespace gauntlet::analysis {

// Those with points that the style declares as `mark`, in the result's order.
std::vector<const sim::Annotation*> MarkedAs(const RunFigure& figure, sim::Mark mark);
// Those of one row of the style.
std::vector<const sim::Annotation*> MarkedBy(const RunFigure& figure, const sim::AnnotationStyle& style);
// Of these the one with the latest tick; nullptr when there is none.
const sim::Annotation* LatestMarkedAs(const RunFigure& figure, sim::Mark mark);

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

// Of the requirement that was violated first; nullptr: none was.
const sim::Annotation* FirstViolation(const sim::RunResult& result);

// From the annotations "states": one per robot, its label the names separated by commas, its points
// (second, state) wherever the state changed. Empty when the run has none; what does not make sense in them
// is left out.
RobotStates StatesOf(const sim::RunResult& result);

// "#rrggbb" for the state with that index: the palette of Okabe and Ito (2008), told apart by colour-blind
// readers.
std::string_view StateColor(int state);

}  // namespace gauntlet::analysis
