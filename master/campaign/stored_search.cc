#include "master/campaign/stored_search.h"

#include <utility>
#include <vector>

#include "master/store/run_numbers.h"
#include "proto/run_codec.h"
#include "search/search_table.h"

namespace gauntlet {

Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const SearchPlan& plan, ResultStore& store,
                                                          bool restored) {
  const SearchRow& row = RowOf(plan.experiment);
  const bool handed = row.handed_cases();
  if (!handed && (row.individuals != Individuals::kCases || !restored)) return MakeSearch(plan.experiment);
  TRY(std::vector<Individual> individuals, store.LoadIndividuals(plan.id));
  return MakeStoredSearch(plan, std::move(individuals));
}

Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const SearchPlan& plan,
                                                          std::vector<Individual> individuals) {
  const SearchRow& row = RowOf(plan.experiment);
  const bool handed = row.handed_cases();
  if (!handed && row.individuals != Individuals::kCases) return MakeSearch(plan.experiment);
  if (row.given_cases() && individuals.empty()) {
    return Error{ErrorKind::kCorrupt,
                 "the campaign was stopped before its cases were stored: evaluate them anew"};
  }
  std::vector<sim::TestCase> cases;
  cases.reserve(individuals.size());
  for (Individual& individual : individuals) {
    if (!handed && individual.id != cases.size() + 1) break;  // those behind a gap are drawn
    if (individual.parents.empty())
      cases.push_back(std::move(individual.test_case));  // others were born later
  }
  return MakeSearch(plan.experiment, std::move(cases));
}

bool HasFinished(const StoredSearch& stored, const Experiment& experiment, const SearchAlgorithm& search) {
  const SearchRow& row = RowOf(experiment);
  // Of a stream that has ended and gone on, the runs that came last count.
  if (row.streamed) return stored.finished_with > 0 && stored.finished_with >= stored.last_run;
  if (row.info.length.empty()) return stored.finished_with > 0;
  const auto runs_each = static_cast<std::uint64_t>(experiment.search.replicates);
  const RunId last = RunIdOf(stored.id, 1) - 1 + search.Progress().evaluations_planned * runs_each;
  return stored.finished_with > 0 && stored.finished_with >= last;
}

Result<RunOutcome> OutcomeOf(const StoredRun& run, bool with_metrics, bool with_ways) {
  RunOutcome outcome = run;
  if (!with_metrics && !with_ways) return outcome;
  TRY(sim::RunResult result, proto::DecodeStoredResult(run.result));
  if (with_metrics) outcome.effects = SideEffectsOf(result);
  if (with_metrics) outcome.metrics = std::move(result.metrics);
  if (with_ways) outcome.robots = std::move(result.robots);
  return outcome;
}

Result<SavedProgress> RestoreSearch(SearchId id, ResultStore& store, SearchAlgorithm& search,
                                    const RunReader& reader) {
  const bool with_metrics = search.WantsMetrics() || reader.with_metrics;  // they stand in the results
  const bool with_ways = search.WantsWays();
  bool read = reader.take == nullptr;
  using Take = std::function<void(const StoredRun& run, RunOutcome outcome)>;
  const auto each = [&](const Take& take) -> Status {
    const auto visit = [&](const StoredRun& run) -> Status {
      TRY(RunOutcome outcome, OutcomeOf(run, with_metrics, with_ways));
      if (!read) {
        TRY(reader.take(run, outcome));
      }
      take(run, std::move(outcome));
      return Ok{};
    };
    TRY(with_metrics || with_ways ? store.ForEachRun(id, 0, visit) : store.ForEachRow(id, 0, visit));
    if (!read && reader.end) {
      TRY(reader.end());
    }
    read = true;
    return Ok{};
  };
  SavedProgress saved;
  saved.last_run = RunIdOf(id, 1) - 1;
  TRY(std::optional<SavedState> newest, store.LoadNewestState(id));
  if (newest) {
    saved.last_run = newest->last_run;
    saved.state = std::move(newest->state);
    TRY(saved.results, ResultsDigest::Restore(newest->results_digest));
    const History history = [&](const std::function<void(const EvaluationOutcome&)>& visit) -> Status {
      EvaluationOutcome next;  // its runs stand one behind the other
      const auto tell = [&] {
        if (next.runs.empty()) return;
        visit(OutcomeOfRuns(next.individual, next.evaluation, std::exchange(next.runs, {})));
      };
      TRY(each([&](const StoredRun& run, RunOutcome outcome) {
        if (run.id > saved.last_run) return;
        if (run.individual != next.individual || run.evaluation != next.evaluation) tell();
        next.individual = run.individual;
        next.evaluation = run.evaluation;
        next.runs.push_back(std::move(outcome));
      }));
      tell();
      return Ok{};
    };
    CanonicalDecoder decoder(saved.state);
    TRY(search.Restore(decoder, history));
  }
  if (!read) {
    TRY(each([](const StoredRun&, const RunOutcome&) {}));
  }
  return saved;
}

}  // namespace gauntlet
