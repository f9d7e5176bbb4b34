// Crossover: how the genes of two parents are handed to two children (thesis 3.2.3.4). Genes keep their
// place.
#pragma once

#include <cstddef>

#include "search/experiment/experiment.h"
#include "sim/arena/genome.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

struct Offspring {
  sim::Genome first;
  sim::Genome second;
};

// The parents with the genes at [begin, end) exchanged. The parents have equally many genes and begin <= end
// <= genes.
Offspring SwapSegment(const sim::Genome& first, const sim::Genome& second, std::size_t begin,
                      std::size_t end);

// Crosses two genomes of n genes each.
//   single point: a cut after gene 1 to n-1; everything behind it is exchanged
//   double point: two different cuts after genes 1 to n; what lies between is exchanged
//   uniform:      every gene is exchanged with probability 1/2
// One gene has no place for a cut: single and double point give copies then.
Offspring Cross(CrossoverKind kind, const sim::Genome& first, const sim::Genome& second,
                sim::RandomStream& random);

}  // namespace gauntlet
