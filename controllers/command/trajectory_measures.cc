#include "controllers/command/trajectory_measures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "controllers/generic/measures.h"
#include "controllers/parameters.h"
#include "sim/arena/arena.h"

namespace gauntlet::controllers::command {
namespace {

// Those that need more: bodies, and items.
constexpr std::array<std::string_view, 5> kOthers = {"collisions", "items_taken", "items_brought",
                                                     "first_item_time", "reached_time"};

generic::MeasureSettings SettingsFor(const Definition& definition, std::size_t robots) {
  generic::MeasureSettings settings{.robots = static_cast<int>(robots),
                                    .goal_radius = 0.5,
                                    .link_range = 0.5,
                                    .trapped_window = ToTicks(60.0),
                                    .trapped_radius = 0.1};
  if (!definition.points.empty()) settings.goal = {definition.points.back().x, definition.points.back().y};
  return settings;
}

}  // namespace

const std::vector<std::string>& TrajectoryMeasureNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const MetricInfo& metric : generic::Metrics()) {
      if (std::ranges::count(kOthers, metric.name) == 0) all.push_back(metric.name);
    }
    return all;
  }();
  return names;
}

sim::Observer ObserverOf(std::span<const std::vector<sim::RobotState>> trajectory) {
  const std::size_t robots = trajectory.front().size();
  sim::Observer observer(static_cast<int>(robots), static_cast<sim::Tick>(trajectory.size()));
  std::vector<sim::RobotState> states(robots);
  for (std::size_t tick = 0; tick < trajectory.size(); ++tick) {
    states = trajectory[tick];
    // Over a second, for programs may tell no more often than that where their robots are.
    const std::size_t before = tick - std::min(tick, static_cast<std::size_t>(sim::kTicksPerSecond));
    for (std::size_t i = 0; tick > 0 && i < robots; ++i) {
      const sim::Vec2 step = states[i].position() - trajectory[before][i].position();
      states[i].speed =
          std::sqrt(step.squaredNorm()) / (static_cast<double>(tick - before) * sim::kTickSeconds);
    }
    observer.Record(states);
  }
  return observer;
}

std::map<std::string, double> TrajectoryMeasures(const Definition& definition, const sim::RunSpec& spec,
                                                 std::span<const std::vector<sim::RobotState>> trajectory) {
  const std::size_t robots = trajectory.front().size();
  const sim::Arena arena(spec.test_case);
  generic::Measures measures(arena, SettingsFor(definition, robots));
  const sim::Observer whole = ObserverOf(trajectory);
  sim::Observer observer(static_cast<int>(robots), static_cast<sim::Tick>(trajectory.size()));
  for (sim::Tick tick = 0; tick <= whole.last_tick(); ++tick) {
    observer.Record(whole.At(tick));
    measures.Add(observer);
  }
  const std::vector<double> values = measures.Values(observer, {}, -1);
  std::map<std::string, double> by_name;
  for (std::size_t i = 0; i < values.size(); ++i) by_name[generic::Metrics()[i].name] = values[i];
  return by_name;
}

}  // namespace gauntlet::controllers::command
