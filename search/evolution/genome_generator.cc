#include "search/evolution/genome_generator.h"

#include <fmt/format.h>

#include <utility>

#include "search/experiment/genome_ranges.h"

namespace gauntlet {
namespace {

double Draw(double min, double max, double step, sim::RandomStream& random) {
  if (step == 0.0) return random.Uniform(min, max);
  const GridRange grid = GridOf(min, max, step);
  const auto points = static_cast<std::uint32_t>(grid.last - grid.first + 1);
  // A quotient of whole numbers is the double nearest to the decimal: 3 / 10.0 is 0.3, 3 * 0.1 is not.
  return static_cast<double>(grid.first + static_cast<std::int64_t>(random.Below(points))) / grid.divisions;
}

// Such a value moved by up to the share `reach` of its range and turned back at the ends.
double Moved(double value, double min, double max, double step, double reach, sim::RandomStream& random) {
  if (step == 0.0) {
    const double moved = value + reach * random.Uniform(min - max, max - min);
    return moved < min ? 2.0 * min - moved : moved > max ? 2.0 * max - moved : moved;
  }
  const GridRange grid = GridOf(min, max, step);
  const std::int64_t points = grid.last - grid.first + 1;
  const auto most = std::min(points - 1, 1 + static_cast<std::int64_t>(reach * static_cast<double>(points)));
  std::int64_t moved = std::llround(value * grid.divisions) - grid.first - most +
                       random.Below(static_cast<std::uint32_t>(2 * most + 1));
  if (moved < 0) moved = -1 - moved;
  if (moved >= points) moved = 2 * points - 1 - moved;
  return static_cast<double>(grid.first + moved) / grid.divisions;
}

// The genes of a random case, one after the other.
struct Fresh {
  const GenomeGenerator* generator;
  sim::RandomStream random;

  sim::ObstacleGene operator()(std::size_t /*place*/) { return generator->RandomGene(random); }
};

// Those of given draws.
struct Drawn {
  const GenomeGenerator* generator;
  std::span<const GeneDraw> draws;
  std::size_t at = SIZE_MAX;  // the place of the last gene
  sim::RandomStream random{0, sim::StreamPurpose::kGenome};

  sim::ObstacleGene operator()(std::size_t place) {
    if (place == at) return generator->RandomGene(random);
    at = place;
    random = sim::RandomStream(draws[place].others, sim::StreamPurpose::kGenome);
    return draws[place].first;
  }
};

}  // namespace

GenomeGenerator::GenomeGenerator(const GenomeSpec& spec, const sim::TestCase& arena_without_obstacles,
                                 const sim::ArenaRequirements& requirements)
    : spec_(spec),
      arena_(arena_without_obstacles),
      requirements_(requirements),
      empty_(arena_without_obstacles, requirements) {
  arena_.obstacles.clear();
  const Status status = CheckGenomeSpec(spec_);
  GAUNTLET_CHECK(status.ok(), status.error().message);
}

sim::ObstacleGene GenomeGenerator::RandomGene(sim::RandomStream& random) const {
  sim::ObstacleGene gene;
  const sim::Vec2 place = DrawPlace(random);
  gene.x = place.x();
  gene.y = place.y();
  gene.length = Draw(spec_.length_min, spec_.length_max, spec_.step, random);
  gene.width = Draw(spec_.width_min, spec_.width_max, spec_.step, random);
  gene.orientation_deg = random.Below(360);
  if (spec_.moving > 0.0 && random.Chance(spec_.moving)) SetInMotion(random, gene);
  if (spec_.lights > 0.0 && random.Chance(spec_.lights)) gene.light = spec_.light_color;
  return gene;
}

sim::Vec2 GenomeGenerator::DrawPlace(sim::RandomStream& random) const {
  const auto [min, max] = spec_.Places();
  const double x = Draw(min.x(), max.x(), spec_.step, random);
  return {x, Draw(min.y(), max.y(), spec_.step, random)};
}

void GenomeGenerator::SetInMotion(sim::RandomStream& random, sim::ObstacleGene& gene) const {
  gene.speed = Draw(spec_.speed_min, spec_.speed_max, kSpeedStep, random);
  for (int i = 0; i < spec_.waypoints; ++i) gene.path.push_back(DrawPlace(random));
}

template <typename Append, typename Source>
std::optional<sim::Genome> GenomeGenerator::TryGenome(const Append& append, Source& source) const {
  sim::Genome genome;
  while (std::ssize(genome) < spec_.genes) {
    int tries_left = spec_.tries_per_gene;
    sim::ObstacleGene gene;
    do {
      if (tries_left-- == 0) return std::nullopt;
      gene = source(genome.size());
    } while (append(gene).has_value());
    genome.push_back(gene);
  }
  return genome;
}

template <typename Source>
std::optional<sim::Genome> GenomeGenerator::TryGenome(Source& source) const {
  // Few cases ever lose their last path: drawn without looking at it, a case that has one in the end is the
  // case that looking at every gene would have given.
  const Source begin = source;
  sim::IncrementalValidity hopeful = empty_;
  std::optional<sim::Genome> genome = TryGenome(
      [&](const sim::ObstacleGene& gene) { return hopeful.TryAppendWhateverPathIsLeft(gene); }, source);
  if (hopeful.LeavesPath()) return genome;
  source = begin;
  sim::IncrementalValidity careful = empty_;
  return TryGenome([&](const sim::ObstacleGene& gene) { return careful.TryAppend(gene); }, source);
}

Result<sim::TestCase> GenomeGenerator::RandomTestCase(sim::RandomStream& random) const {
  if (const std::optional<sim::Violation>& violation = empty_.arena_violation()) {
    return InvalidInput(fmt::format("the arena breaks the rule {} before it has any obstacle: {}",
                                    sim::NameOf(violation->rule), violation->message));
  }
  Fresh source{this, random};
  for (int start = 0; start < kMaxRestarts; ++start) {
    std::optional<sim::Genome> genome = TryGenome(source);
    random = source.random;
    if (genome) return WithObstacles(std::move(*genome));
  }
  const auto [min, max] = spec_.Places();
  const std::string positions =
      spec_.places ? fmt::format("x {} to {} m, y {} to {} m", min.x(), max.x(), min.y(), max.y())
                   : fmt::format("positions {} to {} m", min.x(), max.x());
  const std::size_t keep_outs = requirements_.keep_outs.size();
  const std::string or_else =
      keep_outs == 0 ? "" : fmt::format(", or leave more room than the {} keep-outs do", keep_outs);
  return InvalidInput(
      fmt::format("no valid test case found in {} starts with genome.genes = {}, {}, lengths {} to {} "
                  "m, widths {} to {} m in an arena of {} x {} m: use fewer or smaller obstacles{}",
                  kMaxRestarts, spec_.genes, positions, spec_.length_min, spec_.length_max, spec_.width_min,
                  spec_.width_max, arena_.side_x, arena_.side_y, or_else));
}

GeneDraw GenomeGenerator::DrawGene(sim::RandomStream& random) const {
  GeneDraw draw{RandomGene(random)};
  draw.others = random.NextUint64();
  return draw;
}

sim::ObstacleGene GenomeGenerator::NearGene(sim::ObstacleGene gene, double reach,
                                            sim::RandomStream& random) const {
  constexpr int kTurn = 360;
  const auto [min, max] = spec_.Places();
  gene.x = Moved(gene.x, min.x(), max.x(), spec_.step, reach, random);
  gene.y = Moved(gene.y, min.y(), max.y(), spec_.step, reach, random);
  gene.length = Moved(gene.length, spec_.length_min, spec_.length_max, spec_.step, reach, random);
  gene.width = Moved(gene.width, spec_.width_min, spec_.width_max, spec_.step, reach, random);
  const int most = 1 + static_cast<int>(reach * kTurn);
  const int turned = static_cast<int>(gene.orientation_deg) + kTurn - most +
                     static_cast<int>(random.Below(static_cast<std::uint32_t>(2 * most + 1)));
  gene.orientation_deg = turned % kTurn;
  return gene;
}

Result<sim::TestCase> GenomeGenerator::CaseOf(std::span<const GeneDraw> draws) const {
  GAUNTLET_CHECK(std::ssize(draws) == spec_.genes, fmt::format("{} draws", draws.size()));
  if (!empty_.arena_violation()) {
    Drawn source{this, draws};
    if (std::optional<sim::Genome> genome = TryGenome(source)) return WithObstacles(std::move(*genome));
  }
  sim::RandomStream anew(draws.empty() ? 0 : draws.front().others, sim::StreamPurpose::kGenome, /*a=*/1);
  return RandomTestCase(anew);
}

sim::TestCase GenomeGenerator::WithObstacles(sim::Genome genome) const {
  sim::TestCase test_case = arena_;
  test_case.obstacles = std::move(genome);
  return test_case;
}

bool GenomeGenerator::Valid(const sim::Genome& genome) const {
  return !sim::CheckValidity(WithObstacles(genome), requirements_).has_value();
}

}  // namespace gauntlet
