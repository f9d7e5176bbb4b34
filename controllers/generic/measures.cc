#include "controllers/generic/measures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "controllers/common/nest_and_food.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::generic {
namespace {

using sim::Vec2;

constexpr double kCell = 0.25;  // m, side of the squares that make the covered area: about a robot and a half

// In the order of Measures::Look.
const std::array<MetricInfo, kMoments> kMomentInfos = {{
    {"center_x", "m", {}, "where the swarm's centre is, from the arena's centre", true},
    {"center_y", "m", {}, "where the swarm's centre is, from the arena's centre", true},
    {"goal_distance", "m", {}, "distance of the swarm's centre from the goal", true},
    {"robots_in_goal", "", {}, "robots whose centres are within goal_radius of the goal"},
    {"largest_cluster",
     "",
     {},
     "robots in the largest cluster: linked over link_range and line of sight",
     true},
    {"clusters", "", {}, "clusters, lone robots among them"},
    {"dispersion", "m", {}, "mean distance of the robots from the swarm's centre", true},
    {"order", "", {}, "length of the mean heading vector: 1 = all head in one direction, near 0 = in all"},
    {"speed", "m/s", {}, "mean speed of the robots"},
}};

const std::vector<MetricInfo> kWholeInfos = {
    {"displacement", "m", {}, "mean distance of a robot's end from its start", true},
    {"path_length", "m", {}, "mean length of a robot's trajectory"},
    {"covered_area", "m^2", {}, "squares of 0.25 m that a robot's centre was in", true},
    {"collisions", "", {}, "times that a robot began to touch a robot, an obstacle or a wall"},
    {"trapped", "", {}, "robots that kept within trapped_radius for the last trapped_window", true},
    {"items_taken", "", {}, "items that robots took from a source"},
    {"items_brought", "", {}, "items that robots laid down in a nest"},
    {"first_item_time", "s", kNotMeasured, "when the first item was laid down in a nest"},
    {"reached_time", "s", kNotMeasured, "when the formula 'reached' first was true"},
};

// In squares that the robots' centres were in at a tick, m^2.
double CoveredArea(const sim::Observer& observer) {
  using Cell = std::pair<int, int>;
  std::set<Cell> cells;
  for (std::size_t robot = 0; robot < observer.Latest().size(); ++robot) {
    std::optional<Cell> last;  // robots stay in one for many ticks
    for (sim::Tick tick = 0; tick <= observer.last_tick(); ++tick) {
      const sim::RobotState& state = observer.At(tick)[robot];
      const Cell cell(static_cast<int>(std::floor(state.x / kCell)),
                      static_cast<int>(std::floor(state.y / kCell)));
      if (cell != last) cells.insert(cell);
      last = cell;
    }
  }
  return static_cast<double>(cells.size()) * kCell * kCell;
}

double Displacement(const sim::Observer& observer) {
  double sum = 0.0;
  for (std::size_t i = 0; i < observer.Latest().size(); ++i)
    sum += std::sqrt((observer.Latest()[i].position() - observer.At(0)[i].position()).squaredNorm());
  return sum / observer.robots();
}

double PathLength(const sim::Observer& observer) {
  double sum = 0.0;
  for (sim::Tick tick = 1; tick <= observer.last_tick(); ++tick) {
    for (const sim::RobotState& robot : observer.At(tick)) sum += robot.speed * sim::kTickSeconds;
  }
  return sum / observer.robots();
}

double SecondsOf(sim::Tick tick) {
  return tick < 0 ? kNotMeasured : tick * sim::kTickSeconds;
}

}  // namespace

const std::vector<MetricInfo>& Metrics() {
  static const std::vector<MetricInfo> metrics = [] {
    std::vector<MetricInfo> all;
    for (const MetricInfo& info : kMomentInfos) {
      all.push_back({info.name, info.unit, {}, info.description + ", at the end", info.descriptor});
      for (const auto& [suffix, what] :
           {std::pair{"_mean", "mean"}, {"_min", "least"}, {"_max", "largest"}}) {
        all.push_back({info.name + suffix, info.unit, {}, info.name + ", " + what + " of all seconds"});
      }
    }
    all.insert(all.end(), kWholeInfos.begin(), kWholeInfos.end());
    return all;
  }();
  return metrics;
}

const std::vector<std::string>& NamesAtTheEnd() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"robots", "time"};
    for (const MetricInfo& metric : Metrics()) all.emplace_back(metric.name);
    return all;
  }();
  return names;
}

const std::vector<std::string>& NamesAtAMoment() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"robots", "time", "items_brought"};
    for (const MetricInfo& info : kMomentInfos) all.emplace_back(info.name);
    return all;
  }();
  return names;
}

Measures::Measures(const sim::Arena& arena, const MeasureSettings& settings)
    : arena_(arena), settings_(settings), contacts_(arena, settings.robots) {}

Moment Measures::Look(const sim::Observer& observer) {
  const auto count = static_cast<double>(observer.robots());
  places_.clear();
  Vec2 center = Vec2::Zero();
  Vec2 headings = Vec2::Zero();
  double speed = 0.0;
  double in_goal = 0.0;
  for (const sim::RobotState& robot : observer.Latest()) {
    places_.push_back(robot.position());
    center += robot.position() / count;
    const sim::SinCos heading = sim::SineCosine(robot.heading);
    headings += Vec2(heading.cos, heading.sin) / count;
    speed += robot.speed / count;
    if ((robot.position() - settings_.goal).squaredNorm() <= settings_.goal_radius * settings_.goal_radius)
      in_goal += 1.0;
  }
  double dispersion = 0.0;
  for (const Vec2& place : places_) dispersion += std::sqrt((place - center).squaredNorm()) / count;
  const std::span<const int> sizes =
      clusters_.SizesOf(places_, arena_, settings_.link_range, observer.ObstaclesAt(observer.last_tick()));
  return {center.x(),
          center.y(),
          std::sqrt((center - settings_.goal).squaredNorm()),
          in_goal,
          static_cast<double>(std::ranges::max(sizes)),
          static_cast<double>(sizes.size()),
          dispersion,
          std::sqrt(headings.squaredNorm()),
          speed};
}

bool Measures::Add(const sim::Observer& observer) {
  contacts_.Add(observer);
  if (observer.last_tick() % sim::kTicksPerSecond != 0) return false;
  moment_ = Look(observer);
  for (std::size_t i = 0; i < kMoments; ++i) {
    sum_[i] += moment_[i];
    min_[i] = seconds_ == 0 ? moment_[i] : std::min(min_[i], moment_[i]);
    max_[i] = seconds_ == 0 ? moment_[i] : std::max(max_[i], moment_[i]);
  }
  ++seconds_;
  return true;
}

std::vector<double> Measures::Values(const sim::Observer& observer, const ItemCount& items,
                                     sim::Tick reached) {
  const Moment end = Look(observer);
  std::vector<double> values;
  for (std::size_t i = 0; i < kMoments; ++i)
    values.insert(values.end(), {end[i], sum_[i] / seconds_, min_[i], max_[i]});
  const auto is_trapped = [](sim::Tick since) { return since >= 0; };
  const double trapped = static_cast<double>(std::ranges::count_if(TrappedSince(observer), is_trapped));
  values.insert(values.end(),
                {Displacement(observer), PathLength(observer), CoveredArea(observer),
                 static_cast<double>(contacts_.begun()), trapped, static_cast<double>(items.taken),
                 static_cast<double>(items.brought), SecondsOf(items.first), SecondsOf(reached)});
  return values;
}

std::vector<sim::Tick> Measures::TrappedSince(const sim::Observer& observer) const {
  std::vector<sim::Tick> since(static_cast<std::size_t>(observer.robots()), -1);
  const sim::Tick first = observer.last_tick() - settings_.trapped_window;
  if (first < 0) return since;
  for (sim::RobotIndex robot = 0; robot < observer.robots(); ++robot) {
    const sim::Tick still = StillSince(observer, robot, settings_.trapped_window, settings_.trapped_radius);
    if (still <= first) since[static_cast<std::size_t>(robot)] = still;
  }
  return since;
}

}  // namespace gauntlet::controllers::generic
