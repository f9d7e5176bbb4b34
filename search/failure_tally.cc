#include "search/failure_tally.h"

#include <algorithm>

#include "controllers/command/definition.h"
#include "controllers/registry.h"

namespace gauntlet {
namespace {

constexpr int kEnoughFailures = 5;
constexpr int kEnoughPasses = 6;
constexpr int kMostForAVerdict = kEnoughFailures + kEnoughPasses - 1;

}  // namespace

bool StartsProgram(const sim::RunSettings& settings) {
  return settings.scenario == controllers::command::kScenario;
}

std::string_view FailingOf(const sim::RunSettings& settings) {
  return controllers::DeclaredScenario(settings).failing;
}

bool FailingNeedsMetrics(std::string_view failing) {
  return failing != controllers::kTotalFailure;
}

bool Fails(const RunOutcome& run, std::string_view failing) {
  if (run.verdict != sim::Verdict::kCompleted) return false;
  if (!FailingNeedsMetrics(failing)) return run.total_failure;
  return controllers::ReportedValue(run.metrics, failing) == 1.0;
}

void FailureTally::Add(const RunOutcome& run, std::string_view failing) {
  if (run.verdict != sim::Verdict::kCompleted) {
    ++errors;
  } else if (Fails(run, failing)) {
    ++failures;
  } else {
    ++passes;
  }
}

std::string_view NameOf(FailureVerdict verdict) {
  switch (verdict) {
    case FailureVerdict::kOpen:
      return "open";
    case FailureVerdict::kFail:
      return "fail";
    case FailureVerdict::kFlaky:
      return "flaky";
    case FailureVerdict::kPass:
      return "pass";
    case FailureVerdict::kError:
      return "error";
  }
  return "";
}

int RunsToVerdict(const FailureTally& tally, int replicates) {
  if (tally.errors > 0) return 0;
  if (replicates > 0) return std::max(0, replicates - std::max(tally.runs(), tally.refused));
  return std::max(0, std::min({kEnoughFailures - tally.failures, kEnoughPasses - tally.passes,
                               kMostForAVerdict - tally.refused}));
}

FailureVerdict VerdictOf(const FailureTally& tally, int replicates) {
  if (tally.errors > 0) return FailureVerdict::kError;
  if (RunsToVerdict(tally, replicates) > 0) return FailureVerdict::kOpen;
  if (tally.mostly_refused()) return FailureVerdict::kError;
  if (2 * tally.failures >= tally.runs()) return FailureVerdict::kFail;
  return tally.failures > 0 ? FailureVerdict::kFlaky : FailureVerdict::kPass;
}

}  // namespace gauntlet
