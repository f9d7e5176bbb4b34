#include "analysis/figures/run/run_tracks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/figures/run/run_annotations.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::analysis {
namespace {

constexpr double kLeastStep = 1.2;      // pixels between points that are drawn
constexpr int kFadeSteps = 8;           // pieces of growing strength per way
constexpr double kGuideArrows = 110.0;  // pixels of way between two arrowheads
constexpr double kLostArrows = 210.0;

struct Rgb {
  int red;
  int green;
  int blue;
};

// Neighbours of one hue: from light to dark with the robot's rank in its family.
constexpr Rgb kKeptLight{96, 156, 214};
constexpr Rgb kKeptDark{22, 70, 132};
constexpr Rgb kLostLight{240, 104, 42};
constexpr Rgb kLostDark{178, 36, 8};

std::string Mix(Rgb a, Rgb b, double share) {
  const auto channel = [share](int from, int to) {
    return from + static_cast<int>(std::lround(share * (to - from)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(a.red, b.red), channel(a.green, b.green),
                     channel(a.blue, b.blue));
}

bool Finite(const sim::Vec2& p) {
  return std::isfinite(p.x()) && std::isfinite(p.y());
}

void AppendPoint(Track& track, Pixel p, double time, bool always) {
  if (!track.points.empty() && !always) {
    const Pixel last = track.points.back();
    if (std::hypot(p.x - last.x, p.y - last.y) < kLeastStep) return;
  }
  track.points.push_back(p);
  track.times.push_back(time);
}

void ReadTrajectory(const RunFigure& figure, const FigureFrame& frame, Track& track) {
  const auto& ticks = figure.result.trajectory;
  const auto robot = static_cast<std::size_t>(track.robot);
  for (std::size_t t = 0; t < ticks.size(); ++t) {
    if (robot >= ticks[t].size() || !Finite(ticks[t][robot].position())) continue;
    const sim::RobotState& state = ticks[t][robot];
    const double time =
        ticks.size() > 1 ? static_cast<double>(t) / static_cast<double>(ticks.size() - 1) : 1.0;
    if (track.points.empty()) track.start = {state.position(), state.heading};
    track.end = {state.position(), state.heading};
    AppendPoint(track, frame.At(state.position()), time, t + 1 == ticks.size());
  }
}

void ReadSummary(const sim::RobotSummary& summary, const FigureFrame& frame, Track& track) {
  track.start = summary.start;
  track.end = summary.end;
  AppendPoint(track, frame.At(summary.start.position), 0.0, true);
  const double count = static_cast<double>(summary.waypoints.size()) + 1;
  for (std::size_t i = 0; i < summary.waypoints.size(); ++i) {
    if (Finite(summary.waypoints[i])) {
      AppendPoint(track, frame.At(summary.waypoints[i]), static_cast<double>(i + 1) / count, false);
    }
  }
  AppendPoint(track, frame.At(summary.end.position), 1.0, true);
}

constexpr int kCrowd = 12;  // more trajectories than this hide one another

double WidthOf(const Track& track) {
  if (track.kind == TrackKind::kKept) return track.crowded ? 0.8 : 1.5;
  if (track.kind == TrackKind::kLost) return track.trapped_from ? 1.2 : 2.3;
  return 3.2;
}

void DrawArrow(SvgCanvas& canvas, Pixel tip, double dx, double dy, double size, std::string_view color) {
  const Pixel base{tip.x - dx * size, tip.y - dy * size};
  const double half = 0.55 * size;
  canvas.Polygon({tip, {base.x - dy * half, base.y + dx * half}, {base.x + dy * half, base.y - dx * half}},
                 fmt::format("class=\"arrow\" fill=\"{}\"", color));
}

// Arrowheads along the way, the first half a distance from the start.
void DrawArrows(SvgCanvas& canvas, const Track& track) {
  const double every = track.kind == TrackKind::kGuide ? kGuideArrows : kLostArrows;
  double way = every / 2;
  const double from = track.trapped_from.value_or(0.0);
  const double size = track.kind == TrackKind::kGuide ? 11.0 : 8.0;
  for (std::size_t i = 3; i < track.points.size(); ++i) {
    const Pixel a = track.points[i - 1];
    const Pixel b = track.points[i];
    const double step = std::hypot(b.x - a.x, b.y - a.y);
    way += step;
    if (way < every || step == 0.0 || track.times[i] < from) continue;
    way = 0.0;
    // The direction over the last few points: steadier than that of one step.
    const Pixel before = track.points[i - 3];
    const double length = std::hypot(b.x - before.x, b.y - before.y);
    if (length > 0)
      DrawArrow(canvas, b, (b.x - before.x) / length, (b.y - before.y) / length, size, track.color);
  }
}

}  // namespace

int GuideOf(const RunFigure& figure) {
  for (const sim::Annotation* plan : MarkedAs(figure, sim::Mark::kPlan)) {
    if (!plan->robots.empty()) return plan->robots.front();
    for (std::size_t i = 0; i < figure.result.robots.size(); ++i) {
      constexpr double kSamePlace = 1e-6;  // m
      if ((figure.result.robots[i].start.position - plan->points.front()).norm() < kSamePlace) {
        return static_cast<int>(i);
      }
    }
  }
  return -1;
}

std::vector<Track> TracksOf(const RunFigure& figure, const FigureFrame& frame) {
  const auto& result = figure.result;
  const std::size_t robots =
      std::max(result.robots.size(), result.trajectory.empty() ? 0 : result.trajectory.front().size());
  const int guide = GuideOf(figure);
  std::vector<Track> tracks;
  for (std::size_t i = 0; i < robots; ++i) {
    Track track;
    track.robot = static_cast<int>(i);
    const bool lost = i < result.robots.size() && result.robots[i].lost;
    track.kind = track.robot == guide ? TrackKind::kGuide : lost ? TrackKind::kLost : TrackKind::kKept;
    if (!result.trajectory.empty()) {
      ReadTrajectory(figure, frame, track);
    } else {
      ReadSummary(result.robots[i], frame, track);
    }
    if (!track.points.empty()) tracks.push_back(std::move(track));
  }
  for (const TrackKind kind : {TrackKind::kKept, TrackKind::kLost}) {
    const auto family = static_cast<double>(
        std::count_if(tracks.begin(), tracks.end(), [kind](const Track& t) { return t.kind == kind; }));
    double rank = 0.0;
    for (Track& track : tracks) {
      if (track.kind != kind) continue;
      track.crowded = family > kCrowd;
      const double share = family > 1 ? rank / (family - 1) : 0.5;
      track.color =
          kind == TrackKind::kKept ? Mix(kKeptLight, kKeptDark, share) : Mix(kLostLight, kLostDark, share);
      rank += 1.0;
    }
  }
  for (Track& track : tracks) {
    if (track.kind == TrackKind::kGuide) track.color = kGuideColor;
  }
  for (const sim::Annotation& annotation : result.annotations) {
    if (annotation.kind != "trapped" || result.ticks <= 0) continue;
    for (Track& track : tracks) {
      if (annotation.robots != std::vector<sim::RobotIndex>{track.robot}) continue;
      track.trapped_from = static_cast<double>(annotation.tick) / result.ticks;
    }
  }
  return tracks;
}

std::optional<sim::Vec2> PositionAt(const RunFigure& figure, int robot, sim::Tick tick) {
  const auto& ticks = figure.result.trajectory;
  if (robot < 0 || tick < 0 || static_cast<std::size_t>(tick) >= ticks.size()) return std::nullopt;
  const auto& states = ticks[static_cast<std::size_t>(tick)];
  if (static_cast<std::size_t>(robot) >= states.size()) return std::nullopt;
  const sim::Vec2 position = states[static_cast<std::size_t>(robot)].position();
  return Finite(position) ? std::optional(position) : std::nullopt;
}

void DrawWay(SvgCanvas& canvas, const Track& track) {
  const std::string_view name = track.kind == TrackKind::kGuide  ? "guide"
                                : track.kind == TrackKind::kLost ? "lost"
                                                                 : "kept";
  canvas.OpenGroup(fmt::format("class=\"way {}\" id=\"robot-{}\" stroke=\"{}\" stroke-width=\"{}\"", name,
                               track.robot, track.color, WidthOf(track)));
  const double weakest = track.crowded ? 0.12 : track.kind == TrackKind::kKept ? 0.32 : 0.4;
  const double strongest = track.crowded || track.trapped_from ? 0.5 : 0.95;
  std::size_t begin = 0;
  for (int piece = 0; piece < kFadeSteps; ++piece) {
    std::size_t end = begin;
    while (end + 1 < track.points.size() &&
           (track.times[end] * kFadeSteps < piece + 1 || piece + 1 == kFadeSteps)) {
      ++end;
    }
    if (end > begin) {
      const std::vector<Pixel> points(track.points.begin() + static_cast<std::ptrdiff_t>(begin),
                                      track.points.begin() + static_cast<std::ptrdiff_t>(end) + 1);
      const double strength = weakest + (strongest - weakest) * piece / (kFadeSteps - 1);
      canvas.Polyline(points, fmt::format("stroke-opacity=\"{}\"", SvgNumber(strength)));
    }
    begin = end;
  }
  if (track.trapped_from) {
    const auto from = std::lower_bound(track.times.begin(), track.times.end(), *track.trapped_from);
    const std::vector<Pixel> loop(track.points.begin() + (from - track.times.begin()), track.points.end());
    if (loop.size() > 1) canvas.Polyline(loop, "class=\"loop\" stroke-width=\"2.6\"");
  }
  canvas.CloseGroup();
  if (track.kind != TrackKind::kKept) DrawArrows(canvas, track);
}

void DrawStart(SvgCanvas& canvas, const FigureFrame& frame, const Track& track) {
  const Pixel center = frame.At(track.start.position);
  const sim::Vec2 heading = sim::UnitVector(track.start.heading);
  constexpr double kRadius = 3.6;
  canvas.Line(center, {center.x + heading.x() * kRadius * 2.4, center.y - heading.y() * kRadius * 2.4},
              fmt::format("stroke=\"{}\" stroke-width=\"1.6\"", track.color));
  canvas.Circle(center, kRadius, fmt::format("class=\"start\" stroke=\"{}\"", track.color));
}

void DrawLostRing(SvgCanvas& canvas, Pixel center, double radius, std::string_view color) {
  canvas.Circle(center, 1.6 * radius, fmt::format("class=\"ring\" fill=\"{}\" stroke=\"{}\"", color, color));
}

void DrawRobot(SvgCanvas& canvas, Pixel center, double radius, double heading, std::string_view color,
               std::string_view label) {
  const sim::Vec2 nose = sim::UnitVector(heading);
  canvas.Line({center.x + nose.x() * radius, center.y - nose.y() * radius},
              {center.x + nose.x() * radius * 1.85, center.y - nose.y() * radius * 1.85},
              fmt::format("class=\"nose\" stroke=\"{}\"", color));
  canvas.Circle(center, radius, fmt::format("class=\"robot\" fill=\"{}\"", color));
  if (!label.empty()) canvas.Text({center.x, center.y + 3.4}, label, "class=\"number\"");
}

void DrawEnds(SvgCanvas& canvas, const FigureFrame& frame, const std::vector<Track>& tracks,
              std::string_view guide) {
  const char letter = guide.empty() ? ' ' : guide.front();
  const std::string initial(1,
                            letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter);
  const double radius = std::max(6.5, sim::foot_bot::kRadius * frame.scale());
  for (const Track& track : tracks) {
    if (track.kind == TrackKind::kLost) {
      DrawLostRing(canvas, frame.At(track.end.position), radius, track.color);
    }
  }
  for (const Track& track : tracks) {
    DrawRobot(canvas, frame.At(track.end.position), radius, track.end.heading, track.color,
              track.kind == TrackKind::kGuide ? initial : fmt::format("{}", track.robot));
  }
}

void DrawDiamond(SvgCanvas& canvas, Pixel center, double half, std::string_view name) {
  canvas.Polygon({{center.x, center.y - half},
                  {center.x + half, center.y},
                  {center.x, center.y + half},
                  {center.x - half, center.y}},
                 fmt::format("class=\"{}\"", name));
}

void DrawTransfer(SvgCanvas& canvas, Pixel center) {
  canvas.Circle({center.x - 3, center.y}, 4.5, "class=\"transfer\"");
  canvas.Circle({center.x + 3, center.y}, 4.5, "class=\"transfer\"");
}

}  // namespace gauntlet::analysis
