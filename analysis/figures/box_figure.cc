#include "analysis/figures/box_figure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/svg_canvas.h"
#include "analysis/figures/value_axis.h"
#include "base/number_text.h"

namespace gauntlet::analysis {
namespace {

// Pixels.
constexpr double kLeft = 92.0;
constexpr double kTop = 96.0;
constexpr double kHeight = 420.0;
constexpr double kColumn = 260.0;
constexpr double kBox = 90.0;
constexpr double kBottom = 110.0;
constexpr std::size_t kMostCharacters = 36;  // of a name below its box

constexpr std::string_view kStyle =
    R"(.box { fill: #2b6cb0; fill-opacity: 0.18; stroke: #2b6cb0; stroke-width: 1.6; }
.median { stroke: #22272e; stroke-width: 2.4; }
.whisker { stroke: #2b6cb0; stroke-width: 1.6; }
.outlier { fill: none; stroke: #d1410c; stroke-width: 1.2; }
.mean { fill: #ffffff; stroke: #22272e; stroke-width: 1.4; }
.name { text-anchor: middle; }
.value { font-size: 12px; fill: #5b6470; text-anchor: end; }
)";

// About so many pixels take the lines above the boxes.
double WidthOfTexts(const BoxFigure& figure) {
  constexpr double kTitleCharacter = 15.0;
  constexpr double kCharacter = 7.0;
  return kLeft + std::max(kTitleCharacter * static_cast<double>(figure.title.size()),
                          kCharacter * static_cast<double>(figure.outcome.size()));
}

class BoxDrawing {
 public:
  explicit BoxDrawing(const BoxFigure& figure)
      : figure_(figure),
        canvas_(
            std::max(kLeft + kColumn * static_cast<double>(figure.boxes.size()), WidthOfTexts(figure)) + 40,
            kTop + kHeight + kBottom, figure.title, kStyle) {
    low_ = high_ = figure.boxes.front().box.median;
    for (const NamedBox& one : figure.boxes) {
      low_ = std::min(low_, one.box.lower_whisker);
      high_ = std::max(high_, one.box.upper_whisker);
      if (one.box.outliers.empty()) continue;
      low_ = std::min(low_, one.box.outliers.front());
      high_ = std::max(high_, one.box.outliers.back());
    }
    if (high_ == low_) {
      low_ -= 0.5;
      high_ += 0.5;
    }
  }

  std::string Draw() {
    canvas_.Text({kLeft, 38}, figure_.title, "class=\"title\"");
    canvas_.Text({kLeft, 64}, figure_.outcome, "class=\"axis\"");
    DrawAxis();
    for (std::size_t i = 0; i < figure_.boxes.size(); ++i) {
      DrawBox(figure_.boxes[i], kLeft + kColumn * (static_cast<double>(i) + 0.5));
    }
    canvas_.Text({kLeft, kTop + kHeight + kBottom - 32}, "line: median; ring: mean; small circles: outliers",
                 "class=\"axis\"");
    canvas_.Text({kLeft, kTop + kHeight + kBottom - 14}, kBoxRule, "class=\"axis\"");
    return canvas_.Take();
  }

 private:
  double Y(double value) const { return kTop + kHeight * (high_ - value) / (high_ - low_); }

  void DrawAxis() {
    const double right = kLeft + kColumn * static_cast<double>(figure_.boxes.size());
    canvas_.Text({kLeft - 80, kTop - 10}, figure_.axis_name, "class=\"axis\"");
    for (const double value : RoundValues(low_, high_, 8)) {
      canvas_.Line({kLeft, Y(value)}, {right, Y(value)}, "class=\"rule\"");
      canvas_.Text({kLeft - 8, Y(value) + 4}, fmt::format("{:.6g}", value), "class=\"value\"");
    }
  }

  void DrawBox(const NamedBox& one, double x) {
    const BoxPlot& box = one.box;
    const double half = kBox / 2;
    canvas_.Line({x, Y(box.lower_whisker)}, {x, Y(box.lower_quartile)}, "class=\"whisker\"");
    canvas_.Line({x, Y(box.upper_quartile)}, {x, Y(box.upper_whisker)}, "class=\"whisker\"");
    for (const double end : {box.lower_whisker, box.upper_whisker}) {
      canvas_.Line({x - half / 2, Y(end)}, {x + half / 2, Y(end)}, "class=\"whisker\"");
    }
    canvas_.Rectangle({x - half, Y(box.upper_quartile)}, kBox, Y(box.lower_quartile) - Y(box.upper_quartile),
                      "class=\"box\"");
    canvas_.Line({x - half, Y(box.median)}, {x + half, Y(box.median)}, "class=\"median\"");
    // Points in the same place are drawn once: a hundred thousand make no other picture.
    double before = -1.0;
    for (const double outlier : box.outliers) {
      if (std::fabs(Y(outlier) - before) < 0.5) continue;
      before = Y(outlier);
      canvas_.Circle({x, before}, 3, "class=\"outlier\"");
    }
    canvas_.Circle({x, Y(one.mean)}, 4, "class=\"mean\"");
    std::string name = one.name;
    if (name.size() > kMostCharacters) name = "..." + name.substr(name.size() - kMostCharacters + 3);
    canvas_.Text({x, kTop + kHeight + 24}, name, "class=\"name\"");
    canvas_.Text({x, kTop + kHeight + 42}, fmt::format("n = {}", FormatCount(one.n)), "class=\"name\"");
  }

  const BoxFigure& figure_;
  SvgCanvas canvas_;
  double low_ = 0.0;
  double high_ = 1.0;
};

}  // namespace

std::string DrawBoxes(const BoxFigure& figure) {
  return BoxDrawing(figure).Draw();
}

}  // namespace gauntlet::analysis
