// What requirements say of a moment: one row for each measure, with its unit and its range, by which
// robustness is scaled.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/requirements/sentences.h"
#include "sim/arena/arena.h"
#include "sim/observer.h"

namespace gauntlet::controllers::requirements {

// A run that is over.
struct Trace {
  const sim::Observer& observer;
  const sim::Arena& arena;
  std::vector<sim::RobotIndex> robots;    // under test, one at least
  sim::Vec2 start;                        // m
  sim::Vec2 goal;                         // m
  sim::Tick tick_limit = 0;               // of the run
  sim::Tick step = sim::kTicksPerSecond;  // between two samples

  std::size_t samples() const { return static_cast<std::size_t>(observer.last_tick() / step) + 1; }
  sim::Tick TickOf(std::size_t sample) const { return static_cast<sim::Tick>(sample) * step; }
};

struct Range {
  double low = 0.0;
  double high = 0.0;
};

enum class Argument { kNone, kPlace, kLinkRange };

struct MeasureRow {
  std::string_view name;
  std::string_view unit;
  bool per_robot = false;  // stands within count, least, greatest or mean
  Argument argument = Argument::kNone;
  bool each_second_only = false;
  std::string_view range;  // in words
  std::string_view description;
  Range (*range_of)(const Trace& trace) = nullptr;
  // One value for each sample, or of `per_robot` one for each robot of each sample.
  std::vector<double> (*measure)(const Trace& trace, const Node& node) = nullptr;
};
std::span<const MeasureRow> MeasureRows();

// Of a metric, by its unit: "yes/no" 0 to 1, "m" the arena's diagonal either way, "m^2" its area, "s" 0 to
// the longest that a run may last, "m/s" 0 to a robot's greatest speed, "rad" -pi to pi, else 0 to the number
// of robots.
Range RangeOf(const MetricInfo& metric, const Trace& trace);

}  // namespace gauntlet::controllers::requirements
