#include "proto/run_failure.h"

#include <fmt/format.h>

#include "base/check.h"

namespace gauntlet::proto {

std::string Describe(const RunnerFailure& failure) {
  switch (failure.kind) {
    case FailureKind::kCrashed:
      return failure.signal != 0 ? fmt::format("crashed with signal {}", failure.signal)
                                 : fmt::format("crashed with exit code {}", failure.exit_code);
    case FailureKind::kHung:
      return "exceeded its CPU time";
    case FailureKind::kOutOfMemory:
      return "exceeded its memory";
    case FailureKind::kExternal:
      return failure.signal != 0 ? fmt::format("was ended from outside by signal {}", failure.signal)
                                 : "was given back";
  }
  GAUNTLET_CHECK(false, "unknown kind of failure");
}

sim::RunResult ResultOf(const RunnerFailure& failure) {
  GAUNTLET_CHECK(failure.kind != FailureKind::kExternal, "an external failure gives no verdict");
  sim::RunResult result;
  result.verdict = failure.kind == FailureKind::kHung          ? sim::Verdict::kHung
                   : failure.kind == FailureKind::kOutOfMemory ? sim::Verdict::kOutOfMemory
                                                               : sim::Verdict::kCrashed;
  result.message = Describe(failure);
  sim::SetHashes(result);
  return result;
}

}  // namespace gauntlet::proto
