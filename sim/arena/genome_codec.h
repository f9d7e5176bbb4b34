// The one canonical encoding of genomes: search states, stored test cases, digests and hashes use it. A
// genome of fixed, dark obstacles has the bytes it had before there were others.
#pragma once

#include "base/canonical_encoder.h"
#include "sim/arena/obstacle_gene.h"

namespace gauntlet::sim {

// Number of genes, then of each x, y, length, width, orientation. When an obstacle moves or has lights, the
// number's highest bit is set and each gene goes on with speed, light, number of the path's points, points.
void EncodeGenome(const Genome& genome, CanonicalEncoder& encoder);
// The opposite. After bytes that no genome has, decoder.ok() is false or genes are incomplete.
Genome DecodeGenome(CanonicalDecoder& decoder);

// FNV-1a over the genes; equal for equal genomes.
std::uint64_t GenomeHash(const Genome& genome);

}  // namespace gauntlet::sim
