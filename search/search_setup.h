// What every search starts from, and the keys of its randomness and of its runs'.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "search/evolution/genome_generator.h"
#include "search/experiment/experiment.h"
#include "search/search_algorithm.h"
#include "sim/arena/test_case.h"
#include "sim/arena/validity.h"

namespace gauntlet {

// Part of the keys of all random numbers of a search and of its runs, and of its state: every search counts
// as the first of its campaign.
inline constexpr std::uint32_t kSearchNumber = 1;

struct SearchRow;
struct Key;

// search_table.h makes one: SetupOf.
struct SearchSetup {
  Experiment experiment;
  sim::ArenaRequirements requirements;  // of the experiment's scenario for its empty arena
  std::vector<sim::TestCase> cases;     // of a search through given cases; of random search the known ones
  const SearchRow* row = nullptr;       // of the experiment's search
  std::span<const Key> keys;            // of all experiments
};

// Of the arena, its robots and obstacles: equal for the same case under another name.
std::uint64_t CaseHash(const sim::TestCase& test_case);

// The experiment's arena without obstacles.
sim::TestCase EmptyArena(const ArenaSpec& arena);

GenomeGenerator MakeGenerator(const SearchSetup& setup);

// The seed of a search's random streams: different for every campaign seed and SearchRow::number, so
// that random search and the initial population of an evolution share no case. No run has this seed: runs
// belong to individuals from 1 on.
std::uint64_t SearchSeed(const SearchSetup& setup);

// The random stream of the case that individual `id` starts life with.
sim::RandomStream GenomeStream(std::uint64_t search_seed, std::uint64_t id);

// Everything the course of a search depends on, as lines "key = value": all keys of the experiment but those
// for people and those that this search does not read. How long it goes on is left out too: a saved state may
// be continued with more generations or cases than it was made with.
std::string SearchIdentity(const SearchSetup& setup);

}  // namespace gauntlet
