#include "proto/run_failure.h"

#include <fmt/format.h>

#include "base/check.h"

namespace gauntlet::proto {
namespace {

sim::Verdict VerdictOf(FailureKind kind) {
  switch (kind) {
    case FailureKind::kHung:
      return sim::Verdict::kHung;
    case FailureKind::kOutOfMemory:
      return sim::Verdict::kOutOfMemory;
    case FailureKind::kCrashed:
    case FailureKind::kUnreadable:
      return sim::Verdict::kCrashed;
    case FailureKind::kExternal:
      break;
  }
  GAUNTLET_CHECK(false, "an external failure gives no verdict");
}

}  // namespace

std::string Describe(const RunnerFailure& failure) {
  switch (failure.kind) {
    case FailureKind::kCrashed:
      return failure.signal != 0 ? fmt::format("crashed with signal {}", failure.signal)
                                 : fmt::format("crashed with exit code {}", failure.exit_code);
    case FailureKind::kHung:
      return "exceeded its CPU time";
    case FailureKind::kOutOfMemory:
      return "exceeded its memory";
    case FailureKind::kUnreadable:
      return "gave an unreadable result";
    case FailureKind::kExternal:
      return failure.signal != 0 ? fmt::format("was ended from outside by signal {}", failure.signal)
                                 : "was given back";
  }
  GAUNTLET_CHECK(false, "unknown kind of failure");
}

sim::RunResult ResultOf(const RunnerFailure& failure) {
  sim::RunResult result;
  result.verdict = VerdictOf(failure.kind);
  result.message = Describe(failure);
  result.hash = sim::HashOf(result);
  return result;
}

}  // namespace gauntlet::proto
