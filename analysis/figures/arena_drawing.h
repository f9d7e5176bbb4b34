// The arena of a run's picture, in the order in which it is drawn.
#pragma once

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/svg_canvas.h"
#include "sim/arena/arena.h"

namespace gauntlet::analysis {

void DrawFloor(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena);
// With the ways of those that move, the lamps of those that are lit, and the walls.
void DrawObstacles(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena);
// Returns where they stand.
std::vector<Pixel> DrawObstacleNumbers(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena);
// Ticks in m along the walls, and a scale.
void DrawAxes(SvgCanvas& canvas, const FigureFrame& frame);

}  // namespace gauntlet::analysis
