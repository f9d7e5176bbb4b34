// What stands beside and above the arena in a run's picture: title, legend, figures of the run.
#pragma once

#include <string_view>
#include <vector>

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/run/run_figure.h"
#include "analysis/figures/run/run_tracks.h"
#include "analysis/figures/svg_canvas.h"

namespace gauntlet::analysis {

// How lines and places are styled: "plan", "chain", "nest", "food", and "goal" of every other mark.
std::string_view ClassOf(sim::Mark mark);

// Between `left` and `right`, in pixels.
void DrawTitle(SvgCanvas& canvas, const RunFigure& figure, double left, double right);
void DrawPanel(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame,
               const std::vector<Track>& tracks);

}  // namespace gauntlet::analysis
