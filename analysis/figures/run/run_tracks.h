// The trajectories of the robots in a run's picture: lines that grow stronger with time, start and end marks.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/figures/figure_frame.h"
#include "analysis/figures/run/run_figure.h"
#include "analysis/figures/svg_canvas.h"

namespace gauntlet::analysis {

enum class TrackKind { kKept, kLost, kGuide };

struct Track {
  int robot = 0;
  TrackKind kind = TrackKind::kKept;
  std::string color;
  std::vector<Pixel> points;           // thinned: neighbours are at least a pixel apart
  std::vector<double> times;           // of the points, as a share of the run: 0..1
  std::optional<double> trapped_from;  // from then on it kept to one place; the same share
  bool crowded = false;                // one of so many that its trajectory is drawn thin and faint
  sim::Pose start;
  sim::Pose end;
};

// One track per robot that has any pose, in robot order.
std::vector<Track> TracksOf(const RunFigure& figure, const FigureFrame& frame);
// Pose of a robot at a tick; nothing when the trajectory does not hold it.
std::optional<sim::Vec2> PositionAt(const RunFigure& figure, int robot, sim::Tick tick);

void DrawWay(SvgCanvas& canvas, const Track& track);
void DrawStart(SvgCanvas& canvas, const FigureFrame& frame, const Track& track);
// All robots at their ends, the lost ones ringed; the guide bears the initial of that word.
void DrawEnds(SvgCanvas& canvas, const FigureFrame& frame, const std::vector<Track>& tracks,
              std::string_view guide);
// The marks of one robot, also used by the legend. `radius` in pixels, heading in rad.
void DrawRobot(SvgCanvas& canvas, Pixel center, double radius, double heading, std::string_view color,
               std::string_view label);
void DrawLostRing(SvgCanvas& canvas, Pixel center, double radius, std::string_view color);
// A square on its corner, `half` its diagonal in pixels: a "split-robot", one of those who left at a split, a
// "beacon", or, hollow, the place of a "beacon-before".
void DrawDiamond(SvgCanvas& canvas, Pixel center, double half, std::string_view name);
// The mark of a hand-over between two robots.
void DrawTransfer(SvgCanvas& canvas, Pixel center);

}  // namespace gauntlet::analysis
