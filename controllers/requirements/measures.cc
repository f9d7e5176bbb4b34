#include "controllers/requirements/measures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "controllers/common/clusters.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::requirements {
namespace {

using sim::RobotState;
using sim::Vec2;

double Diagonal(const Trace& trace) {
  return std::sqrt((trace.arena.interior_max() - trace.arena.interior_min()).squaredNorm());
}

double Count(const Trace& trace) {
  return static_cast<double>(trace.robots.size());
}

Range Along(const Trace& trace, int axis) {
  return {trace.arena.interior_min()[axis], trace.arena.interior_max()[axis]};
}

Range Distances(const Trace& trace) {
  return {0.0, Diagonal(trace)};
}

Range Speeds(const Trace& /*trace*/) {
  return {0.0, sim::foot_bot::kMaxWheelSpeed};
}

// Calls `at` with each sample's states of all robots, those that are not under test among them.
template <typename At>
void ForSamples(const Trace& trace, const At& at) {
  for (std::size_t sample = 0; sample < trace.samples(); ++sample)
    at(sample, trace.observer.At(trace.TickOf(sample)));
}

// of(state, sample) of each robot in each sample.
template <typename Of>
std::vector<double> OfEach(const Trace& trace, const Of& of) {
  std::vector<double> values;
  values.reserve(trace.samples() * trace.robots.size());
  ForSamples(trace, [&](std::size_t sample, std::span<const RobotState> states) {
    for (const sim::RobotIndex robot : trace.robots)
      values.push_back(of(states[static_cast<std::size_t>(robot)], sample));
  });
  return values;
}

// The mean of of(state) over the robots in each sample.
template <typename Mean, typename Of>
std::vector<Mean> MeanOf(const Trace& trace, const Mean& zero, const Of& of) {
  std::vector<Mean> means;
  means.reserve(trace.samples());
  ForSamples(trace, [&](std::size_t /*sample*/, std::span<const RobotState> states) {
    Mean sum = zero;
    for (const sim::RobotIndex robot : trace.robots) sum += of(states[static_cast<std::size_t>(robot)]);
    means.push_back(sum / Count(trace));
  });
  return means;
}

std::vector<Vec2> Centers(const Trace& trace) {
  return MeanOf(trace, Vec2(Vec2::Zero()), [](const RobotState& state) { return state.position(); });
}

std::vector<double> CenterAlong(const Trace& trace, int axis) {
  std::vector<double> values;
  for (const Vec2& center : Centers(trace)) values.push_back(center[axis]);
  return values;
}

double Distance(const Vec2& a, const Vec2& b) {
  return std::sqrt((a - b).squaredNorm());
}

Vec2 PlaceOf(const Trace& trace, const Node& node) {
  if (node.place == Place::kGoal) return trace.goal;
  return node.place == Place::kStart ? trace.start : node.point;
}

std::vector<double> RobotDistances(const Trace& trace, const Node& node) {
  if (node.place != Place::kCenter) {
    const Vec2 place = PlaceOf(trace, node);
    return OfEach(trace,
                  [&](const RobotState& state, std::size_t) { return Distance(state.position(), place); });
  }
  const std::vector<Vec2> centers = Centers(trace);
  return OfEach(trace, [&](const RobotState& state, std::size_t sample) {
    return Distance(state.position(), centers[sample]);
  });
}

std::vector<double> CenterDistances(const Trace& trace, const Node& node) {
  std::vector<double> values;
  const Vec2 place = PlaceOf(trace, node);
  for (const Vec2& center : Centers(trace))
    values.push_back(node.place == Place::kCenter ? 0.0 : Distance(center, place));
  return values;
}

// From each robot to the one under test that is nearest; the arena's diagonal of one that is alone.
std::vector<double> Nearest(const Trace& trace, const Node& /*node*/) {
  std::vector<double> values;
  const double alone = Diagonal(trace);
  ForSamples(trace, [&](std::size_t /*sample*/, std::span<const RobotState> states) {
    for (const sim::RobotIndex robot : trace.robots) {
      double nearest = alone;
      for (const sim::RobotIndex other : trace.robots) {
        if (other == robot) continue;
        nearest = std::min(nearest, Distance(states[static_cast<std::size_t>(robot)].position(),
                                             states[static_cast<std::size_t>(other)].position()));
      }
      values.push_back(nearest);
    }
  });
  return values;
}

std::vector<double> Dispersion(const Trace& trace, const Node& /*node*/) {
  std::vector<double> values;
  const std::vector<Vec2> centers = Centers(trace);
  ForSamples(trace, [&](std::size_t sample, std::span<const RobotState> states) {
    double sum = 0.0;
    for (const sim::RobotIndex robot : trace.robots)
      sum += Distance(states[static_cast<std::size_t>(robot)].position(), centers[sample]);
    values.push_back(sum / Count(trace));
  });
  return values;
}

std::vector<double> Order(const Trace& trace, const Node& /*node*/) {
  std::vector<double> values;
  const auto heading = [](const RobotState& state) -> Vec2 {
    const sim::SinCos direction = sim::SineCosine(state.heading);
    return {direction.cos, direction.sin};
  };
  for (const Vec2& mean : MeanOf(trace, Vec2(Vec2::Zero()), heading))
    values.push_back(std::sqrt(mean.squaredNorm()));
  return values;
}

// `of` the sizes of the clusters of each sample.
template <typename Of>
std::vector<double> OfClusters(const Trace& trace, const Node& node, const Of& of) {
  std::vector<double> values;
  std::vector<Vec2> places(trace.robots.size());
  Clusters clusters;
  ForSamples(trace, [&](std::size_t sample, std::span<const RobotState> states) {
    std::ranges::transform(trace.robots, places.begin(), [&](sim::RobotIndex robot) {
      return states[static_cast<std::size_t>(robot)].position();
    });
    values.push_back(static_cast<double>(of(clusters.SizesOf(
        places, trace.arena, node.number, trace.observer.ObstaclesAt(trace.TickOf(sample))))));
  });
  return values;
}

constexpr std::array kRows = {
    MeasureRow{"time", "s", false, Argument::kNone, false, "0 to the longest that a run may last",
               "since the run began",
               [](const Trace& trace) {
                 return Range{0.0, trace.tick_limit * sim::kTickSeconds};
               },
               [](const Trace& trace, const Node&) {
                 std::vector<double> values;
                 for (std::size_t sample = 0; sample < trace.samples(); ++sample)
                   values.push_back(trace.TickOf(sample) * sim::kTickSeconds);
                 return values;
               }},
    MeasureRow{
        "robots", "", false, Argument::kNone, false, "0 to the number of robots",
        "number of robots under test",
        [](const Trace& trace) {
          return Range{0.0, Count(trace)};
        },
        [](const Trace& trace, const Node&) { return std::vector<double>(trace.samples(), Count(trace)); }},
    MeasureRow{"center_x", "m", false, Argument::kNone, false, "between the arena's walls",
               "where the swarm's centre is", [](const Trace& trace) { return Along(trace, 0); },
               [](const Trace& trace, const Node&) { return CenterAlong(trace, 0); }},
    MeasureRow{"center_y", "m", false, Argument::kNone, false, "between the arena's walls",
               "where the swarm's centre is", [](const Trace& trace) { return Along(trace, 1); },
               [](const Trace& trace, const Node&) { return CenterAlong(trace, 1); }},
    MeasureRow{"distance_to", "m", false, Argument::kPlace, false, "0 to the arena's diagonal",
               "of the swarm's centre from (goal), (start) or (X, Y)", Distances, CenterDistances},
    MeasureRow{"dispersion", "m", false, Argument::kNone, false, "0 to the arena's diagonal",
               "mean distance of the robots from the swarm's centre", Distances, Dispersion},
    MeasureRow{"order", "", false, Argument::kNone, false, "0 to 1",
               "length of the mean heading vector: 1 = all head in one direction",
               [](const Trace&) {
                 return Range{0.0, 1.0};
               },
               Order},
    MeasureRow{"speed", "m/s", false, Argument::kNone, false, "0 to a robot's greatest",
               "mean speed of the robots", Speeds,
               [](const Trace& trace, const Node&) {
                 return MeanOf(trace, 0.0, [](const RobotState& state) { return state.speed; });
               }},
    MeasureRow{"largest_cluster", "", false, Argument::kLinkRange, true, "0 to the number of robots",
               "robots in the largest cluster: linked over less than (RANGE) m and line of sight",
               [](const Trace& trace) {
                 return Range{0.0, Count(trace)};
               },
               [](const Trace& trace, const Node& node) {
                 return OfClusters(trace, node,
                                   [](std::span<const int> sizes) { return std::ranges::max(sizes); });
               }},
    MeasureRow{"clusters", "", false, Argument::kLinkRange, true, "0 to the number of robots",
               "clusters, lone robots among them",
               [](const Trace& trace) {
                 return Range{0.0, Count(trace)};
               },
               [](const Trace& trace, const Node& node) {
                 return OfClusters(trace, node, [](std::span<const int> sizes) { return sizes.size(); });
               }},
    MeasureRow{"x", "m", true, Argument::kNone, false, "between the arena's walls", "where the robot is",
               [](const Trace& trace) { return Along(trace, 0); },
               [](const Trace& trace, const Node&) {
                 return OfEach(trace, [](const RobotState& state, std::size_t) { return state.x; });
               }},
    MeasureRow{"y", "m", true, Argument::kNone, false, "between the arena's walls", "where the robot is",
               [](const Trace& trace) { return Along(trace, 1); },
               [](const Trace& trace, const Node&) {
                 return OfEach(trace, [](const RobotState& state, std::size_t) { return state.y; });
               }},
    MeasureRow{"speed", "m/s", true, Argument::kNone, false, "0 to a robot's greatest", "of the robot",
               Speeds,
               [](const Trace& trace, const Node&) {
                 return OfEach(trace, [](const RobotState& state, std::size_t) { return state.speed; });
               }},
    MeasureRow{"distance_to", "m", true, Argument::kPlace, false, "0 to the arena's diagonal",
               "of the robot from (goal), (start), (center) or (X, Y)", Distances, RobotDistances},
    MeasureRow{"nearest", "m", true, Argument::kNone, false, "0 to the arena's diagonal",
               "distance from the robot to the nearest other one", Distances, Nearest},
};

}  // namespace

std::span<const MeasureRow> MeasureRows() {
  return kRows;
}

Range RangeOf(const MetricInfo& metric, const Trace& trace) {
  const double diagonal = Diagonal(trace);
  const Vec2 sides = trace.arena.interior_max() - trace.arena.interior_min();
  if (metric.unit == "yes/no") return {0.0, 1.0};
  if (metric.unit == "m") return {-diagonal, diagonal};
  if (metric.unit == "m^2") return {0.0, sides.x() * sides.y()};
  if (metric.unit == "s") return {0.0, trace.tick_limit * sim::kTickSeconds};
  if (metric.unit == "m/s") return Speeds(trace);
  if (metric.unit == "rad") return {-sim::kPi, sim::kPi};
  return {0.0, Count(trace)};
}

}  // namespace gauntlet::controllers::requirements
