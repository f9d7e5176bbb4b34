#include "study/questions/empty_arena.h"

#include <fmt/format.h>

#include "search/failure_tally.h"
#include "search/given/repeated_case.h"
#include "search/search_table.h"
#include "study/questions/baselines.h"

namespace gauntlet {
namespace {

constexpr std::uint32_t kRuns = 5;  // the first of those that `gauntlet baseline` simulates

}  // namespace

Result<FailureTally> FirstEmptyRuns(const Experiment& experiment, bool all, const SimulateRun& simulate) {
  const sim::TestCase empty = EmptyArena(experiment.arena);
  const Experiment asked = ConfirmationOf(experiment, kBaselineRuns);  // its seeds are no search's
  FailureTally tally;
  for (std::uint32_t run = 0; run < kRuns && (all || tally.passes + tally.errors == 0); ++run) {
    const EvaluationRequest evaluation{.individual = 1, .evaluation = run, .test_case = empty};
    TRY(const auto result, simulate(SpecOfRun(asked, evaluation, /*replicate=*/0)));
    tally.Add({.verdict = result.verdict, .total_failure = result.failure.total, .metrics = result.metrics},
              FailingOf(experiment));
  }
  return tally;
}

Status CheckEmptyArena(const Experiment& experiment, const FailureTally& first_runs) {
  if (first_runs.failures < static_cast<int>(kRuns)) return Ok{};
  return InvalidInput(fmt::format(
      "controller = \"{}\" fails without any obstacle, in {} of {} runs of the empty arena: every layout "
      "would fail, so there is none to search for (nothing was begun; --even-if-it-fails-without-obstacles "
      "goes on)",
      experiment.controller, first_runs.failures, first_runs.runs()));
}

}  // namespace gauntlet
