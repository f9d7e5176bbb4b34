#include "master/search/mutation.h"

namespace gauntlet::master {

sim::Genome Mutate(const sim::Genome& genome, double probability, const GenomeGenerator& generator,
                   sim::RandomStream& random) {
  sim::Genome mutant = genome;
  for (sim::ObstacleGene& gene : mutant) {
    if (random.Chance(probability)) gene = generator.RandomGene(random);
  }
  return mutant;
}

}  // namespace gauntlet::master
