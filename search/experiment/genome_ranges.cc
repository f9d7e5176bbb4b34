#include "search/experiment/genome_ranges.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

namespace gauntlet {
namespace {

// Slack for ranges whose ends are grid points that binary fractions miss by a rounding error.
constexpr double kGridSlack = 1e-6;

struct Range {
  std::string_view name;
  double min;
  double max;
};

std::array<Range, 4> RangesOf(const GenomeSpec& spec) {
  return {{{"position", spec.position_min, spec.position_max},
           {"length", spec.length_min, spec.length_max},
           {"width", spec.width_min, spec.width_max},
           {"speed", spec.speed_min, spec.speed_max}}};
}

}  // namespace

GridRange GridOf(double min, double max, double step) {
  const double divisions = std::floor(1.0 / step + 0.5);
  return {static_cast<std::int64_t>(std::ceil(min * divisions - kGridSlack)),
          static_cast<std::int64_t>(std::floor(max * divisions + kGridSlack)), divisions};
}

Status CheckGenomeSpec(const GenomeSpec& spec) {
  for (const Range& range : RangesOf(spec)) {
    if (!(range.min <= range.max)) {
      return InvalidInput(fmt::format("genome.{0}_min = {1} must not exceed genome.{0}_max = {2}", range.name,
                                      range.min, range.max));
    }
  }
  if (const GridRange speeds = GridOf(spec.speed_min, spec.speed_max, kSpeedStep);
      speeds.first > speeds.last) {
    return InvalidInput(
        fmt::format("genome.speed_min = {} to genome.speed_max = {} holds no multiple of {} m/s",
                    spec.speed_min, spec.speed_max, kSpeedStep));
  }
  if (spec.step == 0.0) return Ok{};
  const double divisions = 1.0 / spec.step;
  if (!(spec.step > 0.0) || divisions < 1.0 - kGridSlack ||
      std::fabs(divisions - std::floor(divisions + 0.5)) > kGridSlack) {
    return InvalidInput(
        fmt::format("genome.step = {} must be 0 (continuous) or a whole fraction of 1 m, such as 0.1 or 0.05",
                    spec.step));
  }
  for (const Range& range : RangesOf(spec)) {
    if (range.name == "speed") continue;  // has a grid of its own
    const GridRange grid = GridOf(range.min, range.max, spec.step);
    if (grid.first > grid.last) {
      return InvalidInput(
          fmt::format("genome.{0}_min = {1} to genome.{0}_max = {2} holds no multiple of genome.step = {3}",
                      range.name, range.min, range.max, spec.step));
    }
  }
  return Ok{};
}

}  // namespace gauntlet
