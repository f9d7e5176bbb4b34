#include "sim/arena/genome_codec.h"

#include <algorithm>

#include "base/hash.h"

namespace gauntlet::sim {
namespace {

constexpr std::uint64_t kExtended = 1ULL << 63;

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

void EncodeGenome(const Genome& genome, CanonicalEncoder& encoder) {
  const bool extended = IsExtended(genome);
  encoder.Uint(genome.size() | (extended ? kExtended : 0));
  for (const ObstacleGene& gene : genome) EncodeGene(gene, extended, encoder);
}

Genome DecodeGenome(CanonicalDecoder& decoder) {
  const std::uint64_t head = decoder.Uint();
  Genome genome;
  for (std::uint64_t left = head & ~kExtended; left > 0 && decoder.ok(); --left) {
    genome.push_back(DecodeGene((head & kExtended) != 0, decoder));
  }
  return genome;
}

std::uint64_t GenomeHash(const Genome& genome) {
  const bool extended = IsExtended(genome);
  CanonicalEncoder encoder;
  for (const ObstacleGene& gene : genome) EncodeGene(gene, extended, encoder);
  Fnv1a64 hash;
  hash.AddBytes(encoder.bytes());
  return hash.value();
}

}  // namespace gauntlet::sim
