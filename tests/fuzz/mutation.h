// Changes texts and messages as a fuzzer does, by a fixed seed: no compiler of its own is needed for it.
#pragma once

#include <string>
#include <vector>

#include "sim/random/random_stream.h"

namespace gauntlet::fuzz {

// One of `corpus` with one to eight changes: bits, bytes, pieces that are removed, repeated, swapped or come
// from another of them, numbers and words that parsers stumble over. At most 64 KiB.
std::string Mutate(const std::vector<std::string>& corpus, sim::RandomStream& random);

}  // namespace gauntlet::fuzz
