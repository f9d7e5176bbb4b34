#include "search/experiment/genome_ranges.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

namespace gauntlet {
namespace {

// Slack for ranges whose ends are grid points that binary fractions miss by a rounding error.
constexpr double kGridSlack = 1e-6;

struct Range {
  std::string_view name;  // keys NAME_min and NAME_max
  double min;
  double max;
};

constexpr std::string_view kSpeed = "genome.speed";

std::vector<Range> RangesOf(const GenomeSpec& spec) {
  std::vector<Range> ranges = {{"genome.position", spec.position_min, spec.position_max}};
  if (spec.places) {
    const auto& [min, max] = *spec.places;
    ranges = {{"arena.x", min.x(), max.x()}, {"arena.y", min.y(), max.y()}};
  }
  ranges.push_back({"genome.length", spec.length_min, spec.length_max});
  ranges.push_back({"genome.width", spec.width_min, spec.width_max});
  ranges.push_back({kSpeed, spec.speed_min, spec.speed_max});
  return ranges;
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
      return InvalidInput(
          fmt::format("{0}_min = {1} must not exceed {0}_max = {2}", range.name, range.min, range.max));
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
    if (range.name == kSpeed) continue;  // has a grid of its own
    const GridRange grid = GridOf(range.min, range.max, spec.step);
    if (grid.first > grid.last) {
      return InvalidInput(fmt::format("{0}_min = {1} to {0}_max = {2} holds no multiple of genome.step = {3}",
                                      range.name, range.min, range.max, spec.step));
    }
  }
  return Ok{};
}

}  // namespace gauntlet
