// The one place where the protobuf of runs (run.proto) meets plain structs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet::proto {

// Sizes beyond which a spec is refused before anything is built from it, beside sim::kMaxObstacles and
// sim::kMaxObstaclePath.
inline constexpr int kMaxParameters = 1'000;
inline constexpr int kMaxFaults = 10'000;
inline constexpr std::size_t kMaxNameBytes = 4'096;

// Equal specs give equal bytes: the message has neither maps nor unknown fields.
std::string EncodeRunSpec(const sim::RunSpec& spec);

// EncodeRunSpec of specs that differ in their seed only: all else is written once.
class SeededSpecs {
 public:
  explicit SeededSpecs(const sim::RunSpec& spec);
  std::string Encode(std::uint64_t seed) const;
  // What all of them begin with, nearly the whole.
  std::string_view head() const { return head_; }

 private:
  std::string head_;
  std::string tail_;
};

// Error (kCorrupt): not a RunSpec, too large, a number that is not finite, a parameter given twice, or fields
// this version does not know: a newer master may mean something by them that changes the run. Ranges of
// values are the scenario's business (controllers/registry.h).
Result<sim::RunSpec> DecodeRunSpec(std::string_view bytes);

enum class TrajectoryEncoding { kLeaveOut, kInclude };

// Equal results give equal bytes. Texts that are not UTF-8 end the process: no reader would accept them.
std::string EncodeRunResult(const sim::RunResult& result,
                            TrajectoryEncoding trajectory = TrajectoryEncoding::kInclude);

// Without the robots' waypoints and the annotations, which are most of the bytes and which a replay gives
// back bit for bit. The hash stays that of the whole result; what is left has one of its own.
std::string EncodeWithoutWays(const sim::RunResult& result);

// What either of them wrote. Error (kCorrupt): not a RunResult, or its hash is not that of its content.
Result<sim::RunResult> DecodeRunResult(std::string_view bytes);

// The same for bytes from the store, which guards them by a checksum: of a result without waypoints no
// hash is held against its content.
Result<sim::RunResult> DecodeStoredResult(std::string_view bytes);

}  // namespace gauntlet::proto
