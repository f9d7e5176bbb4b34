// How a swarm moved as a whole, over the time of a run.
#pragma once

#include "analysis/figures/line_figure.h"
#include "analysis/figures/run/run_figure.h"

namespace gauntlet::analysis {

// Of the robots under test (the guide is left out), about two hundred moments: their mean distance from their
// middle (m), the agreement of their headings (0 = none, 1 = all the same way), their mean speed (m/s).
// Without a trajectory the panels are empty.
LineFigure SwarmMotion(const RunFigure& figure);

}  // namespace gauntlet::analysis
