// The time-line of one run: a row per robot, coloured by what it did, and how many robots did what.
#pragma once

#include <string>

#include "analysis/figures/run_figure.h"

namespace gauntlet::analysis {

// Whether the run says what its robots did, so that there is a time-line to draw.
bool HasTimeline(const RunFigure& figure);

// A complete SVG document without scripts and outside references. Pure: same figure, same bytes. Rows of
// robots with an annotation "trapped" are marked from its tick on.
std::string DrawTimeline(const RunFigure& figure);

}  // namespace gauntlet::analysis
