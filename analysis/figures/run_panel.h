// What stands beside and above the arena in a run's picture: title, legend, figures of the run.
#pragma once

#include <string_view>
#include <vector>

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/run_figure.h"
#include "analysis/figures/run_tracks.h"
#include "analysis/figures/svg_canvas.h"

namespace gauntlet::analysis {

// The annotation of that kind with the latest tick; nullptr when there is none.
const sim::Annotation* LatestAnnotation(const RunFigure& figure, std::string_view kind);

// The style of a place by its label: "nest", "food", and "goal" for all others.
std::string_view PlaceClass(const sim::Annotation& disc);
// A square on its corner, full where a beacon stands, hollow where one stood; `half` its diagonal, in pixels.
void DrawBeacon(SvgCanvas& canvas, Pixel center, double half, bool stands);
// The mark of a hand-over between two robots, also used by the legend.
void DrawTransfer(SvgCanvas& canvas, Pixel center);

void DrawTitle(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame);
void DrawPanel(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame,
               const std::vector<Track>& tracks);

}  // namespace gauntlet::analysis
