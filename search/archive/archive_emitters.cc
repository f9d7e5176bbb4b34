#include "search/archive/archive_emitters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "search/experiment/genome_ranges.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

// Standard deviations, chosen.
constexpr double kPlaceNoise = 0.15;   // m
constexpr double kTurnNoise = 20.0;    // degrees
constexpr double kPlaceJitter = 0.3;   // m
constexpr double kLengthJitter = 0.2;  // m
constexpr double kTurnInRow = 12.0;    // degrees
constexpr double kLeanNoise = 25.0;    // degrees
constexpr double kRowNoise = 0.3;      // m
// Of obstacles across the way. Of 492 rows of two on flocking's way that were drawn like these, 48 % broke
// the swarm in 3 of 3 runs, of 448 rows of three 83 %; of single obstacles 4 % at any angle and length, none
// of which was shorter than half of the range.
constexpr double kLongest = 0.25;  // the part of the range of lengths that is drawn from
// Of 25,000 single obstacles near flocking's way, nearly all that break the swarm in a cell where few do
// were 1.8 m long or longer, and up to 45 degrees from across.
constexpr double kLongestAlone = 0.1;  // as kLongest, of one that has to do without others
constexpr double kTurnAlone = 15.0;    // degrees
constexpr double kSpacing = 0.75;      // between centres, of the greatest length

double OnGrid(double value, double low, double high, double step) {
  value = std::clamp(value, low, high);
  if (step == 0.0) return value;
  const double divisions = std::round(1.0 / step);
  return std::round(value * divisions) / divisions;
}
void PutOnGrid(const sim::Vec2& place, const GenomeSpec& spec, sim::ObstacleGene& gene) {
  auto [min, max] = spec.Places();
  if (spec.places && spec.step > 0.0) {  // whose ends need not lie on the grid
    const GridRange x = GridOf(min.x(), max.x(), spec.step);
    const GridRange y = GridOf(min.y(), max.y(), spec.step);
    min = sim::Vec2(static_cast<double>(x.first), static_cast<double>(y.first)) / x.divisions;
    max = sim::Vec2(static_cast<double>(x.last), static_cast<double>(y.last)) / x.divisions;
  }
  gene.x = OnGrid(place.x(), min.x(), max.x(), spec.step);
  gene.y = OnGrid(place.y(), min.y(), max.y(), spec.step);
}
double LengthOnGrid(double length, const GenomeSpec& spec) {
  return OnGrid(length, spec.length_min, spec.length_max, spec.step);
}
// From the longest `part` of the range of lengths.
double DrawLongest(double part, const GenomeSpec& spec, sim::RandomStream& random) {
  const double shortest = spec.length_max - part * (spec.length_max - spec.length_min);
  return LengthOnGrid(random.Uniform(shortest, spec.length_max), spec);
}

// Whole degrees in [0, 360).
double WholeTurn(double degrees) {
  const double whole = std::round(degrees);
  return whole - 360.0 * std::floor(whole / 360.0);
}

std::optional<sim::Genome> IfValid(sim::Genome genome, const GenomeGenerator& generator) {
  return generator.Valid(genome) ? std::optional(std::move(genome)) : std::nullopt;
}

}  // namespace

std::vector<std::size_t> ByDistance(const sim::Genome& obstacles, const sim::Vec2& place) {
  std::vector<std::size_t> order(obstacles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return Distance(BoxOf(obstacles[i]), place); });
  return order;
}

std::vector<std::size_t> ByDistanceToWay(const sim::Genome& obstacles, const Way& way) {
  constexpr int kPoints = 50;  // of the way that are looked at
  std::vector<double> distances;
  for (const sim::ObstacleGene& gene : obstacles) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kPoints; ++i) {
      const sim::Vec2 point = way.start + (way.goal - way.start) * (static_cast<double>(i) / kPoints);
      nearest = std::min(nearest, Distance(BoxOf(gene), point));
    }
    distances.push_back(nearest);
  }
  std::vector<std::size_t> order(obstacles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return distances[i]; });
  return order;
}

sim::Vec2 Mirrored(const sim::Vec2& point, const Way& way) {
  const sim::Vec2 along = (way.goal - way.start).normalized();
  const sim::Vec2 offset = point - way.start;
  return way.start + 2.0 * along.dot(offset) * along - offset;
}

std::optional<sim::Genome> Mirrored(const sim::Genome& obstacles, const Way& way,
                                    const GenomeGenerator& generator) {
  const double axis = sim::AngleOf(way.goal - way.start) / sim::kDegree;
  sim::Genome mirrored = obstacles;
  for (sim::ObstacleGene& gene : mirrored) {
    PutOnGrid(Mirrored({gene.x, gene.y}, way), generator.spec(), gene);
    gene.orientation_deg = WholeTurn(2.0 * axis - gene.orientation_deg);
    for (sim::Vec2& point : gene.path) point = Mirrored(point, way);
  }
  return IfValid(std::move(mirrored), generator);
}

sim::Genome Keep(const sim::Genome& obstacles, std::vector<std::size_t> indices) {
  std::ranges::sort(indices);
  sim::Genome kept;
  for (const std::size_t index : indices) kept.push_back(obstacles[index]);
  return kept;
}

sim::Genome Without(const sim::Genome& obstacles, std::size_t index) {
  sim::Genome rest = obstacles;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(index));
  return rest;
}

std::optional<sim::Genome> Across(const sim::Vec2& place, int count, const Way& way,
                                  const GenomeGenerator& generator, sim::RandomStream& random) {
  const GenomeSpec& spec = generator.spec();
  const sim::Vec2 along = (way.goal - way.start).normalized();
  const sim::Vec2 across(-along.y(), along.x());
  const double turn = sim::AngleOf(across) / sim::kDegree;
  // One draw to a statement: compilers differ in the order in which they compute the two sides of a sum.
  const double aside = kRowNoise * random.Gaussian();
  const double onward = kPlaceNoise * random.Gaussian();
  const sim::Vec2 middle = place + onward * along + aside * across;
  const double lean = kLeanNoise * random.Gaussian();
  sim::Genome row;
  for (int i = 0; i < count; ++i) {
    const double side = i - 0.5 * (count - 1);
    const sim::Vec2 center = middle + side * kSpacing * spec.length_max * across;
    sim::ObstacleGene gene = generator.RandomGene(random);
    PutOnGrid(center, spec, gene);
    gene.length = DrawLongest(kLongest, spec, random);
    const double leaning = side > 0.0 ? lean : side < 0.0 ? -lean : 0.0;
    gene.orientation_deg = WholeTurn(turn + leaning + kTurnInRow * random.Gaussian());
    row.push_back(std::move(gene));
  }
  return IfValid(std::move(row), generator);
}

std::optional<sim::Genome> Longest(const sim::Genome& obstacles, const GenomeGenerator& generator,
                                   sim::RandomStream& random) {
  sim::Genome longest = obstacles;
  for (sim::ObstacleGene& gene : longest) {
    gene.length = DrawLongest(kLongestAlone, generator.spec(), random);
    gene.orientation_deg = WholeTurn(gene.orientation_deg + kTurnAlone * random.Gaussian());
  }
  return IfValid(std::move(longest), generator);
}

std::optional<sim::Genome> Jittered(const sim::Genome& obstacles, const GenomeGenerator& generator,
                                    sim::RandomStream& random) {
  sim::Genome jittered = obstacles;
  for (sim::ObstacleGene& gene : jittered) {
    const double x = gene.x + kPlaceJitter * random.Gaussian();
    PutOnGrid({x, gene.y + kPlaceJitter * random.Gaussian()}, generator.spec(), gene);
    gene.length = LengthOnGrid(gene.length + kLengthJitter * random.Gaussian(), generator.spec());
    gene.orientation_deg = WholeTurn(gene.orientation_deg + kTurnNoise * random.Gaussian());
  }
  return IfValid(std::move(jittered), generator);
}

}  // namespace gauntlet
