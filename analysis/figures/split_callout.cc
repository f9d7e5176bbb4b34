#include "analysis/figures/split_callout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::analysis {
namespace {

constexpr double kHeight = 25.0;  // pixels

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
    text += fmt::format(": {}{} {} left the swarm", figure.style.member, split.robots.size() == 1 ? "" : "s",
                        Ranges(split.robots));
  }
  return text;
}

// Where a box of that size, linked to `place`, hides the least: among positions around it, the one that
// covers the fewest points of ways and obstacles' numbers.
Pixel PlaceCallout(const FigureFrame& frame, Pixel place, double width, const std::vector<Track>& tracks,
                   const std::vector<Pixel>& keep_free) {
  Pixel best{FigureFrame::kLeft + 10, FigureFrame::kTop + 10};
  double least = std::numeric_limits<double>::infinity();
  for (const double reach : {48.0, 75.0, 110.0, 150.0, 200.0}) {
    for (int direction = 0; direction < 16; ++direction) {
      constexpr double kSixteenth = sim::kPi / 8;
      const sim::Vec2 unit = sim::UnitVector(direction * kSixteenth);
      const Pixel corner{place.x + unit.x() * (reach + width / 2) - width / 2,
                         place.y - unit.y() * (reach + kHeight / 2) - kHeight / 2};
      if (corner.x < FigureFrame::kLeft + 14 || corner.x + width > frame.right() - 14 ||
          corner.y < FigureFrame::kTop + 14 || corner.y + kHeight > frame.bottom() - 14) {
        continue;
      }
      const auto covers = [&](Pixel p) {
        return p.x > corner.x - 5 && p.x < corner.x + width + 5 && p.y > corner.y - 5 &&
               p.y < corner.y + kHeight + 5;
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

}  // namespace

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
                     std::clamp(place_.y, corner_.y, corner_.y + kHeight)};
  const double distance = std::hypot(anchor.x - place_.x, anchor.y - place_.y);
  if (distance <= radius_) return;
  const double share = radius_ / distance;
  const Pixel edge{place_.x + share * (anchor.x - place_.x), place_.y + share * (anchor.y - place_.y)};
  canvas.Line(edge, anchor, "class=\"callout-line\"");
}

void SplitCallout::DrawRobotsAndLabel(SvgCanvas& canvas) const {
  for (const Pixel& p : left_) DrawSplitRobot(canvas, p, 6.0);
  canvas.Rectangle(corner_, width_, kHeight, "class=\"callout\" rx=\"5\"");
  canvas.Text({corner_.x + 9, corner_.y + 17}, label_, "class=\"callout-text\"");
}

}  // namespace gauntlet::analysis
