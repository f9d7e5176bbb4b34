// How runs are numbered within a campaign, and the hash that guards a stored spec.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/hash.h"
#include "master/store/result_store.h"
#include "proto/run_text.h"

namespace gauntlet {

// Random numbers and state hash of a search are those it would have as the only one of a campaign, whatever
// its number is.
inline constexpr SearchId kOnlySearch = 1;

using proto::kSequenceBits;

// The id of run number `sequence` (1, 2, ... below 2^40) of a search: searches do not share numbers, so ids
// do not depend on which search was faster.
inline RunId RunIdOf(SearchId search, std::uint64_t sequence) {
  GAUNTLET_CHECK(search >= 1 && sequence >= 1 && sequence < (1ULL << kSequenceBits),
                 "run number out of range");
  return (static_cast<RunId>(search - 1) << kSequenceBits) + sequence;
}

// The search of a run.
inline SearchId SearchOf(RunId run) {
  return static_cast<SearchId>(run >> kSequenceBits) + 1;
}

// The number of a run within its search.
inline std::uint64_t SequenceOf(RunId run) {
  return run & ((1ULL << kSequenceBits) - 1);
}

// StoredRun::spec_hash of a serialized RunSpec; `of_head`, where the hash of what it begins with is known.
inline std::uint64_t SpecHash(std::string_view rest, Fnv1a64 of_head = {}) {
  of_head.AddBytes(rest);
  return of_head.value();
}

}  // namespace gauntlet
