// Prints why runs of the VP algorithm have no path of beacons (controllers/foraging/README.md): where beacons
// were missing, and whether robots had left the beacons' cover before they saw the food; and what trapped
// robots did. Empty arena and random cases only.
//
//   foraging_paths [cases=200] [seeds=100] [threads=2] [a parameter=value ...]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "controllers/foraging/beacon_chain.h"
#include "controllers/foraging/foraging_registry.h"
#include "controllers/registry.h"
#include "sim/arena/arena.h"
#include "tests/controllers/calibration_support.h"

namespace gauntlet {
namespace {

using controllers::ForagingSettings;
using controllers::ForagingState;

// What a robot did in every second, from the annotation "states".
std::vector<std::vector<ForagingState>> StatesOf(const sim::RunResult& result) {
  const auto seconds = static_cast<std::size_t>(result.ticks / sim::kTicksPerSecond) + 1;
  std::vector<std::vector<ForagingState>> states(result.robots.size(), std::vector<ForagingState>(seconds));
  for (const sim::Annotation& annotation : result.annotations) {
    if (annotation.kind != "states") continue;
    auto& line = states[static_cast<std::size_t>(annotation.robots.front())];
    for (const sim::Vec2& change : annotation.points) {
      const auto from = static_cast<std::ptrdiff_t>(change.x() + 0.5);
      std::fill(line.begin() + from, line.end(), static_cast<ForagingState>(change.y()));
    }
  }
  return states;
}

struct Figures {
  int runs = 0;
  int no_path = 0;
  int no_beacon_at_food = 0;  // of the runs without a path
  int not_joined = 0;
  int finders = 0;           // robots that saw the food
  int covered_finders = 0;   // that had two beacons in range, the nest included, in every second until then
  int beacons_at_start = 0;  // made in the first 5 s
  double first_path = 0.0;
  int trapped = 0;
  int trapped_at_beacon = 0;  // that followed a beacon within the time they were trapped
};

class RunReader {
 public:
  RunReader(const sim::RunSpec& spec, const sim::RunResult& result, const ForagingSettings& settings)
      : result_(result),
        arena_(spec.test_case),
        states_(StatesOf(result)),
        nest_(settings.Nest()),
        food_(settings.Food()),
        range_(settings.communication_range) {}

  void AddTo(Figures& figures) const {
    ++figures.runs;
    bool at_food = false;
    for (std::size_t second = 0; second < Seconds(); ++second) {
      for (const sim::Vec2& beacon : BeaconsAt(second, states_.size())) at_food |= Linked(beacon, food_);
    }
    figures.beacons_at_start += static_cast<int>(BeaconsAt(5, states_.size()).size());
    if (calibration::Metric(result_, "condition_1") == 1.0) {
      ++figures.no_path;
      ++(at_food ? figures.not_joined : figures.no_beacon_at_food);
    } else {
      figures.first_path += calibration::Metric(result_, "first_path_time");
    }
    for (std::size_t robot = 0; robot < states_.size(); ++robot) AddFinder(robot, figures);
    for (const sim::Annotation& annotation : result_.annotations) {
      if (annotation.kind != "trapped") continue;
      const auto& line = states_[static_cast<std::size_t>(annotation.robots.front())];
      const auto since = line.begin() + annotation.tick / sim::kTicksPerSecond;
      ++figures.trapped;
      figures.trapped_at_beacon +=
          std::find(since, line.end(), ForagingState::kFollowing) != line.end() ? 1 : 0;
    }
  }

 private:
  std::size_t Seconds() const { return states_.front().size(); }
  sim::Vec2 Place(std::size_t robot, std::size_t second) const {
    return result_.trajectory[second * sim::kTicksPerSecond][robot].position();
  }
  bool Linked(const sim::Vec2& a, const sim::Vec2& b) const {
    return (b - a).norm() < range_ && arena_.LineOfSight(a, b);
  }
  std::vector<sim::Vec2> BeaconsAt(std::size_t second, std::size_t but) const {
    std::vector<sim::Vec2> beacons;
    for (std::size_t robot = 0; robot < states_.size(); ++robot) {
      if (robot != but && states_[robot][second] == ForagingState::kBeacon) {
        beacons.push_back(Place(robot, second));
      }
    }
    return beacons;
  }
  void AddFinder(std::size_t robot, Figures& figures) const {
    const auto& line = states_[robot];
    const auto found = std::find(line.begin(), line.end(), ForagingState::kGathering);
    if (found == line.end()) return;
    ++figures.finders;
    constexpr std::size_t kStart = 10;  // the first beacons are made by then
    for (std::size_t second = kStart; second < static_cast<std::size_t>(found - line.begin()); ++second) {
      const sim::Vec2 place = Place(robot, second);
      const auto beacons = BeaconsAt(second, robot);
      const auto heard = std::count_if(beacons.begin(), beacons.end(),
                                       [&](const sim::Vec2& beacon) { return Linked(place, beacon); });
      if (heard + (Linked(place, nest_) ? 1 : 0) < 2) return;
    }
    ++figures.covered_finders;
  }

  const sim::RunResult& result_;
  sim::Arena arena_;
  std::vector<std::vector<ForagingState>> states_;
  sim::Vec2 nest_;
  sim::Vec2 food_;
  double range_;
};

void Measure(const char* name, std::vector<sim::RunSpec> specs, int threads,
             const ForagingSettings& settings) {
  constexpr std::size_t kBatch = 20;  // trajectories are large
  Figures figures;
  for (std::size_t begin = 0; begin < specs.size(); begin += kBatch) {
    std::vector<sim::RunSpec> batch(
        specs.begin() + static_cast<std::ptrdiff_t>(begin),
        specs.begin() + static_cast<std::ptrdiff_t>(std::min(begin + kBatch, specs.size())));
    for (sim::RunSpec& spec : batch) spec.record_trajectory = true;
    const std::vector<sim::RunResult> results = calibration::RunAll(batch, threads);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (results[i].verdict == sim::Verdict::kCompleted) {
        RunReader(batch[i], results[i], settings).AddTo(figures);
      }
    }
  }
  std::printf(
      "%-7s runs %d, no path %d: no beacon ever in range of the food %d, one that was never joined %d; first "
      "path at %.0f s; beacons after 5 s %.1f; robots that saw the food %d, %d of them never out of cover; "
      "trapped "
      "at the end %d, %d of them followed a beacon meanwhile\n",
      name, figures.runs, figures.no_path, figures.no_beacon_at_food, figures.not_joined,
      figures.first_path / std::max(1, figures.runs - figures.no_path),
      static_cast<double>(figures.beacons_at_start) / std::max(1, figures.runs), figures.finders,
      figures.covered_finders, figures.trapped, figures.trapped_at_beacon);
}

int Main(int argc, char** argv) {
  std::map<std::string, double> amounts = {{"cases", 200}, {"seeds", 100}, {"threads", 2}};
  sim::RunSpec spec;
  spec.scenario = "foraging";
  spec.controller = "foraging";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) {
      std::fprintf(stderr, "not name=value: %s\n", argv[i]);
      return 2;
    }
    const std::string name = argument.substr(0, equals);
    const double value = std::strtod(argv[i] + equals + 1, nullptr);
    const auto infos = controllers::ForagingParameters().infos();
    if (amounts.contains(name)) {
      amounts[name] = value;
    } else if (std::any_of(infos.begin(), infos.end(), [&](const auto& info) { return info.name == name; })) {
      spec.scenario_parameters[name] = value;
    } else {
      spec.controller_parameters[name] = value;
    }
  }
  const auto parameters =
      controllers::ResolveParameters(controllers::ForagingParameters().infos(), spec.scenario_parameters);
  if (!parameters.ok()) {
    std::fprintf(stderr, "%s\n", parameters.error().message.c_str());
    return 2;
  }
  const ForagingSettings settings = controllers::ForagingParameters().Read(*parameters);
  const auto specs = calibration::MakeSpecs(
      spec, {.seeds = static_cast<int>(amounts["seeds"]), .cases = static_cast<int>(amounts["cases"])});
  const int threads = static_cast<int>(amounts["threads"]);
  Measure("empty", specs.empty, threads, settings);
  Measure("random", specs.random, threads, settings);
  return 0;
}

}  // namespace
}  // namespace gauntlet

int main(int argc, char** argv) {
  return gauntlet::Main(argc, argv);
}
