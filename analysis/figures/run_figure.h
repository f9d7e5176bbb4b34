// The picture of one run: a person sees at a glance where everybody went, who was lost, and where the swarm
// broke.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::analysis {

struct RunFigure {
  std::string experiment;                    // its name
  std::string run;                           // how the run is called, e.g. "run 123"
  sim::RunSpec spec;                         // what was simulated
  sim::RunResult result;                     // with a trajectory; without one its waypoints are drawn
  std::optional<sim::Rectangle> spawn_area;  // m; the test case's own area goes before it
  std::string member = "robot";              // what one of the swarm is called, singular
  int prey = -1;                             // the robot that the others follow, -1 = none
};

// The run's outcome in words, e.g. "total failure: 6 of 10 birds lost".
std::string DescribeOutcome(const RunFigure& figure);

// A complete SVG document without scripts and outside references. Pure: same figure, same bytes.
// Annotations drawn: "path" (dashed line), "disc" (goal), "split" (the latest is marked and labelled).
std::string DrawRun(const RunFigure& figure);

}  // namespace gauntlet::analysis
