// A run at a glance, small enough to stand beside many others.
#pragma once

#include <string>

#include "analysis/figures/run/run_figure.h"

namespace gauntlet::analysis {

// An SVG document without words: the arena, every robot's trajectory and end, goal, nest and food. `pixels`:
// of its longer side.
std::string DrawThumbnail(const RunFigure& figure, double pixels);

}  // namespace gauntlet::analysis
