// What gauntlet-worker-noop's runs give.
#pragma once

#include <cstddef>
#include <cstdint>

#include "proto/golden_hashes.h"
#include "sim/run_result.h"

namespace gauntlet::perf {

// Keeps its results apart from real ones ("noop"), of the controller that is measured.
inline const proto::GoldenHashes kNoopGoldenHashes = {{"flocking", 0x6e6f6f70}};

inline sim::RunResult NoopResult(std::uint64_t seed) {
  sim::RunResult result;
  result.fitness = static_cast<double>(seed % 1000) / 1000.0;
  sim::SetHashes(result);
  return result;
}

}  // namespace gauntlet::perf
