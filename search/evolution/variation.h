// Two parents make two valid children: steps 4 and 5 of the evolutionary process (thesis 3.2.5).
#pragma once

#include <cstdint>

#include "search/evolution/crossover.h"
#include "search/evolution/genome_generator.h"
#include "search/experiment/experiment.h"

namespace gauntlet {

// Names the random streams of one couple, so that no couple's draws depend on another's.
struct CoupleKey {
  std::uint64_t search_seed = 0;
  std::uint32_t generation = 0;
  std::uint32_t couple = 0;  // 0, 1, ... within the generation
};

// The slot of the streams (kVariation, generation, slot) that parents are chosen or shuffled with; couples
// use the slots behind it.
inline constexpr std::uint32_t kParentChoiceSlot = 0;

// The genome with every gene, independently with `probability`, drawn anew as a whole (thesis 3.2.3.6).
// Validity is not judged.
sim::Genome Mutate(const sim::Genome& genome, double probability, const GenomeGenerator& generator,
                   sim::RandomStream& random);

// Crosses with spec.crossover_probability (else the children are copies), then mutates each child. A
// step whose outcome breaks a validity rule is done again; after spec.variation_tries it leaves its input
// unchanged, so children of valid parents are valid.
Offspring Breed(const sim::Genome& first, const sim::Genome& second, const SearchSpec& spec,
                const GenomeGenerator& generator, const CoupleKey& key);

}  // namespace gauntlet
