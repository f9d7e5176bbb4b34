#include "master/store/run_numbers.h"

#include "base/check.h"
#include "base/hash.h"

namespace gauntlet::master {
namespace {

constexpr int kSequenceBits = 40;

}  // namespace

RunId RunIdOf(SearchId search, std::uint64_t sequence) {
  GAUNTLET_CHECK(search >= 1 && sequence >= 1 && sequence < (1ULL << kSequenceBits),
                 "run number out of range");
  return (static_cast<RunId>(search - 1) << kSequenceBits) + sequence;
}

SearchId SearchOf(RunId run) {
  return static_cast<SearchId>(run >> kSequenceBits) + 1;
}

std::uint64_t SpecHash(std::string_view spec) {
  Fnv1a64 hash;
  hash.AddBytes(spec);
  return hash.value();
}

}  // namespace gauntlet::master
