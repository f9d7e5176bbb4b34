// Two sets of runs held against each other, by the one test that is right for them.
#pragma once

#include <optional>
#include <string>

#include "study/sets/paired_comparison.h"
#include "study/sets/run_set.h"

namespace gauntlet {

enum class Pairing {
  kWhereShared,  // case by case where all cases of the smaller set are cases of the other
  kDemanded,
  kNever,
};

struct SetPair {
  analysis::Comparison comparison;         // as if they had nothing to do with each other
  std::optional<PairedComparison> paired;  // case by case
  std::size_t left_out = 0;                // of the cases of both together, that have no partner
  // Two-sided, of `paired` or of `comparison`; none where the units are too few.
  std::optional<double> p;
  std::string p_by;   // its method, or why there is none
  std::string words;  // what it comes to
};

// `metric` is what the sets were read with; `first_name` and `second_name` are what words call them. Errors:
// those of analysis::Compare; no case that both have, where pairs are demanded.
Result<SetPair> HoldAgainst(const RunSet& first, const RunSet& second, const std::string& metric,
                            const std::string& first_name, const std::string& second_name,
                            Pairing pairing = Pairing::kWhereShared);

}  // namespace gauntlet
