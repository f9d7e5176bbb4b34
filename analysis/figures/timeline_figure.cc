#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/run/run_annotations.h"
#include "analysis/figures/run/run_figure.h"
#include "analysis/figures/run/run_panel.h"
#include "analysis/figures/svg_canvas.h"
#include "analysis/figures/value_axis.h"

namespace gauntlet::analysis {
namespace {

constexpr std::string_view kTimelineStyle =
    R"(.guide { stroke: #ffffff; stroke-opacity: 0.55; stroke-width: 1; }
.row { font-size: 12px; text-anchor: end; }
.share { font-size: 12px; fill: #5b6470; text-anchor: end; }
.trapped { fill: none; stroke: #d1410c; stroke-width: 2.4; }
.trapped-text { font-size: 12px; font-weight: bold; fill: #d1410c; }
)";

class Timeline {
 public:
  explicit Timeline(const RunFigure& figure)
      : figure_(figure),
        states_(StatesOf(figure.result)),
        seconds_(std::max(1.0, figure.result.ticks * sim::kTickSeconds)),
        rows_bottom_(kTop + states_.robots * kRow),
        counts_bottom_(rows_bottom_ + kCountsTop + kCounts),
        canvas_(
            kLeft + kWidth + kPanel, counts_bottom_ + 66,
            fmt::format("{}, {}: what every {} did when", figure.experiment, figure.run, figure.style.member),
            kTimelineStyle) {}

  std::string Draw() {
    DrawHead();
    DrawRows();
    DrawTrapped();
    DrawCounts();
    DrawTimeAxis();
    DrawLegend();
    return canvas_.Take();
  }

 private:
  // Pixels.
  static constexpr double kLeft = 92.0;
  static constexpr double kTop = 130.0;  // below the title and the heading
  static constexpr double kWidth = 800.0;
  static constexpr double kRow = 21.0;
  static constexpr double kBar = 16.0;
  static constexpr double kCountsTop = 50.0;  // between the rows and the counts
  static constexpr double kCounts = 170.0;
  static constexpr double kPanel = 230.0;
  static constexpr double kLeastBar = 3.0;        // so that a spell of one second is seen
  static constexpr double kMostColumns = kWidth;  // of the counts: no more than there are pixels

  double X(double second) const { return kLeft + kWidth * second / seconds_; }
  double RowTop(int robot) const { return kTop + robot * kRow + (kRow - kBar) / 2; }

  void DrawHead() {
    DrawTitle(canvas_, figure_, kLeft, kLeft + kWidth + kPanel - 22);
    canvas_.Text({kLeft, kTop - 12}, fmt::format("WHAT EVERY {} DID", Upper(figure_.style.member)),
                 "class=\"heading\"");
    canvas_.Text({kLeft, rows_bottom_ + kCountsTop - 12},
                 fmt::format("HOW MANY {}S DID WHAT", Upper(figure_.style.member)), "class=\"heading\"");
  }

  static std::string Upper(std::string_view noun) {
    std::string text(noun);
    for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return text;
  }

  void DrawRows() {
    for (int robot = 0; robot < states_.robots; ++robot) {
      canvas_.Text({kLeft - 10, RowTop(robot) + kBar - 3.5},
                   fmt::format("{} {}", figure_.style.member, robot), "class=\"row\"");
    }
    // Short spells last: they are drawn wider than they are and must not be covered.
    for (const bool brief : {false, true}) {
      for (const StateSpell& spell : states_.spells) {
        const double width = X(spell.end) - X(spell.begin);
        if (width <= 0.0 || (width < kLeastBar) != brief) continue;
        canvas_.Rectangle({X(spell.begin), RowTop(spell.robot)}, std::max(width, kLeastBar), kBar,
                          fmt::format("class=\"spell\" fill=\"{}\"", StateColor(spell.state)));
      }
    }
  }

  void DrawTrapped() {
    for (const sim::Annotation& annotation : figure_.result.annotations) {
      if (annotation.kind != "trapped" || annotation.robots.empty()) continue;
      const int robot = annotation.robots.front();
      if (robot < 0 || robot >= states_.robots) continue;
      const double left = X(std::max(0, annotation.tick) * sim::kTickSeconds);
      canvas_.Rectangle({left, RowTop(robot) - 1}, kLeft + kWidth - left, kBar + 2, "class=\"trapped\"");
      canvas_.Text({kLeft + kWidth + 10, RowTop(robot) + kBar - 3.5}, annotation.label,
                   "class=\"trapped-text\"");
    }
  }

  // Robots in that state at a moment.
  std::vector<int> CountAt(double second) const {
    std::vector<int> counts(states_.names.size(), 0);
    for (const StateSpell& spell : states_.spells) {
      if (spell.begin <= second && second < spell.end) ++counts[static_cast<std::size_t>(spell.state)];
    }
    return counts;
  }

  void DrawCounts() {
    const double height = kCounts / std::max(1, states_.robots);
    std::vector<std::vector<Pixel>> tops(states_.names.size());
    std::vector<std::vector<Pixel>> bottoms(states_.names.size());
    // One column a second, as states are looked at.
    const int columns = static_cast<int>(std::clamp(std::ceil(seconds_), 1.0, kMostColumns));
    for (int column = 0; column < columns; ++column) {
      const std::vector<int> counts = CountAt(seconds_ * (column + 0.5) / columns);
      double y = counts_bottom_;
      // From the bottom: the last state first, so that beacons are the ground the others stand on.
      for (std::size_t i = states_.names.size(); i-- > 0;) {
        const double top = y - counts[i] * height;
        for (const double x : {kLeft + kWidth * column / columns, kLeft + kWidth * (column + 1) / columns}) {
          bottoms[i].push_back({x, y});
          tops[i].push_back({x, top});
        }
        y = top;
      }
    }
    for (std::size_t i = 0; i < states_.names.size(); ++i) {
      std::vector<Pixel> outline = tops[i];
      outline.insert(outline.end(), bottoms[i].rbegin(), bottoms[i].rend());
      canvas_.Polygon(outline, fmt::format("class=\"count\" fill=\"{}\"", StateColor(static_cast<int>(i))));
    }
    const int step = states_.robots > 50 ? 20 : states_.robots > 10 ? 5 : 1;
    for (int count = 0; count <= states_.robots; count += step) {
      const double y = counts_bottom_ - count * height;
      canvas_.Line({kLeft - 5, y}, {kLeft, y}, "class=\"tick\"");
      canvas_.Text({kLeft - 10, y + 4.5}, fmt::format("{}", count), "class=\"axis\" text-anchor=\"end\"");
    }
  }

  void DrawTimeAxis() {
    const double step = RoundStep(seconds_, 10);
    for (double second = 0.0; second <= seconds_; second += step) {
      const double x = X(second);
      canvas_.Line({x, kTop}, {x, rows_bottom_}, "class=\"guide\"");
      canvas_.Line({x, counts_bottom_ - kCounts}, {x, counts_bottom_}, "class=\"guide\"");
      canvas_.Line({x, counts_bottom_}, {x, counts_bottom_ + 6}, "class=\"tick\"");
      canvas_.Text({x, counts_bottom_ + 20}, fmt::format("{:g}", second),
                   "class=\"axis\" text-anchor=\"middle\"");
    }
    canvas_.Text({kLeft + kWidth / 2, counts_bottom_ + 42}, "time (s)",
                 "class=\"axis\" text-anchor=\"middle\"");
  }

  // Beside the counts: the states and the robots in them, mean over the run.
  void DrawLegend() {
    std::vector<double> seconds(states_.names.size(), 0.0);
    for (const StateSpell& spell : states_.spells) {
      seconds[static_cast<std::size_t>(spell.state)] += spell.end - spell.begin;
    }
    const double left = kLeft + kWidth + 26;
    const double right = kLeft + kWidth + kPanel - 22;
    double y = rows_bottom_ + kCountsTop + 4;
    canvas_.Text({left, y}, "STATE", "class=\"heading\"");
    canvas_.Text({right, y}, fmt::format("MEAN {}S", Upper(figure_.style.member)),
                 "class=\"heading\" text-anchor=\"end\"");
    canvas_.Line({left, y + 6}, {right, y + 6}, "class=\"rule\"");
    y += 24;
    for (std::size_t i = 0; i < states_.names.size(); ++i, y += 21) {
      canvas_.Rectangle({left, y - 11}, 24, 14, fmt::format("fill=\"{}\"", StateColor(static_cast<int>(i))));
      canvas_.Text({left + 34, y}, states_.names[i], "class=\"legend\"");
      canvas_.Text({right, y}, fmt::format("{:.1f}", seconds[i] / seconds_), "class=\"share\"");
    }
  }

  const RunFigure& figure_;
  RobotStates states_;
  double seconds_;
  double rows_bottom_;
  double counts_bottom_;
  SvgCanvas canvas_;
};

}  // namespace

bool HasTimeline(const RunFigure& figure) {
  return !StatesOf(figure.result).empty();
}

std::string DrawTimeline(const RunFigure& figure) {
  return Timeline(figure).Draw();
}

}  // namespace gauntlet::analysis
