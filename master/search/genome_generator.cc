#include "master/search/genome_generator.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace gauntlet::master {
namespace {

// Grid points of a range, as whole numbers of 1/divisions metres.
struct GridRange {
  std::int64_t first = 0;
  std::int64_t last = -1;
  double divisions = 1.0;  // points per metre
};

// Slack for ranges whose ends are grid points that binary fractions miss by a rounding error.
constexpr double kGridSlack = 1e-6;
constexpr double kSpeedStep = 0.001;  // m/s

GridRange GridOf(double min, double max, double step) {
  const double divisions = std::floor(1.0 / step + 0.5);
  return {static_cast<std::int64_t>(std::ceil(min * divisions - kGridSlack)),
          static_cast<std::int64_t>(std::floor(max * divisions + kGridSlack)), divisions};
}

double Draw(double min, double max, double step, sim::RandomStream& random) {
  if (step == 0.0) return random.Uniform(min, max);
  const GridRange grid = GridOf(min, max, step);
  const auto points = static_cast<std::uint32_t>(grid.last - grid.first + 1);
  // A quotient of whole numbers is the double nearest to the decimal: 3 / 10.0 is 0.3, 3 * 0.1 is not.
  return static_cast<double>(grid.first + static_cast<std::int64_t>(random.Below(points))) / grid.divisions;
}

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

GenomeGenerator::GenomeGenerator(const GenomeSpec& spec, const sim::TestCase& arena_without_obstacles,
                                 const sim::ArenaRequirements& requirements)
    : spec_(spec), arena_(arena_without_obstacles), requirements_(requirements) {
  arena_.obstacles.clear();
  const Status status = CheckGenomeSpec(spec_);
  GAUNTLET_CHECK(status.ok(), status.error().message);
}

sim::ObstacleGene GenomeGenerator::RandomGene(sim::RandomStream& random) const {
  sim::ObstacleGene gene;
  gene.x = Draw(spec_.position_min, spec_.position_max, spec_.step, random);
  gene.y = Draw(spec_.position_min, spec_.position_max, spec_.step, random);
  gene.length = Draw(spec_.length_min, spec_.length_max, spec_.step, random);
  gene.width = Draw(spec_.width_min, spec_.width_max, spec_.step, random);
  gene.orientation_deg = random.Below(360);
  if (spec_.moving > 0.0 && random.Chance(spec_.moving)) SetInMotion(random, gene);
  if (spec_.lights > 0.0 && random.Chance(spec_.lights)) gene.light = spec_.light_color;
  return gene;
}

void GenomeGenerator::SetInMotion(sim::RandomStream& random, sim::ObstacleGene& gene) const {
  gene.speed = Draw(spec_.speed_min, spec_.speed_max, kSpeedStep, random);
  for (int i = 0; i < spec_.waypoints; ++i) {
    const double x = Draw(spec_.position_min, spec_.position_max, spec_.step, random);
    gene.path.emplace_back(x, Draw(spec_.position_min, spec_.position_max, spec_.step, random));
  }
}

std::optional<sim::Genome> GenomeGenerator::TryGenome(sim::RandomStream& random) const {
  sim::IncrementalValidity validity(arena_, requirements_);
  sim::Genome genome;
  while (std::ssize(genome) < spec_.genes) {
    int tries_left = spec_.tries_per_gene;
    sim::ObstacleGene gene;
    do {
      if (tries_left-- == 0) return std::nullopt;
      gene = RandomGene(random);
    } while (validity.TryAppend(gene).has_value());
    genome.push_back(gene);
  }
  return genome;
}

Result<sim::TestCase> GenomeGenerator::RandomTestCase(sim::RandomStream& random) const {
  const sim::IncrementalValidity empty(arena_, requirements_);
  if (const std::optional<sim::Violation>& violation = empty.arena_violation()) {
    return InvalidInput(fmt::format("the arena breaks the rule {} before it has any obstacle: {}",
                                    sim::NameOf(violation->rule), violation->message));
  }
  for (int start = 0; start < kMaxRestarts; ++start) {
    if (std::optional<sim::Genome> genome = TryGenome(random)) return WithObstacles(std::move(*genome));
  }
  return InvalidInput(fmt::format(
      "no valid test case found in {} starts with genome.genes = {}, positions {} to {} m, lengths {} to {} "
      "m, widths {} to {} m in an arena of {} x {} m: use fewer or smaller obstacles",
      kMaxRestarts, spec_.genes, spec_.position_min, spec_.position_max, spec_.length_min, spec_.length_max,
      spec_.width_min, spec_.width_max, arena_.side_x, arena_.side_y));
}

sim::TestCase GenomeGenerator::WithObstacles(sim::Genome genome) const {
  sim::TestCase test_case = arena_;
  test_case.obstacles = std::move(genome);
  return test_case;
}

bool GenomeGenerator::Valid(const sim::Genome& genome) const {
  return !sim::CheckValidity(WithObstacles(genome), requirements_).has_value();
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

std::optional<sim::Violation> CheckGeneRanges(const sim::Genome& genome, const GenomeSpec& spec) {
  struct Field {
    std::string_view name;
    std::string_view unit;
    double sim::ObstacleGene::*value;
    double min;
    double max;
  };
  const std::array<Field, 4> fields = {{
      {"x", " m", &sim::ObstacleGene::x, spec.position_min, spec.position_max},
      {"y", " m", &sim::ObstacleGene::y, spec.position_min, spec.position_max},
      {"length", " m", &sim::ObstacleGene::length, spec.length_min, spec.length_max},
      {"width", " m", &sim::ObstacleGene::width, spec.width_min, spec.width_max},
  }};
  const auto violation = [](std::size_t gene, std::string_view field, double value, std::string_view range) {
    return sim::Violation{sim::ValidityRule::kGeneRange, static_cast<int>(gene),
                          fmt::format("obstacle {}: {} = {} is outside the experiment's range, {}", gene + 1,
                                      field, value, range)};
  };
  for (std::size_t i = 0; i < genome.size(); ++i) {
    for (const Field& field : fields) {
      const double value = genome[i].*field.value;
      if (value >= field.min && value <= field.max) continue;
      return violation(i, field.name, value, fmt::format("{} to {}{}", field.min, field.max, field.unit));
    }
    const double orientation = genome[i].orientation_deg;
    if (!(orientation >= 0.0 && orientation < 360.0)) {
      return violation(i, "orientation", orientation, "0 to less than 360 degrees");
    }
    if (!genome[i].Moves()) continue;
    if (genome[i].speed < spec.speed_min || genome[i].speed > spec.speed_max) {
      return violation(i, "speed", genome[i].speed,
                       fmt::format("{} to {} m/s", spec.speed_min, spec.speed_max));
    }
    for (const sim::Vec2& point : genome[i].path) {
      for (const double value : {point.x(), point.y()}) {
        if (value >= spec.position_min && value <= spec.position_max) continue;
        return violation(i, "path", value, fmt::format("{} to {} m", spec.position_min, spec.position_max));
      }
    }
  }
  return std::nullopt;
}

}  // namespace gauntlet::master
