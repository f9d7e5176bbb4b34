#include "analysis/figures/run_figure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "analysis/figures/annotation_marks.h"
#include "analysis/figures/arena_drawing.h"
#include "analysis/figures/figure_frame.h"
#include "analysis/figures/robot_states.h"
#include "analysis/figures/run_panel.h"
#include "analysis/figures/run_tracks.h"
#include "analysis/figures/split_callout.h"
#include "analysis/figures/svg_canvas.h"
#include "sim/arena/arena.h"

namespace gauntlet::analysis {
namespace {

std::string StyleSheet() {
  return fmt::format(
      R"(.name {{ font-size: 12px; fill: {soft}; }}
.value {{ font-size: 12px; text-anchor: end; }}
.floor {{ fill: #fdfcf9; }}
.grid {{ stroke: #ebe7dd; stroke-width: 1; }}
.wall {{ fill: #3a424c; }}
.obstacle {{ fill: #cbc4b6; stroke: #857c6c; stroke-width: 1.2; stroke-linejoin: round; }}
.obstacle-end {{ fill: none; stroke: #857c6c; stroke-width: 1.2; stroke-dasharray: 3 3; }}
.obstacle-path {{ fill: none; stroke: #857c6c; stroke-width: 1.6; stroke-dasharray: 1 4; stroke-linecap: round; }}
.lamp {{ stroke: #ffffff; stroke-width: 1; }}
.obstacle-number {{ font-size: 13px; font-weight: bold; fill: #4d463a; text-anchor: middle; stroke: #efebe3; stroke-width: 3; paint-order: stroke; }}
.spawn {{ fill: {kept}; fill-opacity: 0.08; stroke: {kept}; stroke-opacity: 0.55; stroke-width: 1.2; stroke-dasharray: 2 3; }}
.goal {{ fill: {goal}; fill-opacity: 0.35; stroke: {goal}; stroke-width: 2.4; }}
.nest {{ fill: #8a94a0; fill-opacity: 0.4; stroke: {soft}; stroke-width: 2; }}
.food {{ fill: {guide}; fill-opacity: 0.3; stroke: {guide}; stroke-width: 2.4; }}
.beacon {{ fill: {beacon}; fill-opacity: 0.6; stroke: #ffffff; stroke-width: 1; }}
.beacon-before {{ fill: none; stroke: {beacon}; stroke-width: 1.3; stroke-opacity: 0.75; }}
.transfer {{ fill: #ffffff; fill-opacity: 0.85; stroke: {beacon}; stroke-width: 2.2; }}
.chain {{ fill: none; stroke: {beacon}; stroke-width: 2; stroke-dasharray: 7 5; }}
.place {{ font-size: 12px; font-weight: bold; fill: #7a5c00; text-anchor: middle; stroke: #fdfcf9; stroke-width: 3; paint-order: stroke; }}
.plan {{ fill: none; stroke: {plan}; stroke-width: 1.7; stroke-dasharray: 7 5; }}
.way {{ fill: none; stroke-linejoin: round; }}
.arrow {{ stroke: #fdfcf9; stroke-width: 0.8; }}
.start {{ fill: #ffffff; stroke-width: 1.5; }}
.robot {{ stroke: #ffffff; stroke-width: 1.4; }}
.nose {{ stroke-width: 2.6; stroke-linecap: round; }}
.ring {{ fill-opacity: 0.18; stroke-width: 1.6; stroke-opacity: 0.85; }}
.number {{ font-size: 9.5px; font-weight: bold; fill: #ffffff; text-anchor: middle; }}
.split {{ fill: {split}; fill-opacity: 0.12; stroke: {split}; stroke-width: 2.2; stroke-dasharray: 4 3; }}
.split-robot {{ fill: {split}; stroke: #ffffff; stroke-width: 1.2; }}
.callout {{ fill: #ffffff; fill-opacity: 0.93; stroke: {split}; stroke-width: 1.4; }}
.callout-line {{ stroke: {split}; stroke-width: 1.4; }}
.callout-text {{ font-size: 12.5px; font-weight: bold; fill: {split}; }}
)",
      fmt::arg("soft", kSoftInk), fmt::arg("kept", kKeptColor), fmt::arg("goal", kGoalColor),
      fmt::arg("plan", kPlanColor), fmt::arg("split", kSplitColor), fmt::arg("guide", kGuideColor),
      fmt::arg("beacon", kBeaconColor));
}

void DrawPlaces(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame) {
  for (const sim::Annotation* area : MarkedAs(figure, sim::Mark::kArea)) {
    canvas.Polygon(frame.At(area->points), "class=\"spawn\"");
  }
  for (const sim::Mark mark : {sim::Mark::kGoal, sim::Mark::kNest, sim::Mark::kFood}) {
    for (const sim::Annotation* place : MarkedAs(figure, mark)) {
      const Pixel center = frame.At(place->points.front());
      const double radius = std::max(5.0, place->radius * frame.scale());
      canvas.Circle(center, radius, fmt::format("class=\"{}\"", ClassOf(mark)));
      canvas.Text({center.x, center.y + radius + 15}, place->label, "class=\"place\"");
    }
  }
}

void DrawLines(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame) {
  for (const sim::Mark mark : {sim::Mark::kPlan, sim::Mark::kChain}) {
    for (const sim::Annotation* line : MarkedAs(figure, mark)) {
      if (line->points.size() < 2) continue;
      canvas.Polyline(frame.At(line->points), fmt::format("class=\"{}\"", ClassOf(mark)));
    }
  }
}

// Around the robots that end as beacons; hollow where robots had stood as one before.
void DrawBeacons(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame) {
  const RobotStates states = StatesOf(figure.result);
  const double end = figure.result.ticks * sim::kTickSeconds;
  for (const sim::AnnotationStyle& style : figure.style.annotations) {
    if (style.mark != sim::Mark::kFormerBeacon) continue;
    for (const StateSpell& spell : states.spells) {
      if (states.names[static_cast<std::size_t>(spell.state)] != style.label || spell.end >= end) continue;
      const auto tick = static_cast<sim::Tick>(std::lround(spell.begin * sim::kTicksPerSecond));
      const auto position = PositionAt(figure, spell.robot, tick);
      if (position) DrawBeacon(canvas, frame.At(*position), 7.0, false);
    }
  }
  for (const sim::Annotation* beacon : MarkedAs(figure, sim::Mark::kBeacon)) {
    DrawBeacon(canvas, frame.At(beacon->points.front()), 19.0, true);
  }
}

}  // namespace

std::string DrawRun(const RunFigure& figure) {
  const FigureFrame frame(figure.spec.test_case);
  const sim::Arena arena(figure.spec.test_case);
  const std::vector<Track> tracks = TracksOf(figure, frame);

  SvgCanvas canvas(frame.page_width(), frame.page_height(),
                   fmt::format("{}, {}: {}", figure.experiment, figure.run, DescribeOutcome(figure)),
                   StyleSheet());
  DrawFloor(canvas, frame, arena);
  DrawPlaces(canvas, figure, frame);
  DrawObstacles(canvas, frame, arena);
  for (const TrackKind kind : {TrackKind::kKept, TrackKind::kLost, TrackKind::kGuide}) {
    for (const Track& track : tracks) {
      if (track.kind == kind) DrawWay(canvas, track);
    }
  }
  DrawLines(canvas, figure, frame);
  DrawBeacons(canvas, figure, frame);
  for (const sim::Annotation* transfer : MarkedAs(figure, sim::Mark::kTransfer)) {
    DrawTransfer(canvas, frame.At(transfer->points.front()));
  }
  DrawObstacleNumbers(canvas, frame, arena);
  std::optional<SplitCallout> split;
  if (const sim::Annotation* last = LatestMarkedAs(figure, sim::Mark::kSplit)) {
    split.emplace(figure, *last, frame, tracks, ObstacleCenters(frame, arena));
    split->DrawPlace(canvas);
  }
  for (const Track& track : tracks) DrawStart(canvas, frame, track);
  DrawEnds(canvas, frame, tracks, figure.style.guide);
  if (split) split->DrawRobotsAndLabel(canvas);
  DrawAxes(canvas, frame);
  DrawTitle(canvas, figure, FigureFrame::kLeft, frame.page_width() - 22);
  DrawPanel(canvas, figure, frame, tracks);
  return canvas.Take();
}

}  // namespace gauntlet::analysis
