// Where the arena lies on the page, and the colours of a run's picture.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "analysis/figures/svg_canvas.h"
#include "sim/arena/test_case.h"
#include "sim/geometry/vec2.h"

namespace gauntlet::analysis {

// Metres (x right, y up) to pixels (y down).
class FigureFrame {
 public:
  static constexpr double kArenaPixels = 690.0;  // the longer side, walls included
  static constexpr double kLeft = 72.0;          // left of the walls: labels of the y axis
  static constexpr double kTop = 96.0;           // above the walls: title
  static constexpr double kBottom = 78.0;        // below the walls: x axis and scale
  static constexpr double kPanel = 300.0;        // right of the walls: legend and figures
  static constexpr double kLeastHeight = 790.0;  // so that the legend fits beside a flat arena

  explicit FigureFrame(const sim::TestCase& test_case)
      : center_(test_case.center),
        half_x_((test_case.side_x + test_case.wall_thickness) / 2),
        half_y_((test_case.side_y + test_case.wall_thickness) / 2),
        scale_(kArenaPixels / (2 * std::max(half_x_, half_y_))) {}

  double scale() const { return scale_; }    // pixels per metre
  double half_x() const { return half_x_; }  // m, to the walls' outer faces
  double half_y() const { return half_y_; }
  // The corners of the walls' outer faces, m.
  sim::Vec2 min() const { return center_ - sim::Vec2(half_x_, half_y_); }
  sim::Vec2 max() const { return center_ + sim::Vec2(half_x_, half_y_); }
  double right() const { return kLeft + 2 * half_x_ * scale_; }  // pixels
  double bottom() const { return kTop + 2 * half_y_ * scale_; }
  double page_width() const { return right() + kPanel; }
  double page_height() const { return std::max(bottom() + kBottom, kLeastHeight); }

  Pixel At(const sim::Vec2& p) const {
    const sim::Vec2 place = p - center_;
    return {kLeft + (place.x() + half_x_) * scale_, kTop + (half_y_ - place.y()) * scale_};
  }

  std::vector<Pixel> At(const std::vector<sim::Vec2>& points) const {
    std::vector<Pixel> pixels;
    for (const sim::Vec2& point : points) pixels.push_back(At(point));
    return pixels;
  }

 private:
  sim::Vec2 center_;  // m, of the arena
  double half_x_;
  double half_y_;
  double scale_;
};

// Blue for those who stayed, vermilion for the lost, green for the guide: told apart by colour-blind readers
// (Okabe and Ito 2008).
inline constexpr std::string_view kInk = "#22272e";
inline constexpr std::string_view kSoftInk = "#5b6470";
inline constexpr std::string_view kKeptColor = "#2b6cb0";
inline constexpr std::string_view kLostColor = "#d1410c";
inline constexpr std::string_view kGuideColor = "#00856a";
inline constexpr std::string_view kPlanColor = "#4a5560";
inline constexpr std::string_view kGoalColor = "#e0a800";
inline constexpr std::string_view kSplitColor = "#7b1fa2";
inline constexpr std::string_view kBeaconColor = "#b565c4";

}  // namespace gauntlet::analysis
