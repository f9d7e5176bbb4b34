#include "analysis/figures/run/run_panel.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "analysis/figures/run/run_annotations.h"
#include "base/number_text.h"

namespace gauntlet::analysis {
namespace {

constexpr double kRow = 25.0;        // pixels between legend rows
constexpr double kFigureRow = 20.0;  // pixels between figures
constexpr std::size_t kMostMetrics = 9;
constexpr std::size_t kMostTitle = 95;  // characters that fit the page

std::string Shortened(std::string text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t cut = most - 1;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xC0) == 0x80) --cut;
  text.resize(cut);
  return text + "\u2026";
}

class Panel {
 public:
  Panel(SvgCanvas& canvas, const FigureFrame& frame)
      : canvas_(canvas),
        left_(frame.right() + 30),
        right_(frame.page_width() - 22),
        y_(FigureFrame::kTop + 12) {}

  void Heading(std::string_view text) {
    canvas_.Text({left_, y_}, text, "class=\"heading\"");
    y_ += 8;
    canvas_.Line({left_, y_}, {right_, y_}, "class=\"rule\"");
    y_ += 19;
  }
  // `draw` gets the middle of the swatch, which is 34 pixels wide.
  void Row(std::string_view text, const std::function<void(Pixel)>& draw) {
    draw({left_ + 17, y_ - 4.5});
    canvas_.Text({left_ + 46, y_}, text, "class=\"legend\"");
    y_ += kRow;
  }
  void Figure(std::string_view name, std::string_view value) {
    canvas_.Text({left_, y_}, name, "class=\"name\"");
    canvas_.Text({right_, y_}, value, "class=\"value\"");
    y_ += kFigureRow;
  }
  void Skip(double pixels) { y_ += pixels; }

 private:
  SvgCanvas& canvas_;
  double left_;
  double right_;
  double y_;
};

// A swatch of a way: faint at its beginning, strong at its end.
void DrawWaySwatch(SvgCanvas& canvas, Pixel middle, std::string_view color, double width) {
  for (int i = 0; i < 4; ++i) {
    const double x = middle.x - 17 + i * 8.5;
    canvas.Line({x, middle.y}, {x + 8.5, middle.y},
                fmt::format("stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{}\"", color, width,
                            SvgNumber(0.3 + 0.22 * i)));
  }
}

// The swatch of a mark.
void DrawSwatch(SvgCanvas& canvas, Pixel p, sim::Mark mark) {
  switch (mark) {
    case sim::Mark::kArea:
      return canvas.Rectangle({p.x - 14, p.y - 8}, 28, 16, "class=\"spawn\"");
    case sim::Mark::kPlan:
    case sim::Mark::kChain:
      return canvas.Line({p.x - 17, p.y}, {p.x + 17, p.y}, fmt::format("class=\"{}\"", ClassOf(mark)));
    case sim::Mark::kGoal:
    case sim::Mark::kNest:
    case sim::Mark::kFood:
      return canvas.Circle(p, 8.0, fmt::format("class=\"{}\"", ClassOf(mark)));
    case sim::Mark::kSplit:
      canvas.Circle({p.x - 6, p.y}, 8.0, "class=\"split\"");
      return DrawDiamond(canvas, {p.x + 10, p.y}, 5.0, "split-robot");
    case sim::Mark::kTransfer:
      return DrawTransfer(canvas, p);
    case sim::Mark::kBeacon:
      DrawDiamond(canvas, p, 12.0, "beacon");
      return DrawRobot(canvas, p, 5.0, 0.0, kKeptColor, "");
    case sim::Mark::kFormerBeacon:
      return DrawDiamond(canvas, p, 6.0, "beacon-before");
  }
}

// What annotations are drawn as, in the order of the style.
void DrawMarksLegend(SvgCanvas& canvas, Panel& panel, const RunFigure& figure) {
  for (const sim::AnnotationStyle& style : figure.style.annotations) {
    const auto draw = [&](Pixel p) { DrawSwatch(canvas, p, style.mark); };
    if (style.mark == sim::Mark::kFormerBeacon) {
      const RobotStates states = StatesOf(figure.result);
      if (std::ranges::find(states.names, style.label) != states.names.end()) panel.Row(style.legend, draw);
      continue;
    }
    const auto annotations = MarkedBy(figure, style);
    if (annotations.empty()) continue;
    if (style.mark == sim::Mark::kTransfer) {
      panel.Row(fmt::format("{} {} of an item", annotations.size(), Plural(annotations.size(), style.legend)),
                draw);
    } else if (!style.legend.empty()) {
      panel.Row(style.legend, draw);
    } else {
      for (const sim::Annotation* one : annotations) {
        const std::string when =
            one->tick < 0 ? "" : fmt::format(", at {:.0f} s", one->tick * sim::kTickSeconds);
        panel.Row(Shortened(one->label, 26) + when, draw);
      }
    }
  }
}

void DrawWaysLegend(SvgCanvas& canvas, Panel& panel, const RunFigure& figure,
                    const std::vector<Track>& tracks) {
  const sim::RunStyle& style = figure.style;
  const auto count = [&](TrackKind kind) {
    return static_cast<std::size_t>(std::ranges::count(tracks, kind, &Track::kind));
  };
  const std::size_t kept = count(TrackKind::kKept);
  const std::size_t lost = count(TrackKind::kLost);
  if (kept > 0) {
    const std::string not_lost = style.lost.empty() ? "" : ", not " + style.lost;
    panel.Row(fmt::format("{} {}{}", kept, Plural(kept, style.member), not_lost),
              [&](Pixel p) { DrawWaySwatch(canvas, p, kKeptColor, 2.0); });
  }
  if (lost > 0) {
    const bool trapped =
        std::ranges::any_of(tracks, [](const Track& track) { return track.trapped_from.has_value(); });
    panel.Row(fmt::format("{} {}, {}{}", lost, Plural(lost, style.member), style.lost,
                          trapped ? ", then strong" : ""),
              [&](Pixel p) { DrawWaySwatch(canvas, p, kLostColor, 2.6); });
  }
  if (count(TrackKind::kGuide) > 0) {
    panel.Row(fmt::format("{}, travelled", style.guide),
              [&](Pixel p) { DrawWaySwatch(canvas, p, kGuideColor, 3.6); });
  }
  if (!tracks.empty()) {
    panel.Row("faint = early, strong = late", [&](Pixel p) { DrawWaySwatch(canvas, p, kInk, 1.5); });
    panel.Row("start, with heading", [&](Pixel p) {
      canvas.Line(p, {p.x + 9, p.y}, fmt::format("stroke=\"{}\" stroke-width=\"1.6\"", kKeptColor));
      canvas.Circle(p, 3.6, fmt::format("class=\"start\" stroke=\"{}\"", kKeptColor));
    });
    panel.Row("end, with heading and number",
              [&](Pixel p) { DrawRobot(canvas, p, 8.0, 0.0, kKeptColor, "3"); });
  }
  if (lost > 0) {
    panel.Row(fmt::format("end of a {} {}", style.lost, style.member), [&](Pixel p) {
      DrawLostRing(canvas, p, 8.0, kLostColor);
      DrawRobot(canvas, p, 8.0, 0.0, kLostColor, "7");
    });
  }
}

void DrawObstaclesLegend(SvgCanvas& canvas, Panel& panel, const sim::Genome& genome) {
  if (!genome.empty()) {
    panel.Row(
        genome.size() == 1 ? std::string("obstacle 1") : fmt::format("obstacles 1 to {}", genome.size()),
        [&](Pixel p) {
          canvas.Rectangle({p.x - 14, p.y - 7}, 28, 14, "class=\"obstacle\"");
          canvas.Text({p.x, p.y + 4.5}, "1", "class=\"obstacle-number\"");
        });
  }
  if (std::ranges::any_of(genome, &sim::ObstacleGene::Moves)) {
    panel.Row("way of a moving obstacle", [&](Pixel p) {
      canvas.Line({p.x - 14, p.y}, {p.x + 14, p.y}, "class=\"obstacle-path\"");
    });
  }
  if (const auto lit = std::ranges::find_if(genome, &sim::ObstacleGene::Lit); lit != genome.end()) {
    panel.Row("lamps of an obstacle", [&](Pixel p) {
      canvas.Circle(p, 5.0, fmt::format("class=\"lamp\" fill=\"{}\"", sim::NameOf(lit->light)));
    });
  }
}

void DrawFigures(Panel& panel, const RunFigure& figure) {
  const sim::RunResult& result = figure.result;
  panel.Skip(14);
  panel.Heading("RUN");
  panel.Figure("scenario", Shortened(figure.spec.scenario, 26));
  panel.Figure("controller", Shortened(figure.spec.controller, 26));
  for (const auto& [key, value] : sim::DisturbanceTexts(figure.spec.disturbances)) {
    panel.Figure(key, Shortened(value, 16));
  }
  if (const std::string& name = figure.spec.test_case.name; !name.empty()) {
    panel.Figure("test case", Shortened(name, 26));
  }
  panel.Figure("seed", fmt::format("{}", figure.spec.seed));
  if (result.verdict == sim::Verdict::kCompleted) {
    panel.Figure("simulated", fmt::format("{:.1f} s", result.ticks * sim::kTickSeconds));
    panel.Figure("fitness (lower = tougher)", fmt::format("{:.4f}", result.fitness));
  }
  for (std::size_t i = 0; i < std::min(kMostMetrics, figure.metrics.size()); ++i) {
    std::string name = figure.metrics[i].first;
    std::replace(name.begin(), name.end(), '_', ' ');
    panel.Figure(Shortened(name, 26), figure.metrics[i].second);
  }
  panel.Figure("hash", fmt::format("{:016x}", result.hash));
}

}  // namespace

std::string_view ClassOf(sim::Mark mark) {
  return mark == sim::Mark::kPlan    ? "plan"
         : mark == sim::Mark::kChain ? "chain"
         : mark == sim::Mark::kNest  ? "nest"
         : mark == sim::Mark::kFood  ? "food"
                                     : "goal";
}

std::string DescribeOutcome(const RunFigure& figure) {
  const sim::RunResult& result = figure.result;
  const sim::RunStyle& style = figure.style;
  if (result.verdict != sim::Verdict::kCompleted) {
    const std::string_view what = result.verdict == sim::Verdict::kRefused ? "refused" : "the run failed";
    return fmt::format("{}: {}", what, result.message);
  }
  std::string violated;
  if (const sim::Annotation* first = result.failure.total ? FirstViolation(result) : nullptr)
    violated = fmt::format("{}, at {:.6g} s", Shortened(first->label, 60), first->tick * sim::kTickSeconds);
  if (style.lost.empty() && !violated.empty()) return "total failure: " + violated;
  if (style.lost.empty()) return result.failure.total ? "total failure" : "no failure";
  const int guide = GuideOf(figure);
  std::size_t members = 0;
  std::size_t lost = 0;
  for (std::size_t i = 0; i < result.robots.size(); ++i) {
    if (static_cast<int>(i) == guide) continue;
    ++members;
    if (result.robots[i].lost) ++lost;
  }
  const std::string_view prefix = result.failure.total ? "total failure: " : "";
  const std::string who =
      lost == 0 ? fmt::format("no {} {}", style.member, style.lost)
                : fmt::format("{} of {} {} {}", lost, members, Plural(members, style.member), style.lost);
  if (!violated.empty()) return fmt::format("total failure: {}; {}", violated, who);
  const bool labelled = result.failure.total && !result.failure.label.empty();
  if (labelled && lost == 0) return fmt::format("{}{}", prefix, result.failure.label);
  if (result.failure.total && !style.lost_is_failure)
    return fmt::format("total failure{}; {}",
                       labelled ? ": " + result.failure.label : " by the scenario's own rule", who);
  return fmt::format("{}{}", prefix, who);
}

void DrawTitle(SvgCanvas& canvas, const RunFigure& figure, double left, double right) {
  const sim::RunResult& result = figure.result;
  canvas.Text(
      {left, 40},
      Shortened(figure.run.empty() ? figure.experiment : fmt::format("{}, {}", figure.experiment, figure.run),
                70),
      "class=\"title\"");
  const std::string outcome = DescribeOutcome(figure);
  const bool harmless = outcome.starts_with("no ");
  const bool bad = result.failure.total || result.verdict != sim::Verdict::kCompleted;
  const std::string_view color = bad ? kLostColor : harmless ? kGuideColor : std::string_view("#9a6700");
  canvas.Rectangle({left, 56}, 5, 20, fmt::format("fill=\"{}\"", color));
  const std::string line = Shortened(outcome, kMostTitle);
  canvas.Text({left + 14, 71}, line, fmt::format("class=\"outcome\" style=\"fill: {}\"", color));
  if (result.verdict != sim::Verdict::kCompleted) return;
  canvas.Text({right, 40},
              fmt::format("fitness {:.3f} after {:.0f} s", result.fitness, result.ticks * sim::kTickSeconds),
              "class=\"subtitle\"");
  if (!result.failure.label.empty()) {
    canvas.Text({right, 71},
                fmt::format("failure type {}: {}", result.failure.type, Shortened(result.failure.label, 80)),
                "class=\"subtitle\"");
  }
}

void DrawPanel(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame,
               const std::vector<Track>& tracks) {
  Panel panel(canvas, frame);
  panel.Heading("LEGEND");
  DrawWaysLegend(canvas, panel, figure, tracks);
  DrawMarksLegend(canvas, panel, figure);
  DrawObstaclesLegend(canvas, panel, figure.spec.test_case.obstacles);
  DrawFigures(panel, figure);
}

}  // namespace gauntlet::analysis
