#include "analysis/figures/tuning_figure.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "analysis/figures/svg_canvas.h"

namespace gauntlet::analysis {
namespace {

// Pixels.
constexpr double kTop = 130.0;
constexpr double kRow = 22.0;
constexpr double kGap = 34.0;  // above each group, for its heading
constexpr double kLabels = 290.0;
constexpr double kScale = 520.0;
constexpr double kRemarks = 300.0;
constexpr double kMargin = 40.0;
constexpr double kBottom = 86.0;

constexpr std::string_view kStyle =
    R"(.same { fill: #5b6470; fill-opacity: 0.08; }
.middle { stroke: #5b6470; stroke-width: 1.2; }
.threshold { stroke: #9aa3ad; stroke-width: 1; stroke-dasharray: 3 3; }
.name { text-anchor: end; }
.value { font-size: 12px; fill: #5b6470; text-anchor: middle; }
.at-right { font-size: 12px; fill: #5b6470; text-anchor: end; }
.interval { stroke: #2b6cb0; stroke-width: 2; }
.point { fill: #2b6cb0; }
.interval-beyond { stroke: #d1410c; stroke-width: 2; }
.point-beyond { fill: #d1410c; }
.baseline { fill: #ffffff; stroke: #22272e; stroke-width: 1.6; }
.median { fill: none; stroke: #2b6cb0; stroke-width: 2; }
.largest { fill: none; stroke: #d1410c; stroke-width: 2; }
)";

struct Threshold {
  double a;
  std::string_view name;
};
constexpr std::array kThresholds = {Threshold{kVarghaDelaney2000.small, "small"},
                                    Threshold{kVarghaDelaney2000.medium, "medium"},
                                    Threshold{kVarghaDelaney2000.large, "large"}};

class RobustnessDrawing {
 public:
  explicit RobustnessDrawing(const RobustnessFigure& figure)
      : figure_(figure),
        bottom_(kTop + Height(figure)),
        canvas_(kMargin + kLabels + kScale + kRemarks, bottom_ + kBottom, figure.title, kStyle) {}

  std::string Draw() {
    canvas_.Text({kMargin, 38}, figure_.title, "class=\"title\"");
    canvas_.Text({kMargin, 64}, figure_.outcome, "class=\"axis\"");
    DrawThresholds();
    double y = kTop;
    for (const RobustnessGroup& group : figure_.groups) {
      canvas_.Text({kMargin, y + kGap - 10}, group.parameter, "font-weight=\"bold\"");
      y += kGap;
      for (const RobustnessPoint& point : group.points) {
        DrawPoint(point, y + kRow / 2);
        y += kRow;
      }
    }
    canvas_.Text({kMargin, bottom_ + 56},
                 "A = probability that a repeat of the baseline exceeds one with this value; ring: the "
                 "baseline's value; lines: 95 % intervals",
                 "class=\"axis\"");
    canvas_.Text({kMargin, bottom_ + 74},
                 "grey: no large difference (Vargha and Delaney: 0.56 small, 0.64 medium, 0.71 large)",
                 "class=\"axis\"");
    return canvas_.Take();
  }

 private:
  static double Height(const RobustnessFigure& figure) {
    double height = 10.0;
    for (const RobustnessGroup& group : figure.groups)
      height += kGap + kRow * static_cast<double>(group.points.size());
    return height;
  }
  static double X(double a) { return kMargin + kLabels + kScale * a; }

  void DrawThresholds() {
    const double large = kVarghaDelaney2000.large;
    canvas_.Rectangle({X(1.0 - large), kTop}, X(large) - X(1.0 - large), bottom_ - kTop, "class=\"same\"");
    for (const auto& [a, name] : kThresholds) {
      for (const double place : {1.0 - a, a}) {
        canvas_.Line({X(place), kTop}, {X(place), bottom_}, "class=\"threshold\"");
        canvas_.Text({X(place), bottom_ + 18}, fmt::format("{:.2f}", place), "class=\"value\"");
      }
    }
    canvas_.Line({X(0.5), kTop}, {X(0.5), bottom_}, "class=\"middle\"");
    for (const double end : {0.0, 0.5, 1.0})
      canvas_.Text({X(end), bottom_ + 18}, fmt::format("{}", end), "class=\"value\"");
    canvas_.Text({X(0.0), kTop - 12}, fmt::format("← {}", figure_.low), "class=\"axis\"");
    canvas_.Text({X(1.0), kTop - 12}, fmt::format("{} →", figure_.high), "class=\"at-right\"");
  }

  void DrawPoint(const RobustnessPoint& point, double y) {
    canvas_.Text({X(0.0) - 16, y + 4}, point.value, "class=\"name\"");
    canvas_.Text({X(1.0) + 16, y + 4}, point.remark, "class=\"axis\"");
    if (point.is_baseline) {
      canvas_.Circle({X(0.5), y}, 5, "class=\"baseline\"");
      return;
    }
    const std::string_view beyond = point.exceeds ? "-beyond" : "";
    if (point.interval) {
      canvas_.Line({X(point.interval->low), y}, {X(point.interval->high), y},
                   fmt::format("class=\"interval{}\"", beyond));
    }
    canvas_.Circle({X(point.a), y}, 5, fmt::format("class=\"point{}\"", beyond));
  }

  const RobustnessFigure& figure_;
  double bottom_;
  SvgCanvas canvas_;
};

class ConsistencyDrawing {
 public:
  explicit ConsistencyDrawing(const ConsistencyFigure& figure)
      : figure_(figure), canvas_(kLeft + kWidth + kLegend, kTop + kHeight + kBottom, figure.title, kStyle) {}

  std::string Draw() {
    canvas_.Text({kLeft - 60, 38}, figure_.title, "class=\"title\"");
    canvas_.Text({kLeft - 60, 64}, figure_.outcome, "class=\"axis\"");
    canvas_.Text({kLeft - 60, kTop - 14}, "A, normalised", "class=\"axis\"");
    canvas_.Rectangle({kLeft, Y(kVarghaDelaney2000.large)}, kWidth, Y(0.5) - Y(kVarghaDelaney2000.large),
                      "class=\"same\"");
    for (const auto& [a, name] : kThresholds) {
      canvas_.Line({kLeft, Y(a)}, {kLeft + kWidth, Y(a)}, "class=\"threshold\"");
      canvas_.Text({kLeft + kWidth + 8, Y(a) + 4}, name, "class=\"axis\"");
      canvas_.Text({kLeft - 8, Y(a) + 4}, fmt::format("{:.2f}", a), "class=\"at-right\"");
    }
    for (const double end : {0.5, 1.0}) {
      canvas_.Line({kLeft, Y(end)}, {kLeft + kWidth, Y(end)}, "class=\"rule\"");
      canvas_.Text({kLeft - 8, Y(end) + 4}, fmt::format("{:.2f}", end), "class=\"at-right\"");
    }
    DrawLine(&Consistency::median_a, "median");
    DrawLine(&Consistency::max_a, "largest");
    for (std::size_t i = 0; i < figure_.sizes.size(); ++i) {
      canvas_.Text({X(i), kTop + kHeight + 20}, fmt::format("{}", figure_.sizes[i].size), "class=\"value\"");
    }
    canvas_.Text({kLeft, kTop + kHeight + 46}, "repeats in each set", "class=\"axis\"");
    canvas_.Text({kLeft, kTop + kHeight + 66},
                 "A of the first set against each other one with the same parameters: "
                 "red the largest, blue the median",
                 "class=\"axis\"");
    return canvas_.Take();
  }

 private:
  static constexpr double kLeft = 100.0;
  static constexpr double kWidth = 640.0;
  static constexpr double kHeight = 360.0;
  static constexpr double kLegend = 100.0;

  static double Y(double a) { return kTop + kHeight * (1.0 - a) / 0.5; }
  double X(std::size_t i) const {
    return kLeft + kWidth * (static_cast<double>(i) + 0.5) / static_cast<double>(figure_.sizes.size());
  }
  void DrawLine(double Consistency::*what, std::string_view name) {
    std::vector<Pixel> points;
    for (std::size_t i = 0; i < figure_.sizes.size(); ++i)
      points.push_back({X(i), Y(figure_.sizes[i].*what)});
    const std::string style = fmt::format("class=\"{}\"", name);
    canvas_.Polyline(points, style);
    for (const Pixel& point : points) canvas_.Circle(point, 4, style);
  }

  const ConsistencyFigure& figure_;
  SvgCanvas canvas_;
};

}  // namespace

std::string DrawRobustness(const RobustnessFigure& figure) {
  return RobustnessDrawing(figure).Draw();
}

std::string DrawConsistency(const ConsistencyFigure& figure) {
  return ConsistencyDrawing(figure).Draw();
}

}  // namespace gauntlet::analysis
