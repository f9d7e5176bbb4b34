// The worker's one place where the protobuf of runs meets plain structs.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::worker {

// Sizes beyond which a spec is refused before anything is built from it.
inline constexpr int kMaxObstacles = 10'000;
inline constexpr int kMaxParameters = 1'000;
inline constexpr int kMaxFaults = 10'000;
inline constexpr std::size_t kMaxNameBytes = 4'096;

// A serialized gauntlet.v1.RunSpec. Error (kInvalidInput, the message begins with "spec:"): not a RunSpec,
// too large, a number that is not finite, a parameter given twice, or fields this version does not know - a
// newer master may mean something by them that changes the run. Ranges of values are the scenario's business
// (controllers/registry.h).
Result<sim::RunSpec> DecodeRunSpec(std::string_view bytes);

enum class TrajectoryEncoding { kLeaveOut, kInclude };

// The same result gives the same bytes: the message has neither maps nor unknown fields. Texts that are not
// UTF-8 end the process: no reader would accept them.
std::string EncodeRunResult(const sim::RunResult& result, TrajectoryEncoding trajectory);

// How an encoded result ended: "completed: fitness 0.25, hash 0123456789abcdef", "was refused: ...".
std::string DescribeResult(std::string_view encoded);

}  // namespace gauntlet::worker
