// How runs are numbered within a campaign, and the hash that guards a stored spec.
#pragma once

#include <cstdint>
#include <string_view>

#include "master/store/result_store.h"

namespace gauntlet::master {

// Random numbers and state hash of a search are those it would have as the only one of a campaign, whatever
// its number is.
inline constexpr SearchId kOnlySearch = 1;

// The id of run number `sequence` (1, 2, ... below 2^40) of a search: searches do not share numbers, so ids
// do not depend on which search was faster.
RunId RunIdOf(SearchId search, std::uint64_t sequence);
// The search of a run.
SearchId SearchOf(RunId run);

// StoredRun::spec_hash of a serialized RunSpec.
std::uint64_t SpecHash(std::string_view spec);

}  // namespace gauntlet::master
