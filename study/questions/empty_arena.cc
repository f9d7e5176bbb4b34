#include "study/questions/empty_arena.h"

#include <fmt/format.h>

#include "search/failure_tally.h"
#include "search/given/repeated_case.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

constexpr std::uint32_t kRuns = 3;  // as many failures as admit a case to an archive

}  // namespace

Status CheckEmptyArena(const Experiment& experiment,
                       const std::function<Result<sim::RunResult>(const sim::RunSpec&)>& simulate) {
  const sim::TestCase empty = EmptyArena(experiment.arena);
  const Experiment asked = ConfirmationOf(experiment, kRuns);  // its seeds are no search's
  FailureTally tally;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    const EvaluationRequest evaluation{.individual = 1, .evaluation = run, .test_case = empty};
    TRY(const auto result, simulate(SpecOfRun(asked, evaluation, /*replicate=*/0)));
    tally.Add({.verdict = result.verdict, .total_failure = result.failure.total, .metrics = result.metrics},
              FailingOf(experiment));
    if (tally.passes + tally.errors > 0) return Ok{};
  }
  return InvalidInput(fmt::format(
      "controller = \"{}\" fails without any obstacle, in {} of {} runs of the empty arena: every layout "
      "would fail, so there is none to search for (nothing was begun)",
      experiment.controller, tally.failures, tally.runs()));
}

}  // namespace gauntlet
