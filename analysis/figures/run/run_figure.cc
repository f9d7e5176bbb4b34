#include "analysis/figures/run/run_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "analysis/figures/arena_drawing.h"
#include "analysis/figures/figure_frame.h"
#include "analysis/figures/run/run_annotations.h"
#include "analysis/figures/run/run_panel.h"
#include "analysis/figures/run/run_tracks.h"
#include "analysis/figures/svg_canvas.h"
#include "base/number_text.h"
#include "sim/arena/arena.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::analysis {
namespace {

std::string RunStyleSheet() {
  return fmt::format(
      R"(.name {{ font-size: 12px; fill: {soft}; }}
.value {{ font-size: 12px; text-anchor: end; }}
{arena}.spawn {{ fill: {kept}; fill-opacity: 0.08; stroke: {kept}; stroke-opacity: 0.55; stroke-width: 1.2; stroke-dasharray: 2 3; }}
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
      fmt::arg("arena", ArenaStyleSheet()), fmt::arg("soft", kSoftInk), fmt::arg("kept", kKeptColor),
      fmt::arg("goal", kGoalColor), fmt::arg("plan", kPlanColor), fmt::arg("split", kSplitColor),
      fmt::arg("guide", kGuideColor), fmt::arg("beacon", kBeaconColor));
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
      if (position) DrawDiamond(canvas, frame.At(*position), 7.0, "beacon-before");
    }
  }
  for (const sim::Annotation* beacon : MarkedAs(figure, sim::Mark::kBeacon)) {
    DrawDiamond(canvas, frame.At(beacon->points.front()), 19.0, "beacon");
  }
}

constexpr double kCalloutHeight = 25.0;  // pixels

// "0-3, 5, 7-9".
std::string Ranges(std::vector<sim::RobotIndex> robots) {
  std::sort(robots.begin(), robots.end());
  std::string text;
  for (std::size_t begin = 0; begin < robots.size();) {
    std::size_t end = begin;
    while (end + 1 < robots.size() && robots[end + 1] == robots[end] + 1) ++end;
    if (!text.empty()) text += ", ";
    text += fmt::format("{}", robots[begin]);
    if (end > begin) text += fmt::format("{}{}", end == begin + 1 ? ", " : "-", robots[end]);
    begin = end + 1;
  }
  return text;
}

std::string SplitLabel(const RunFigure& figure, const sim::Annotation& split) {
  std::string text =
      split.tick >= 0 ? fmt::format("split at {:.0f} s", split.tick * sim::kTickSeconds) : "split";
  if (!split.robots.empty()) {
    text += fmt::format(": {} {} left the swarm", Plural(split.robots.size(), figure.style.member),
                        Ranges(split.robots));
  }
  return text;
}

// Where a box of that size, linked to `place`, hides the least: among positions around it, the one that
// covers the fewest points of trajectories and obstacles' numbers.
Pixel PlaceCallout(const FigureFrame& frame, Pixel place, double width, const std::vector<Track>& tracks,
                   const std::vector<Pixel>& keep_free) {
  Pixel best{FigureFrame::kLeft + 10, FigureFrame::kTop + 10};
  double least = std::numeric_limits<double>::infinity();
  for (const double reach : {48.0, 75.0, 110.0, 150.0, 200.0}) {
    for (int direction = 0; direction < 16; ++direction) {
      constexpr double kSixteenth = sim::kPi / 8;
      const sim::Vec2 unit = sim::UnitVector(direction * kSixteenth);
      const Pixel corner{place.x + unit.x() * (reach + width / 2) - width / 2,
                         place.y - unit.y() * (reach + kCalloutHeight / 2) - kCalloutHeight / 2};
      if (corner.x < FigureFrame::kLeft + 14 || corner.x + width > frame.right() - 14 ||
          corner.y < FigureFrame::kTop + 14 || corner.y + kCalloutHeight > frame.bottom() - 14) {
        continue;
      }
      const auto covers = [&](Pixel p) {
        return p.x > corner.x - 5 && p.x < corner.x + width + 5 && p.y > corner.y - 5 &&
               p.y < corner.y + kCalloutHeight + 5;
      };
      double cost = 0.15 * reach;
      for (const Track& track : tracks) {
        cost += static_cast<double>(std::count_if(track.points.begin(), track.points.end(), covers));
        if (covers(frame.At(track.end.position))) cost += 60;
      }
      cost += 40 * static_cast<double>(std::count_if(keep_free.begin(), keep_free.end(), covers));
      if (cost < least) {
        least = cost;
        best = corner;
      }
    }
  }
  return best;
}

// The place of a split: who left then, and a box of words where it hides the least.
class SplitCallout {
 public:
  // `split` has a point. `keep_free`: what the box should not hide beside the ways.
  SplitCallout(const RunFigure& figure, const sim::Annotation& split, const FigureFrame& frame,
               const std::vector<Track>& tracks, std::vector<Pixel> keep_free);

  // Below the robots, and what stands above them.
  void DrawPlace(SvgCanvas& canvas) const;
  void DrawRobotsAndLabel(SvgCanvas& canvas) const;

 private:
  Pixel place_;
  double radius_;  // pixels
  std::string label_;
  double width_;             // pixels, of the box
  Pixel corner_;             // of the box
  std::vector<Pixel> left_;  // where those who left were at that moment
};

SplitCallout::SplitCallout(const RunFigure& figure, const sim::Annotation& split, const FigureFrame& frame,
                           const std::vector<Track>& tracks, std::vector<Pixel> keep_free)
    : place_(frame.At(split.points.front())),
      radius_(std::max(14.0, 0.2 * frame.scale())),
      label_(SplitLabel(figure, split)),
      width_(6.7 * static_cast<double>(label_.size()) + 18) {
  for (const sim::RobotIndex robot : split.robots) {
    if (const auto position = PositionAt(figure, robot, split.tick)) left_.push_back(frame.At(*position));
  }
  for (const Track& track : tracks) keep_free.push_back(frame.At(track.start.position));
  corner_ = PlaceCallout(frame, place_, width_, tracks, keep_free);
}

void SplitCallout::DrawPlace(SvgCanvas& canvas) const {
  canvas.Circle(place_, radius_, "class=\"split\" id=\"split\"");
  const Pixel anchor{std::clamp(place_.x, corner_.x, corner_.x + width_),
                     std::clamp(place_.y, corner_.y, corner_.y + kCalloutHeight)};
  const double distance = std::hypot(anchor.x - place_.x, anchor.y - place_.y);
  if (distance <= radius_) return;
  const double share = radius_ / distance;
  const Pixel edge{place_.x + share * (anchor.x - place_.x), place_.y + share * (anchor.y - place_.y)};
  canvas.Line(edge, anchor, "class=\"callout-line\"");
}

void SplitCallout::DrawRobotsAndLabel(SvgCanvas& canvas) const {
  for (const Pixel& p : left_) DrawDiamond(canvas, p, 6.0, "split-robot");
  canvas.Rectangle(corner_, width_, kCalloutHeight, "class=\"callout\" rx=\"5\"");
  canvas.Text({corner_.x + 9, corner_.y + 17}, label_, "class=\"callout-text\"");
}

}  // namespace

std::string DrawRun(const RunFigure& figure) {
  const FigureFrame frame(figure.spec.test_case);
  const sim::Arena arena(figure.spec.test_case);
  const std::vector<Track> tracks = TracksOf(figure, frame);

  SvgCanvas canvas(frame.page_width(), frame.page_height(),
                   fmt::format("{}, {}: {}", figure.experiment, figure.run, DescribeOutcome(figure)),
                   RunStyleSheet());
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
  std::vector<Pixel> numbers = DrawObstacleNumbers(canvas, frame, arena);
  std::optional<SplitCallout> split;
  if (const sim::Annotation* last = LatestMarkedAs(figure, sim::Mark::kSplit)) {
    split.emplace(figure, *last, frame, tracks, std::move(numbers));
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
