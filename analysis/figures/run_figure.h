// The picture of one run: a person sees at a glance where everybody went, who was lost, and where the swarm
// broke.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::analysis {

struct RunFigure {
  std::string experiment;  // its name
  std::string run;         // how the run is called, e.g. "run 123"
  sim::RunSpec spec;       // what was simulated
  sim::RunResult result;   // with a trajectory; without one its waypoints are drawn
  std::vector<std::pair<std::string, std::string>> metrics;  // of the result, as the panel shows them
  std::string member = "robot";                              // what one of the swarm is called, singular
  bool lost_is_failure = true;  // total failure means that too many were lost, not something of its own
  std::string lost = "lost";    // what RobotSummary::lost means, in a word
};

// The robot whose planned path the result shows: the one that the annotation "path" names, or else the one
// that starts where the path begins; -1 when there is none.
int PreyOf(const sim::RunResult& result);

// The run's outcome in words, e.g. "total failure: 6 of 10 birds lost".
std::string DescribeOutcome(const RunFigure& figure);

// A complete SVG document without scripts and outside references. Pure: same figure, same bytes.
// Annotations drawn: "area" (where the swarm starts), "path" and "chain" (dashed lines), "disc" (a place, by
// its label), "split" (the latest is marked and labelled), "trapped" (the robot's way from that tick on
// stands out), "states" (where robots stood as a beacon), "transfer" (where an item changed hands).
std::string DrawRun(const RunFigure& figure);

}  // namespace gauntlet::analysis
