// What every generating search starts from, and the key of its randomness.
#pragma once

#include <cstdint>
#include <string>

#include "base/canonical_encoder.h"
#include "base/result.h"
#include "master/experiment/experiment.h"
#include "master/search/genome_generator.h"
#include "sim/arena/test_case.h"
#include "sim/arena/validity.h"

namespace gauntlet::master {

struct SearchSetup {
  Experiment experiment;
  sim::ArenaRequirements requirements;  // of the experiment's scenario for its empty arena
  std::uint32_t search_id = 1;          // within the campaign
};

// The experiment's arena without obstacles.
sim::TestCase EmptyArena(const ArenaSpec& arena);

GenomeGenerator MakeGenerator(const SearchSetup& setup);

// The seed of a search's random streams: different for every campaign seed, search and kind of search, so
// that random search and the initial population of an evolution share no case. No run has this seed: runs
// belong to individuals from 1 on.
std::uint64_t SearchSeed(const SearchSetup& setup);

// The random stream of the case that individual `id` starts life with.
sim::RandomStream GenomeStream(std::uint64_t search_seed, std::uint64_t id);

// Everything the course of a search depends on, as lines "key = value". How long the search goes on is left
// out: a saved state may be continued with more generations or cases than it was made with.
std::string SearchIdentity(const SearchSetup& setup);

// The head of every saved state: format number, kind of search, identity.
void WriteStateHead(std::uint64_t format, const SearchSetup& setup, CanonicalEncoder& encoder);
// Error: kVersion for another format; kCorrupt for what is no state; kInvalidInput for the state of another
// experiment, naming the first line in which they differ.
Status ReadStateHead(std::uint64_t format, const SearchSetup& setup, CanonicalDecoder& decoder);

}  // namespace gauntlet::master
