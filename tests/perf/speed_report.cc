// speed_report [--svg FILE]: what whole runs cost, and what a robot-tick costs with 6 to 500 robots in
// proportionally larger arenas; user CPU, everything included, with both physics engines, interleaved in one
// process.
// speed_report --guard BASELINE: fails when a run of 11 robots, measured against a calibration kernel in the
// same process, costs over 20 % more than the committed ratio ten times in a row. Medians of interleaved
// repeats, so that a noisy machine slows both sides of a ratio.

#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "analysis/figures/svg_canvas.h"
#include "controllers/registry.h"
#include "sim/simulation.h"
#include "tests/support/toy_scenario.h"
#include "worker/run_executor.h"

namespace gauntlet::sim {
namespace {

constexpr std::array<int, 6> kSwarms = {6, 11, 20, 50, 100, 500};

double CpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <typename Work>
double Cost(const Work& work) {
  const double before = CpuSeconds();
  work();
  return CpuSeconds() - before;
}

double Median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

// Robots walking at random in the default arena among 8 obstacles, who read proximity ring, camera,
// range-and-bearing and ground: the devices of foraging.
double ForagingLikeCost(int robots, Tick ticks, PhysicsKind physics) {
  RandomStream random(7, StreamPurpose::kTest);
  TestCase test_case;
  test_case.obstacles = RandomObstacles(8, random);
  std::vector<ToyRobot> swarm = RandomRobots(robots, test_case, Vec2::Zero(), 2.9, RandomWalk(0.1), random);
  for (ToyRobot& robot : swarm) {
    robot.devices = kToyDevices | Device::kRangeAndBearing | Device::kMotorGround;
    robot.radio_range = 1.0;  // as the foraging scenario's
    robot.bodies_block_radio = false;
  }
  ToyScenario scenario(test_case, std::move(swarm), ticks);
  return Cost([&] { Simulate(scenario, 1, false, {.physics = physics}); });
}

// The default flock in the empty arena and in seven courses, per 200 s.
double FlockingCost(PhysicsKind physics) {
  const controllers::ScenarioInfo& scenario = *controllers::FindScenario("flocking");
  double cost = 0.0;
  double seconds = 0.0;
  for (std::uint64_t number = 0; number < 8; ++number) {
    RunSpec spec;
    spec.scenario = "flocking";
    spec.scenario_parameters = controllers::ResolveParameters(scenario.parameters, {}).value();
    spec.controller = "flocking";
    spec.controller_parameters =
        controllers::ResolveParameters(controllers::FindController("flocking")->parameters, {}).value();
    RandomStream random(1, StreamPurpose::kTest, static_cast<std::uint32_t>(number));
    for (std::uint64_t i = 0; i < number; ++i) {
      const double x = random.Uniform(-2.5, 1.5);
      const double y = random.Uniform(-2.5, 1.5);
      const double length = random.Uniform(0.4, 1.0);
      spec.test_case.obstacles.push_back({x, y, length, 0.2, random.Uniform(0.0, 360.0)});
    }
    spec.seed = number;
    spec.physics = physics;
    RunResult result;
    cost += Cost([&] { result = worker::Run(spec); });
    seconds += result.ticks * kTickSeconds;
  }
  return cost * 200.0 / seconds;
}

// Robots walking at random; floor area and obstacles per robot as with 11 robots in 6 m x 6 m among 8.
double RunCost(int robots, Tick ticks, PhysicsKind physics) {
  RandomStream random(7, StreamPurpose::kTest);
  TestCase test_case;
  const double scale = std::sqrt(std::max(robots, 11) / 11.0);
  test_case.side_x = test_case.side_y = 6.0 * scale;
  test_case.obstacles = RandomObstacles(std::max(robots, 11) * 8 / 11, random);
  for (ObstacleGene& gene : test_case.obstacles) {
    gene.x *= scale;
    gene.y *= scale;
  }
  ToyScenario scenario(
      test_case, RandomRobots(robots, test_case, Vec2::Zero(), 2.9 * scale, RandomWalk(0.1), random), ticks);
  return Cost([&] { Simulate(scenario, 1, false, {.physics = physics}); });
}

// Square roots and divisions in a chain and memory that fits the first cache: what a tick is made of.
double CalibrationCost() {
  [[maybe_unused]] static volatile double sink = 0.0;
  return Cost([] {
    std::array<double, 1024> values;
    values.fill(1.0);
    for (int pass = 0; pass < 400; ++pass) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] =
            std::sqrt(values[i] * values[(i * 7 + 1) % 1024] + 2.0) / (1.0 + values[(i * 5 + 3) % 1024]);
      }
    }
    sink = values[17];
  });
}

double KernelsPerRun() {
  std::vector<double> ratios;
  for (int repeat = 0; repeat < 41; ++repeat) {
    const double before = CalibrationCost();
    const double run = RunCost(11, 500, PhysicsKind::kBox2d);
    ratios.push_back(2.0 * run / (before + CalibrationCost()));
  }
  return Median(ratios);
}

int Guard(const char* baseline_file) {
  double baseline = 0.0;
  if (!(std::ifstream(baseline_file) >> baseline) || !(baseline > 0.0)) {
    std::fprintf(stderr, "%s: a positive number is expected\n", baseline_file);
    return 2;
  }
  // A third of a second each: what disturbs one has passed by the tenth, a slower simulation is slower in
  // all.
  double ratio = KernelsPerRun();
  for (int round = 1; round < 10 && ratio > 1.2 * baseline; ++round) ratio = std::min(ratio, KernelsPerRun());
  std::printf("50 s of 11 robots cost %.3f calibration kernels; baseline %.3f: %+.0f %%\n", ratio, baseline,
              100.0 * (ratio / baseline - 1.0));
  if (ratio <= 1.2 * baseline) return 0;
  std::printf("slower than the baseline by more than 20 %%\n");
  return 1;
}

template <typename CostWith>
void ReportRun(const char* name, double limit, const CostWith& cost_with) {
  std::vector<double> box2d;
  std::vector<double> relaxation;
  std::vector<double> ratios;
  for (int repeat = 0; repeat < 5; ++repeat) {
    box2d.push_back(cost_with(PhysicsKind::kBox2d));
    relaxation.push_back(cost_with(PhysicsKind::kRelaxation));
    ratios.push_back(box2d.back() / relaxation.back());
  }
  std::printf("%-32s  %6.1f  %10.1f  %5.2f  %9.0f\n", name, 1e3 * Median(box2d), 1e3 * Median(relaxation),
              Median(ratios), limit);
}

void ReportRuns() {
  std::printf("%-32s  %6s  %10s  %5s  %9s  (user CPU, ms, medians)\n", "run", "box2d", "relaxation", "ratio",
              "wanted");
  ReportRun("flocking, 200 s x 11", 15, FlockingCost);
  ReportRun("foraging-like, 800 s x 20", 120,
            [](PhysicsKind physics) { return ForagingLikeCost(20, 8000, physics); });
  ReportRun("partitioning-like, 800 s x 6", 30,
            [](PhysicsKind physics) { return ForagingLikeCost(6, 8000, physics); });
  std::printf("\n");
}

struct Point {
  int robots;
  double box2d;  // ns per robot-tick
  double relaxation;
};

std::vector<Point> Measure() {
  std::vector<Point> points;
  std::printf("robots  box2d  relaxation  ratio   (user CPU, ns per robot-tick, medians)\n");
  for (const int robots : kSwarms) {
    const Tick ticks = std::max(100, 20000 / robots);
    std::vector<double> box2d;
    std::vector<double> relaxation;
    std::vector<double> ratios;
    for (int repeat = 0; repeat < 7; ++repeat) {
      box2d.push_back(RunCost(robots, ticks, PhysicsKind::kBox2d));
      relaxation.push_back(RunCost(robots, ticks, PhysicsKind::kRelaxation));
      ratios.push_back(box2d.back() / relaxation.back());
    }
    const double unit = 1e9 / (static_cast<double>(robots) * ticks);
    points.push_back({robots, unit * Median(box2d), unit * Median(relaxation)});
    std::printf("%6d  %5.0f  %10.0f  %5.2f\n", robots, points.back().box2d, points.back().relaxation,
                Median(ratios));
  }
  return points;
}

void WriteSvg(const std::vector<Point>& points, const std::string& file) {
  double top = 0.0;
  for (const Point& point : points) top = std::max({top, point.box2d, point.relaxation});
  const auto place = [top](int robots, double cost) -> analysis::Pixel {
    return {60.0 + 420.0 * std::log(robots / 6.0) / std::log(500.0 / 6.0), 260.0 - 200.0 * cost / top};
  };
  analysis::SvgCanvas canvas(520.0, 310.0, "User CPU per robot-tick", "text { font: 12px sans-serif }");
  canvas.Text({60.0, 20.0}, "user CPU per robot-tick, ns (box2d solid, relaxation dashed)", "");
  canvas.Polyline({{60.0, 40.0}, {60.0, 260.0}, {480.0, 260.0}}, "fill=\"none\" stroke=\"black\"");
  std::vector<analysis::Pixel> box2d;
  std::vector<analysis::Pixel> relaxation;
  for (const Point& point : points) {
    box2d.push_back(place(point.robots, point.box2d));
    relaxation.push_back(place(point.robots, point.relaxation));
    const analysis::Pixel label = {box2d.back().x, box2d.back().y - 6.0};
    canvas.Text(label, std::to_string(std::lround(point.box2d)), "text-anchor=\"middle\"");
    canvas.Text({label.x, 276.0}, std::to_string(point.robots), "text-anchor=\"middle\"");
  }
  canvas.Polyline(box2d, "fill=\"none\" stroke=\"#1f5f99\" stroke-width=\"2\"");
  canvas.Polyline(relaxation, "fill=\"none\" stroke=\"#1f5f99\" stroke-width=\"2\" stroke-dasharray=\"5 4\"");
  canvas.Text({270.0, 298.0}, "robots, in proportionally larger arenas", "text-anchor=\"middle\"");
  std::ofstream(file) << canvas.Take();
  std::printf("plot: %s\n", file.c_str());
}

}  // namespace
}  // namespace gauntlet::sim

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "--guard") == 0) return gauntlet::sim::Guard(argv[2]);
  const bool svg = argc == 3 && std::strcmp(argv[1], "--svg") == 0;
  if (argc != 1 && !svg) {
    std::fprintf(stderr, "usage: speed_report [--svg FILE | --guard BASELINE]\n");
    return 2;
  }
  gauntlet::sim::ReportRuns();
  const auto points = gauntlet::sim::Measure();
  if (svg) gauntlet::sim::WriteSvg(points, argv[2]);
  return 0;
}
