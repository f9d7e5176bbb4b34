#include "tests/golden/swarm/swarm_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "analysis/statistics/sample.h"
#include "controllers/examples/light_flocking_metrics.h"
#include "controllers/examples/light_flocking_registry.h"
#include "controllers/examples/light_flocking_scenario.h"
#include "controllers/registry.h"
#include "search/cases/case_file.h"
#include "sim/simulation.h"
#include "tests/golden/swarm/equivalence_test.h"
#include "tests/support/paths.h"

namespace gauntlet::golden {
namespace {

namespace fs = std::filesystem;
using controllers::light_flocking::LightFlockingScenario;

const sim::Vec2 kLight(-2.5, -2.5);
constexpr sim::Tick kStoppedFrom = kLastTick - LightFlockingScenario::kStoppedTicks;
constexpr int kSampleTicks = LightFlockingScenario::kStoppedSampleTicks;

Result<std::map<sim::Tick, std::vector<sim::Pose>>> ReadPoses(const fs::path& path) {
  std::ifstream file(path);
  std::map<sim::Tick, std::vector<sim::Pose>> poses;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    sim::Tick tick = 0;
    std::string robot;
    sim::Pose pose;
    if (!(cells >> tick >> robot >> pose.position.x() >> pose.position.y() >> pose.heading)) {
      return InvalidInput(path.string() + ": not tick,robot,x,y,heading: " + line);
    }
    poses[tick].push_back(pose);
  }
  std::vector<sim::Tick> needed(kDeviationTicks.begin(), kDeviationTicks.end());
  needed.push_back(0);
  for (sim::Tick tick = kStoppedFrom; tick <= kLastTick; tick += kSampleTicks) needed.push_back(tick);
  for (const sim::Tick tick : needed) {
    if (!poses.contains(tick) || poses[tick].size() != poses[0].size()) {
      return InvalidInput(fmt::format("{}: tick {} is missing or incomplete", path.string(), tick));
    }
  }
  return poses;
}

std::vector<sim::Vec2> PositionsOf(const std::vector<sim::Pose>& poses) {
  std::vector<sim::Vec2> positions;
  for (const sim::Pose& pose : poses) positions.push_back(pose.position);
  return positions;
}

Ending EndingOf(const std::map<sim::Tick, std::vector<sim::Pose>>& poses, const sim::Arena& arena,
                double link_range) {
  std::vector<std::vector<sim::Vec2>> late;
  for (sim::Tick tick = kStoppedFrom; tick <= kLastTick; tick += kSampleTicks) {
    late.push_back(PositionsOf(poses.at(tick)));
  }
  return {.light_distance = controllers::light_flocking::MeanDistance(late.back(), kLight),
          .stopped = controllers::light_flocking::ShareStopped(late, LightFlockingScenario::kStopped),
          .clusters = static_cast<double>(
              controllers::light_flocking::CountClusters(late.back(), arena, link_range))};
}

template <typename Table>
auto DefaultsOf(const Table& table) {
  return table.Read(*controllers::ResolveParameters(table.infos(), {}));
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

const std::vector<EndMetric>& EndMetrics() {
  static const std::vector<EndMetric> metrics = {{"distance to the light, m", &Ending::light_distance, 0.25},
                                                 {"stopped, share", &Ending::stopped, 0.10},
                                                 {"clusters", &Ending::clusters, 0.50}};
  return metrics;
}

fs::path LayoutDirectory() {
  const char* given = std::getenv("GAUNTLET_ARGOS_CASES");
  return given != nullptr ? fs::path(given)
                          : fs::path(GAUNTLET_SOURCE_DIR) / "../shared/reference/argos/cases";
}

fs::path RecordedDirectory() {
  return fs::path(GAUNTLET_SOURCE_DIR) / "tests/golden/argos/cases";
}

Result<std::vector<SwarmCase>> LoadSwarmCases(const fs::path& recorded, const fs::path& layouts) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(recorded)) {
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<SwarmCase> cases;
  for (const fs::path& file : files) {
    const std::string name = file.stem().string();
    fs::path layout = layouts / (name + ".argos");
    if (!fs::exists(layout) && name.starts_with("env")) {
      layout = layouts / ("environment" + name.substr(3) + ".argos");
    }
    if (!fs::exists(layout)) {
      return Error{ErrorKind::kNotFound, "no layout of " + name + " in " + layouts.string()};
    }
    auto loaded = LoadCase(layout);
    if (!loaded.ok()) return loaded.error();
    auto poses = ReadPoses(file);
    if (!poses.ok()) return poses.error();
    cases.push_back({.name = name, .test_case = loaded->test_case, .argos = *std::move(poses)});
  }
  if (cases.size() < 2) return InvalidInput("fewer than two cases in " + recorded.string());
  return cases;
}

controllers::ControllerFactory BuiltInFlockers() {
  return controllers::light_flocking::MakeLightFlockers(
      DefaultsOf(controllers::light_flocking::LightFlockingParameters()));
}

CaseComparison Compare(const SwarmCase& swarm_case, const controllers::ControllerFactory& flockers) {
  LightFlockingScenario scenario(swarm_case.test_case,
                                 DefaultsOf(controllers::light_flocking::LightFlockingScenarioParameters()),
                                 flockers, swarm_case.argos.at(0));
  const sim::RunResult run = sim::Simulate(scenario, 0, true);
  GAUNTLET_CHECK(run.verdict == sim::Verdict::kCompleted, swarm_case.name + ": " + run.message);

  std::map<sim::Tick, std::vector<sim::Pose>> ours;
  for (const auto& [tick, poses] : swarm_case.argos) {
    for (const sim::RobotState& state : run.trajectory.at(static_cast<std::size_t>(tick))) {
      ours[tick].push_back({state.position(), state.heading});
    }
  }
  CaseComparison comparison;
  comparison.name = swarm_case.name;
  for (std::size_t i = 0; i < kDeviationTicks.size(); ++i) {
    const std::vector<sim::Pose>& argos_poses = swarm_case.argos.at(kDeviationTicks[i]);
    std::vector<double> distances;
    for (std::size_t robot = 0; robot < argos_poses.size(); ++robot) {
      distances.push_back((ours[kDeviationTicks[i]][robot].position - argos_poses[robot].position).norm());
    }
    comparison.deviation[i] = analysis::Quantile(distances, 0.5);
  }
  const double link_range = flockers.traits.link_range;
  comparison.argos = EndingOf(swarm_case.argos, scenario.arena(), link_range);
  comparison.ours = EndingOf(ours, scenario.arena(), link_range);
  return comparison;
}

Verdict Judge(const std::vector<CaseComparison>& comparisons) {
  Verdict verdict{
      .table =
          "| case | deviation at 1 s, mm | 5 s, mm | 20 s, m | 60 s, m | 200 s, m | light, m "
          "(ARGoS) | stopped (ARGoS) | clusters (ARGoS) |\n|---|---|---|---|---|---|---|---|---|\n",
      .holds = true};
  std::array<std::vector<double>, kDeviationTicks.size()> deviations;
  for (const CaseComparison& c : comparisons) {
    for (std::size_t i = 0; i < deviations.size(); ++i) deviations[i].push_back(c.deviation[i]);
    verdict.table += fmt::format(
        "| {} | {:.3f} | {:.2f} | {:.3f} | {:.3f} | {:.3f} | {:.2f} ({:.2f}) | {:.1f} ({:.1f}) | "
        "{:.0f} ({:.0f}) |\n",
        c.name, c.deviation[0] * 1e3, c.deviation[1] * 1e3, c.deviation[2], c.deviation[3], c.deviation[4],
        c.ours.light_distance, c.argos.light_distance, c.ours.stopped, c.argos.stopped, c.ours.clusters,
        c.argos.clusters);
  }
  verdict.table +=
      fmt::format("| mean | {:.3f} | {:.2f} | {:.3f} | {:.3f} | {:.3f} | | | |\n", Mean(deviations[0]) * 1e3,
                  Mean(deviations[1]) * 1e3, Mean(deviations[2]), Mean(deviations[3]), Mean(deviations[4]));
  verdict.table += "\n| metric | margin | measured | holds |\n|---|---|---|---|\n";
  for (std::size_t i = 0; i < kEarlyDeviation.size(); ++i) {
    const bool holds = Mean(deviations[i]) <= kEarlyDeviation[i];
    verdict.holds = verdict.holds && holds;
    verdict.table +=
        fmt::format("| deviation at {} s | {} m | mean {:.2g} m | {} |\n", kDeviationTicks[i] / 10,
                    kEarlyDeviation[i], Mean(deviations[i]), holds ? "yes" : "NO");
  }
  for (const EndMetric& metric : EndMetrics()) {
    std::vector<double> differences;
    for (const CaseComparison& c : comparisons) {
      differences.push_back(c.ours.*metric.value - c.argos.*metric.value);
    }
    const auto test = analysis::TestEquivalence(differences, metric.margin, kAlpha);
    verdict.holds = verdict.holds && test.equivalent;
    verdict.table += fmt::format(
        "| {} | {:.2f} | mean difference {:+.3f}, sd {:.3f}, 90 % interval {:+.3f} to {:+.3f}, p = {:.2g} | "
        "{} |\n",
        metric.name, metric.margin, test.mean, test.sd, test.interval.low, test.interval.high, test.p,
        test.equivalent ? "yes" : "NO");
  }
  return verdict;
}

}  // namespace gauntlet::golden
