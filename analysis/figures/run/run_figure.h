// The pictures of one run: a person sees at a glance where everybody went, who was lost, and where the swarm
// broke.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/run_result.h"
#include "sim/run_spec.h"
#include "sim/run_style.h"

namespace gauntlet::analysis {

struct RunFigure {
  std::string experiment;  // its name
  std::string run;         // how the run is called, e.g. "run 123"
  sim::RunSpec spec;       // what was simulated
  sim::RunResult result;   // with a trajectory; without one its waypoints are drawn
  std::vector<std::pair<std::string, std::string>> metrics;  // of the result, as the panel shows them
  sim::RunStyle style;  // what the scenario calls its robots and how its annotations are drawn
};

// The robot whose planned path the result shows: the one that its annotation names, or else the one that
// starts where the path begins; -1 when there is none.
int GuideOf(const RunFigure& figure);

// The run's outcome in words, e.g. "total failure: 6 of 10 birds lost".
std::string DescribeOutcome(const RunFigure& figure);

// A complete SVG document without scripts and outside references. Pure: same figure, same bytes.
// Annotations are drawn as the style says; besides, of robots that an annotation "trapped" names, the way
// from its tick on stands out.
std::string DrawRun(const RunFigure& figure);

// Whether the run says what its robots did, so that there is a time-line to draw.
bool HasTimeline(const RunFigure& figure);

// Its time-line, likewise: a row per robot, coloured by what it did, and how many robots did what. Rows of
// robots with an annotation "trapped" are marked from its tick on.
std::string DrawTimeline(const RunFigure& figure);

}  // namespace gauntlet::analysis
