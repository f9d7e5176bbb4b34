#include "analysis/figures/run/run_thumbnail.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/figures/arena_drawing.h"
#include "analysis/figures/figure_frame.h"
#include "analysis/figures/run/run_annotations.h"
#include "analysis/figures/run/run_panel.h"
#include "analysis/figures/run/run_tracks.h"
#include "analysis/figures/svg_canvas.h"
#include "sim/arena/arena.h"

namespace gauntlet::analysis {
namespace {

constexpr double kLeastThumbnailStep = 7.0;  // between points of a way, in pixels of the whole picture

constexpr std::string_view kStyle =
    R"(.floor { fill: #fdfcf9; }
.grid { stroke: none; }
.wall { fill: #3a424c; }
.obstacle { fill: #cbc4b6; stroke: #857c6c; stroke-width: 2; }
.obstacle-end, .obstacle-path { fill: none; stroke: #857c6c; stroke-width: 3; stroke-dasharray: 6 6; }
.goal, .food { fill: #e0a800; fill-opacity: 0.4; stroke: #e0a800; stroke-width: 4; }
.nest { fill: #8a94a0; fill-opacity: 0.4; stroke: #5b6470; stroke-width: 4; }
.way { fill: none; stroke-width: 3.5; stroke-opacity: 0.75; stroke-linejoin: round; }
)";

std::vector<Pixel> Thinned(const std::vector<Pixel>& points) {
  std::vector<Pixel> some;
  for (const Pixel& p : points) {
    if (some.empty() || std::hypot(p.x - some.back().x, p.y - some.back().y) >= kLeastThumbnailStep)
      some.push_back({std::round(p.x), std::round(p.y)});
  }
  return some;
}

void DrawTracks(SvgCanvas& canvas, const FigureFrame& frame, const std::vector<Track>& tracks) {
  for (const Track& track : tracks) {
    canvas.Polyline(Thinned(track.points), fmt::format("class=\"way\" stroke=\"{}\"", track.color));
  }
  for (const Track& track : tracks) {
    canvas.Circle(frame.At(track.end.position), 11, fmt::format("fill=\"{}\"", track.color));
  }
}

}  // namespace

std::string DrawThumbnail(const RunFigure& figure, double pixels) {
  const FigureFrame frame(figure.spec.test_case);
  const double scale = pixels / FigureFrame::kArenaPixels;
  SvgCanvas canvas(2 * frame.half_x() * frame.scale() * scale, 2 * frame.half_y() * frame.scale() * scale,
                   fmt::format("{}: {}", figure.run, DescribeOutcome(figure)), kStyle);
  canvas.OpenGroup(fmt::format("transform=\"scale({:.5f}) translate({} {})\"", scale, -FigureFrame::kLeft,
                               -FigureFrame::kTop));
  const sim::Arena arena(figure.spec.test_case);
  DrawFloor(canvas, frame, arena);
  for (const sim::Mark mark : {sim::Mark::kGoal, sim::Mark::kNest, sim::Mark::kFood}) {
    for (const sim::Annotation* place : MarkedAs(figure, mark)) {
      canvas.Circle(frame.At(place->points.front()), std::max(12.0, place->radius * frame.scale()),
                    fmt::format("class=\"{}\"", ClassOf(mark)));
    }
  }
  DrawObstacles(canvas, frame, arena);
  DrawTracks(canvas, frame, TracksOf(figure, frame));
  canvas.CloseGroup();
  return canvas.Take();
}

}  // namespace gauntlet::analysis
