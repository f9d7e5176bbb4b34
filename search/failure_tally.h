// How often a test case breaks the swarm: counts of its runs, and when they are enough for a verdict.
#pragma once

#include <string_view>

#include "search/experiment/experiment.h"
#include "search/search_algorithm.h"

namespace gauntlet {

// Whether runs start a program of the user's. It may refuse a run by chance, so a refused run is left out of
// what is counted, and only a case that is refused in half of its runs or more counts as one without a
// result.
bool StartsProgram(const sim::RunSettings& settings);
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
  int errors = 0;   // ended without a result
  int refused = 0;  // left out (StartsProgram); of others a refused run is an error

  bool mostly_refused() const { return refused > 0 && refused >= runs(); }
  int runs() const { return failures + passes; }  // with a result
  void Add(const RunOutcome& run, std::string_view failing);
};

enum class FailureVerdict {
  kOpen,   // more runs are needed
  kFail,   // confirmed: fails in at least half of the runs
  kFlaky,  // fails in some, but in fewer than half
  kPass,   // fails in none
  kError,  // a run ended without a result, or half of them or more were left out
};
// "open", "fail", "flaky", "pass", "error".
std::string_view NameOf(FailureVerdict verdict);

// A case is run until it has failed 5 times or not failed 6 times, which takes at most 10 runs and is at
// least half of them exactly in the first case; or, when `replicates` is not 0, so often. 0 = decided;
// otherwise the runs without which there can be no verdict. Runs that are left out are made up for, until
// there are as many as of the others there can be.
int RunsToVerdict(const FailureTally& tally, int replicates);
FailureVerdict VerdictOf(const FailureTally& tally, int replicates);

}  // namespace gauntlet
