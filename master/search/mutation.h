// Mutation: single genes are replaced by new ones (thesis 3.2.3.6).
#pragma once

#include "master/search/genome_generator.h"
#include "sim/arena/genome.h"
#include "sim/random/random_stream.h"

namespace gauntlet::master {

// The genome with every gene, independently with `probability`, drawn anew as a whole. Validity is not
// judged.
sim::Genome Mutate(const sim::Genome& genome, double probability, const GenomeGenerator& generator,
                   sim::RandomStream& random);

}  // namespace gauntlet::master
