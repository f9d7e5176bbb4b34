#include "sim/arena/genome.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {
namespace {

constexpr std::uint64_t kExtended = 1ULL << 63;
constexpr std::size_t kPlainGeneBytes = 5 * sizeof(double);

bool IsExtended(const Genome& genome) {
  return std::any_of(genome.begin(), genome.end(), [](const ObstacleGene& gene) { return !gene.Plain(); });
}

void EncodeGene(const ObstacleGene& gene, bool extended, CanonicalEncoder& encoder) {
  for (const double value : {gene.x, gene.y, gene.length, gene.width, gene.orientation_deg}) {
    encoder.Double(value);
  }
  if (!extended) return;
  encoder.Double(gene.speed);
  encoder.Uint(static_cast<std::uint64_t>(gene.light));
  encoder.Uint(gene.path.size());
  for (const Vec2& point : gene.path) {
    encoder.Double(point.x());
    encoder.Double(point.y());
  }
}

ObstacleGene DecodeGene(bool extended, CanonicalDecoder& decoder) {
  ObstacleGene gene;
  for (double* const value : {&gene.x, &gene.y, &gene.length, &gene.width, &gene.orientation_deg}) {
    *value = decoder.Double();
  }
  if (!extended) return gene;
  gene.speed = decoder.Double();
  gene.light = static_cast<Color>(std::min<std::uint64_t>(decoder.Uint(), kColorNames.size() - 1));
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    const double x = decoder.Double();
    gene.path.emplace_back(x, decoder.Double());
  }
  return gene;
}

}  // namespace

OrientedBox BoxOf(const ObstacleGene& gene) {
  // Quarter turns are taken off in degrees, where they are exact, so that 90, 180 and 270 degrees give exact
  // axes.
  const double degrees = std::fmod(gene.orientation_deg, 360.0);
  const double quarters = std::floor(degrees / 90.0 + 0.5);
  Vec2 axis = UnitVector((degrees - 90.0 * quarters) * kDegree);
  for (int turns = (static_cast<int>(quarters) + 4) % 4; turns > 0; --turns) axis = LeftOf(axis);
  return {{gene.x, gene.y}, {gene.length / 2.0, gene.width / 2.0}, axis};
}

void EncodeGenome(const Genome& genome, CanonicalEncoder& encoder) {
  const bool extended = IsExtended(genome);
  encoder.Uint(genome.size() | (extended ? kExtended : 0));
  for (const ObstacleGene& gene : genome) EncodeGene(gene, extended, encoder);
}

Genome DecodeGenome(CanonicalDecoder& decoder) {
  const std::uint64_t head = decoder.Uint();
  constexpr std::uint64_t kUsualGenes = 64;  // what the bytes claim may be wrong
  Genome genome;
  genome.reserve(std::min(head & ~kExtended, kUsualGenes));
  for (std::uint64_t left = head & ~kExtended; left > 0 && decoder.ok(); --left) {
    genome.push_back(DecodeGene((head & kExtended) != 0, decoder));
  }
  return genome;
}

std::uint64_t GenomeHash(const Genome& genome) {
  const bool extended = IsExtended(genome);
  CanonicalEncoder encoder;
  encoder.Reserve(genome.size() * kPlainGeneBytes);
  for (const ObstacleGene& gene : genome) EncodeGene(gene, extended, encoder);
  Fnv1a64 hash;
  hash.AddBytes(encoder.bytes());
  return hash.value();
}

}  // namespace gauntlet::sim
