// How often a test case breaks the swarm: counts of its runs, and when they are enough for a verdict.
#pragma once

#include <string_view>

#include "search/experiment/experiment.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// What the experiment's scenario calls failing (controllers::ScenarioInfo::failing).
std::string_view FailingOf(const sim::RunSettings& settings);
// Whether deciding it needs the metrics of runs (RunOutcome::metrics).
bool FailingNeedsMetrics(std::string_view failing);

// Whether the run broke the swarm. `failing` as FailingOf gives it.
bool Fails(const RunOutcome& run, std::string_view failing);

// Runs of a case with fresh seeds.
struct FailureTally {
  int failures = 0;
  int passes = 0;
  int errors = 0;  // ended without a result

  int runs() const { return failures + passes; }  // with a result
  void Add(const RunOutcome& run, std::string_view failing);
};

enum class FailureVerdict {
  kOpen,   // more runs are needed
  kFail,   // confirmed: fails in at least half of the runs
  kFlaky,  // fails in some, but in fewer than half
  kPass,   // fails in none
  kError,  // a run ended without a result
};
// "open", "fail", "flaky", "pass", "error".
std::string_view NameOf(FailureVerdict verdict);

// A case is run until it has failed 5 times or not failed 6 times, which takes at most 10 runs and is at
// least half of them exactly in the first case; or, when `replicates` is not 0, so often. 0 = decided;
// otherwise the runs without which there can be no verdict.
int RunsToVerdict(const FailureTally& tally, int replicates);
FailureVerdict VerdictOf(const FailureTally& tally, int replicates);

}  // namespace gauntlet
