#include "analysis/figures/run_panel.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "analysis/figures/robot_states.h"

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

std::string Plural(std::string_view noun, std::size_t count) {
  return count == 1 ? std::string(noun) : fmt::format("{}s", noun);
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

void DrawPlacesLegend(SvgCanvas& canvas, Panel& panel, const RunFigure& figure) {
  const RobotStates states = StatesOf(figure.result);
  if (std::find(states.names.begin(), states.names.end(), "beacon") != states.names.end()) {
    panel.Row("beacon at the end, earlier", [&](Pixel p) {
      DrawBeacon(canvas, {p.x - 6, p.y}, 12.0, true);
      DrawRobot(canvas, {p.x - 6, p.y}, 5.0, 0.0, kKeptColor, "");
      DrawBeacon(canvas, {p.x + 14, p.y}, 6.0, false);
    });
  }
  const auto transfers = static_cast<std::size_t>(
      std::count_if(figure.result.annotations.begin(), figure.result.annotations.end(),
                    [](const sim::Annotation& annotation) {
                      return annotation.kind == "transfer" && !annotation.points.empty();
                    }));
  if (transfers > 0) {
    panel.Row(fmt::format("{} {} of an item", transfers, Plural("transfer", transfers)),
              [&](Pixel p) { DrawTransfer(canvas, p); });
  }
  if (const sim::Annotation* chain = LatestAnnotation(figure, "chain")) {
    panel.Row(fmt::format("{}, at {:.0f} s", Shortened(chain->label, 24), chain->tick * sim::kTickSeconds),
              [&](Pixel p) {
                canvas.Line({p.x - 17, p.y}, {p.x + 17, p.y}, "class=\"chain\"");
              });
  }
  for (const sim::Annotation& disc : figure.result.annotations) {
    if (disc.kind != "disc" || disc.points.empty()) continue;
    panel.Row(disc.label.empty() ? "goal" : Shortened(disc.label, 26),
              [&](Pixel p) { canvas.Circle(p, 8.0, fmt::format("class=\"{}\"", PlaceClass(disc))); });
  }
}

void DrawLegend(SvgCanvas& canvas, Panel& panel, const RunFigure& figure, const std::vector<Track>& tracks) {
  const auto count = [&](TrackKind kind) {
    return static_cast<std::size_t>(
        std::count_if(tracks.begin(), tracks.end(), [kind](const Track& t) { return t.kind == kind; }));
  };
  const std::size_t kept = count(TrackKind::kKept);
  const std::size_t lost = count(TrackKind::kLost);
  panel.Heading("LEGEND");
  if (kept > 0) {
    panel.Row(fmt::format("{} {}, not {}", kept, Plural(figure.member, kept), figure.lost),
              [&](Pixel p) { DrawWaySwatch(canvas, p, kKeptColor, 2.0); });
  }
  if (lost > 0) {
    const bool trapped = std::any_of(tracks.begin(), tracks.end(),
                                     [](const Track& track) { return track.trapped_from.has_value(); });
    panel.Row(fmt::format("{} {}, {}{}", lost, Plural(figure.member, lost), figure.lost,
                          trapped ? ", then strong" : ""),
              [&](Pixel p) { DrawWaySwatch(canvas, p, kLostColor, 2.6); });
  }
  if (count(TrackKind::kPrey) > 0) {
    panel.Row("prey, travelled", [&](Pixel p) { DrawWaySwatch(canvas, p, kPreyColor, 3.6); });
  }
  if (LatestAnnotation(figure, "path") != nullptr) {
    panel.Row("planned path", [&](Pixel p) {
      canvas.Line({p.x - 17, p.y}, {p.x + 17, p.y}, "class=\"plan\"");
    });
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
    panel.Row(fmt::format("end of a {} {}", figure.lost, figure.member), [&](Pixel p) {
      DrawLostRing(canvas, p, 8.0, kLostColor);
      DrawRobot(canvas, p, 8.0, 0.0, kLostColor, "7");
    });
  }
  if (LatestAnnotation(figure, "split") != nullptr) {
    panel.Row("last split, and who left then", [&](Pixel p) {
      canvas.Circle({p.x - 6, p.y}, 8.0, "class=\"split\"");
      canvas.Polygon({{p.x + 10, p.y - 5}, {p.x + 15, p.y}, {p.x + 10, p.y + 5}, {p.x + 5, p.y}},
                     "class=\"split-robot\"");
    });
  }
  DrawPlacesLegend(canvas, panel, figure);
  if (LatestAnnotation(figure, "area") != nullptr) {
    panel.Row("area the swarm starts in", [&](Pixel p) {
      canvas.Rectangle({p.x - 14, p.y - 8}, 28, 16, "class=\"spawn\"");
    });
  }
  const std::size_t obstacles = figure.spec.test_case.obstacles.size();
  if (obstacles > 0) {
    panel.Row(obstacles == 1 ? std::string("obstacle 1") : fmt::format("obstacles 1 to {}", obstacles),
              [&](Pixel p) {
                canvas.Rectangle({p.x - 14, p.y - 7}, 28, 14, "class=\"obstacle\"");
                canvas.Text({p.x, p.y + 4.5}, "1", "class=\"obstacle-number\"");
              });
  }
  const sim::Genome& genome = figure.spec.test_case.obstacles;
  if (std::any_of(genome.begin(), genome.end(), [](const sim::ObstacleGene& gene) { return gene.Moves(); })) {
    panel.Row("way of a moving obstacle", [&](Pixel p) {
      canvas.Line({p.x - 14, p.y}, {p.x + 14, p.y}, "class=\"obstacle-path\"");
    });
  }
  const auto lit = std::find_if(genome.begin(), genome.end(), [](const auto& gene) { return gene.Lit(); });
  if (lit != genome.end()) {
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

const sim::Annotation* LatestAnnotation(const RunFigure& figure, std::string_view kind) {
  const sim::Annotation* latest = nullptr;
  for (const sim::Annotation& annotation : figure.result.annotations) {
    if (annotation.kind != kind || annotation.points.empty()) continue;
    if (latest == nullptr || annotation.tick >= latest->tick) latest = &annotation;
  }
  return latest;
}

std::string DescribeOutcome(const RunFigure& figure) {
  const sim::RunResult& result = figure.result;
  if (result.verdict != sim::Verdict::kCompleted) {
    const std::string_view what = result.verdict == sim::Verdict::kRefused ? "refused" : "the run failed";
    return fmt::format("{}: {}", what, result.message);
  }
  const int prey = PreyOf(result);
  std::size_t members = 0;
  std::size_t lost = 0;
  for (std::size_t i = 0; i < result.robots.size(); ++i) {
    if (static_cast<int>(i) == prey) continue;
    ++members;
    if (result.robots[i].lost) ++lost;
  }
  const std::string_view prefix = result.failure.total ? "total failure: " : "";
  const std::string who =
      lost == 0 ? fmt::format("no {} {}", figure.member, figure.lost)
                : fmt::format("{} of {} {} {}", lost, members, Plural(figure.member, members), figure.lost);
  const bool labelled = result.failure.total && !result.failure.label.empty();
  if (labelled && lost == 0) return fmt::format("{}{}", prefix, result.failure.label);
  if (labelled && !figure.lost_is_failure) return fmt::format("{}{}; {}", prefix, result.failure.label, who);
  return fmt::format("{}{}", prefix, who);
}

std::string_view PlaceClass(const sim::Annotation& disc) {
  if (disc.label == "nest") return "nest";
  return disc.label == "food" ? "food" : "goal";
}

void DrawBeacon(SvgCanvas& canvas, Pixel center, double half, bool stands) {
  canvas.Polygon({{center.x, center.y - half},
                  {center.x + half, center.y},
                  {center.x, center.y + half},
                  {center.x - half, center.y}},
                 stands ? "class=\"beacon\"" : "class=\"beacon-before\"");
}

void DrawTransfer(SvgCanvas& canvas, Pixel center) {
  canvas.Circle({center.x - 3, center.y}, 4.5, "class=\"transfer\"");
  canvas.Circle({center.x + 3, center.y}, 4.5, "class=\"transfer\"");
}

void DrawTitle(SvgCanvas& canvas, const RunFigure& figure, const FigureFrame& frame) {
  const sim::RunResult& result = figure.result;
  canvas.Text(
      {FigureFrame::kLeft, 40},
      Shortened(figure.run.empty() ? figure.experiment : fmt::format("{}, {}", figure.experiment, figure.run),
                70),
      "class=\"title\"");
  const std::string outcome = DescribeOutcome(figure);
  const bool harmless = outcome.starts_with("no ");
  const bool bad = result.failure.total || result.verdict != sim::Verdict::kCompleted;
  const std::string_view color = bad ? kLostColor : harmless ? kPreyColor : std::string_view("#9a6700");
  canvas.Rectangle({FigureFrame::kLeft, 56}, 5, 20, fmt::format("fill=\"{}\"", color));
  const std::string line = Shortened(outcome, kMostTitle);
  canvas.Text({FigureFrame::kLeft + 14, 71}, line,
              fmt::format("class=\"outcome\" style=\"fill: {}\"", color));
  if (result.verdict != sim::Verdict::kCompleted) return;
  const double right = frame.page_width() - 22;
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
  DrawLegend(canvas, panel, figure, tracks);
  DrawFigures(panel, figure);
}

}  // namespace gauntlet::analysis
