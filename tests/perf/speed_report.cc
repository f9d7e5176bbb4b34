// speed_report [--svg FILE]: what the runs of loads.h cost, in ms, per robot and tick, and in runs of a
// calibration kernel in the same process; where it goes; how the physics engines compare; what a robot-tick
// costs with 6 to 500 robots. User CPU, everything included; medians of interleaved repeats.
// speed_report --rows: one pass over all loads for scripts (pair_builds): name, ms per run, kernels per run.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "tests/perf/cpu_cost.h"
#include "tests/perf/loads.h"
#include "tests/perf/scaling.h"
#include "tests/perf/stage_clock.h"

namespace gauntlet::perf {
namespace {

constexpr int kRepeats = 5;

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

struct Sample {
  double seconds = 0.0;  // per run
  double kernels = 0.0;  // per run
  double robot_ticks = 0.0;
};

// Every run of the load once, each between two kernels.
Sample Measure(const Load& load, sim::PhysicsKind physics = sim::RunSpec{}.physics) {
  Sample sample;
  double kernels = CalibrationCost();
  for (std::uint64_t seed = 1; seed <= load.runs; ++seed) {
    sim::RunResult result;
    sample.seconds += Cost([&] { result = load.run(seed, {.physics = physics}); });
    sample.robot_ticks += static_cast<double>(result.robots.size()) * result.ticks;
    kernels += CalibrationCost();
  }
  const auto runs = static_cast<double>(load.runs);
  sample.seconds /= runs;
  sample.kernels = sample.seconds / (kernels / (runs + 1.0));
  sample.robot_ticks /= runs;
  return sample;
}

std::vector<Load> RunLoads() {
  std::vector<Load> loads = ShippedLoads();
  for (Load& load : ArgosLoads()) loads.push_back(std::move(load));
  return loads;
}

void ReportRuns(const std::vector<Load>& loads) {
  fmt::print("{:<66}{:>8}{:>9}{:>9}\n", "run", "ms", "kernels", "ns/r-t");
  for (const Load& load : loads) {
    std::vector<double> seconds;
    std::vector<double> kernels;
    double robot_ticks = 0.0;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const Sample sample = Measure(load);
      seconds.push_back(sample.seconds);
      kernels.push_back(sample.kernels);
      robot_ticks = sample.robot_ticks;
    }
    fmt::print("{:<66}{:>8.2f}{:>9.2f}{:>9.0f}\n", load.what, 1e3 * Median(seconds), Median(kernels),
               1e9 * Median(seconds) / robot_ticks);
  }
  fmt::print("ns/r-t: per robot and tick\n\n");
}

void ReportRequirements(const Load& required, const Load& plain) {
  std::vector<double> ratios;
  for (int repeat = 0; repeat < 3 * kRepeats; ++repeat)
    ratios.push_back(Measure(required).seconds / Measure(plain).seconds);
  fmt::print("{}: {:.3f} times the cost without\n\n", required.what, Median(ratios));
}

void ReportStages(const std::vector<Load>& loads) {
  std::vector<StageClock> clocks(loads.size());
  fmt::print("{:<38}", "share of the time, %");
  for (std::size_t i = 0; i < loads.size(); ++i) {
    for (std::uint64_t seed = 1; seed <= loads[i].runs; ++seed) {
      loads[i].run(seed, {.probe = &clocks[i]});
      clocks[i].Stop();
    }
    fmt::print("{:>5}", fmt::format("[{}]", i + 1));
  }
  fmt::print("\n");
  for (std::size_t stage = 0; stage < StageClock::kStages; ++stage) {
    std::string line = fmt::format("{:<38}", StageClock::NameOf(stage));
    double largest = 0.0;
    for (const StageClock& clock : clocks) {
      line += fmt::format("{:>5.1f}", 100.0 * clock.ShareOf(stage));
      largest = std::max(largest, clock.ShareOf(stage));
    }
    if (largest > 0.0) fmt::print("{}\n", line);
  }
  for (std::size_t i = 0; i < loads.size(); ++i) fmt::print("[{}] {}\n", i + 1, loads[i].what);
  fmt::print("\n");
}

void ReportEngines(const std::vector<Load>& loads) {
  fmt::print("{:<66}{:>9}{:>7}{:>9}{:>9}\n", "crowd, relative to relaxation on the same scene", "impulse",
             "box2d", "ms", "kernels");
  for (const Load& load : loads) {
    std::vector<double> impulse;
    std::vector<double> box2d;
    std::vector<double> milliseconds;
    std::vector<double> kernels;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const Sample sample = Measure(load, sim::PhysicsKind::kImpulse);
      const double relaxation = Measure(load, sim::PhysicsKind::kRelaxation).seconds;
      impulse.push_back(sample.seconds / relaxation);
      box2d.push_back(Measure(load, sim::PhysicsKind::kBox2d).seconds / relaxation);
      milliseconds.push_back(1e3 * sample.seconds);
      kernels.push_back(sample.kernels);
    }
    fmt::print("{:<66}{:>9.2f}{:>7.2f}{:>9.2f}{:>9.2f}\n", load.what, Median(impulse), Median(box2d),
               Median(milliseconds), Median(kernels));
  }
  fmt::print("\n");
}

int PrintRows() {
  std::vector<Load> loads = RunLoads();
  loads.push_back(CrowdLoads().back());
  for (const Load& load : loads) {
    const Sample sample = Measure(load);
    fmt::print("{} {:.4f} {:.4f}\n", load.name, 1e3 * sample.seconds, sample.kernels);
  }
  return 0;
}

int Report(const std::string& svg_file) {
  const std::vector<Load> loads = RunLoads();
  ReportRuns(loads);
  ReportRequirements(RequiredLoad(), loads[1]);
  ReportStages(loads);
  ReportEngines(CrowdLoads());
  ReportScaling(svg_file);
  return 0;
}

int Main(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return Report("");
  if (arguments.size() == 1 && arguments[0] == "--rows") return PrintRows();
  if (arguments.size() == 2 && arguments[0] == "--svg") return Report(arguments[1]);
  fmt::print(stderr, "usage: speed_report [--svg FILE | --rows]\n");
  return 2;
}

}  // namespace
}  // namespace gauntlet::perf

int main(int argc, char** argv) {
  return gauntlet::perf::Main({argv + 1, argv + argc});
}
