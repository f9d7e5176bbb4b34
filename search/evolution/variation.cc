#include "search/evolution/variation.h"

#include <utility>

namespace gauntlet {
namespace {

// Slots of one couple behind kParentChoiceSlot: its crossover and the mutation of each child.
constexpr std::uint32_t kSlotsPerCouple = 3;

sim::RandomStream StreamOf(const CoupleKey& key, std::uint32_t slot) {
  return {key.search_seed, sim::StreamPurpose::kVariation, key.generation,
          kParentChoiceSlot + 1 + key.couple * kSlotsPerCouple + slot};
}

Offspring CrossUntilValid(const sim::Genome& first, const sim::Genome& second, const SearchSpec& spec,
                          const GenomeGenerator& generator, sim::RandomStream random) {
  if (!random.Chance(spec.crossover_probability)) return {first, second};
  for (int i = 0; i < spec.variation_tries; ++i) {
    Offspring offspring = Cross(spec.crossover, first, second, random);
    if (generator.Valid(offspring.first) && generator.Valid(offspring.second)) return offspring;
  }
  return {first, second};
}

sim::Genome MutateUntilValid(sim::Genome genome, const SearchSpec& spec, const GenomeGenerator& generator,
                             sim::RandomStream random) {
  for (int i = 0; i < spec.variation_tries; ++i) {
    sim::Genome mutant = Mutate(genome, spec.mutation_probability, generator, random);
    if (mutant == genome || generator.Valid(mutant)) return mutant;
  }
  return genome;
}

}  // namespace

sim::Genome Mutate(const sim::Genome& genome, double probability, const GenomeGenerator& generator,
                   sim::RandomStream& random) {
  sim::Genome mutant = genome;
  for (sim::ObstacleGene& gene : mutant) {
    if (random.Chance(probability)) gene = generator.RandomGene(random);
  }
  return mutant;
}

Offspring Breed(const sim::Genome& first, const sim::Genome& second, const SearchSpec& spec,
                const GenomeGenerator& generator, const CoupleKey& key) {
  Offspring crossed = CrossUntilValid(first, second, spec, generator, StreamOf(key, 0));
  return {MutateUntilValid(std::move(crossed.first), spec, generator, StreamOf(key, 1)),
          MutateUntilValid(std::move(crossed.second), spec, generator, StreamOf(key, 2))};
}

}  // namespace gauntlet
