// The arena of a run's picture, in the order in which it is drawn.
#pragma once

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/svg_canvas.h"
#include "sim/arena/arena.h"

namespace gauntlet::analysis {

// Of what the functions below draw.
std::string_view ArenaStyleSheet();

void DrawFloor(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena);
// With the paths of those that move, the lamps of those that are lit, and the walls.
void DrawObstacles(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena);
// Returns where they stand. `kept`: which of a larger arena's obstacles these are, from 0; empty = all.
std::vector<Pixel> DrawObstacleNumbers(SvgCanvas& canvas, const FigureFrame& frame, const sim::Arena& arena,
                                       const std::vector<std::size_t>& kept = {});
// Ticks in m along the walls, and a scale.
void DrawAxes(SvgCanvas& canvas, const FigureFrame& frame);

}  // namespace gauntlet::analysis
