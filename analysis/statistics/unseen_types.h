// How many types of failure are there that were not seen yet?
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gauntlet::analysis {

struct UnseenTypes {
  std::size_t seen = 0;        // types with at least one failure
  std::uint64_t failures = 0;  // of all types
  std::size_t seen_once = 0;   // types with exactly one failure
  std::size_t seen_twice = 0;
  double chao1 = 0.0;            // types expected in all, seen ones included; a lower bound (Chao 1984)
  double chao1_of_sample = 0.0;  // the same with the factor (n - 1) / n for a finite number n of failures
  double chance_of_new = 1.0;    // that the next failure is of a type not seen yet (Good 1953)
};

// `failures_per_type`: one count for each type, zeros allowed. Without any failure nothing is known: no
// types, and the next one is certainly new. Bias-corrected form of Chao1, which needs no type that was seen
// twice.
UnseenTypes EstimateUnseenTypes(std::span<const std::uint64_t> failures_per_type);

// Types expected in a sample of `failures` of them, drawn without replacement (rarefaction, Hurlbert 1971):
// so that sets with different numbers of failures can be compared. `failures` at most their number.
double RarefiedTypes(std::span<const std::uint64_t> failures_per_type, std::uint64_t failures);

}  // namespace gauntlet::analysis
