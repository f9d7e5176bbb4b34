#include "tests/perf/scaling.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

#include "analysis/figures/svg_canvas.h"
#include "sim/simulation.h"
#include "tests/perf/cpu_cost.h"
#include "tests/support/toy_scenario.h"

namespace gauntlet::perf {
namespace {

using sim::PhysicsKind;

constexpr std::array<int, 6> kSwarms = {6, 11, 20, 50, 100, 500};

// Robots walking at random; floor area and obstacles per robot as with 11 robots in 6 m x 6 m among 8.
double RunCost(int robots, sim::Tick ticks, PhysicsKind physics) {
  sim::RandomStream random(7, sim::StreamPurpose::kTest);
  sim::TestCase test_case;
  const double scale = std::sqrt(std::max(robots, 11) / 11.0);
  test_case.side_x = test_case.side_y = 6.0 * scale;
  test_case.obstacles = sim::RandomObstacles(std::max(robots, 11) * 8 / 11, random);
  for (sim::ObstacleGene& gene : test_case.obstacles) {
    gene.x *= scale;
    gene.y *= scale;
  }
  sim::ToyScenario scenario(
      test_case,
      sim::RandomRobots(robots, test_case, sim::Vec2::Zero(), 2.9 * scale, sim::RandomWalk(0.1), random),
      ticks);
  return Cost([&] { sim::Simulate(scenario, 1, false, {.physics = physics}); });
}

struct Point {
  int robots;
  double impulse;  // ns per robot-tick
  double relaxation;
};

std::vector<Point> Measure() {
  std::vector<Point> points;
  std::printf("robots  impulse  relaxation  ratio   (user CPU, ns per robot-tick, medians)\n");
  for (const int robots : kSwarms) {
    const sim::Tick ticks = std::max(100, 20000 / robots);
    std::vector<double> impulse;
    std::vector<double> relaxation;
    std::vector<double> ratios;
    for (int repeat = 0; repeat < 7; ++repeat) {
      impulse.push_back(RunCost(robots, ticks, PhysicsKind::kImpulse));
      relaxation.push_back(RunCost(robots, ticks, PhysicsKind::kRelaxation));
      ratios.push_back(impulse.back() / relaxation.back());
    }
    const double unit = 1e9 / (static_cast<double>(robots) * ticks);
    points.push_back({robots, unit * Median(impulse), unit * Median(relaxation)});
    std::printf("%6d  %5.0f  %10.0f  %5.2f\n", robots, points.back().impulse, points.back().relaxation,
                Median(ratios));
  }
  return points;
}

void WriteSvg(const std::vector<Point>& points, const std::string& file) {
  double top = 0.0;
  for (const Point& point : points) top = std::max({top, point.impulse, point.relaxation});
  const auto place = [top](int robots, double cost) -> analysis::Pixel {
    return {60.0 + 420.0 * std::log(robots / 6.0) / std::log(500.0 / 6.0), 260.0 - 200.0 * cost / top};
  };
  analysis::SvgCanvas canvas(520.0, 310.0, "User CPU per robot-tick", "text { font: 12px sans-serif }");
  canvas.Text({60.0, 20.0}, "user CPU per robot-tick, ns (impulse solid, relaxation dashed)", "");
  canvas.Polyline({{60.0, 40.0}, {60.0, 260.0}, {480.0, 260.0}}, "fill=\"none\" stroke=\"black\"");
  std::vector<analysis::Pixel> impulse;
  std::vector<analysis::Pixel> relaxation;
  for (const Point& point : points) {
    impulse.push_back(place(point.robots, point.impulse));
    relaxation.push_back(place(point.robots, point.relaxation));
    const analysis::Pixel label = {impulse.back().x, impulse.back().y - 6.0};
    canvas.Text(label, std::to_string(std::lround(point.impulse)), "text-anchor=\"middle\"");
    canvas.Text({label.x, 276.0}, std::to_string(point.robots), "text-anchor=\"middle\"");
  }
  canvas.Polyline(impulse, "fill=\"none\" stroke=\"#1f5f99\" stroke-width=\"2\"");
  canvas.Polyline(relaxation, "fill=\"none\" stroke=\"#1f5f99\" stroke-width=\"2\" stroke-dasharray=\"5 4\"");
  canvas.Text({270.0, 298.0}, "robots, in proportionally larger arenas", "text-anchor=\"middle\"");
  std::ofstream(file) << canvas.Take();
  std::printf("plot: %s\n", file.c_str());
}

}  // namespace

void ReportScaling(const std::string& svg_file) {
  const auto points = Measure();
  if (!svg_file.empty()) WriteSvg(points, svg_file);
}

}  // namespace gauntlet::perf
