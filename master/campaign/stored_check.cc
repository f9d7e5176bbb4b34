#include "master/campaign/stored_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "master/campaign/verdict_text.h"
#include "master/store/run_numbers.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"
#include "search/search_setup.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

Error Damaged(const std::string& what) {
  return {ErrorKind::kCorrupt, "the campaign's database was changed or is damaged: " + what};
}

template <typename Value>
Status Same(const StoredRun& run, const char* column, const Value& in_row, const Value& in_result) {
  if (in_row == in_result) return Ok{};
  return Damaged(fmt::format("run {} has {} {} in its row, {} in its result", proto::RunText(run.id), column,
                             in_row, in_result));
}

Status CheckRecord(const StoredRun& run) {
  if (const std::uint64_t hash = SpecHash(run.spec); hash != run.spec_hash) {
    return Damaged(fmt::format("the spec of run {} has hash {:016x}, when it was stored it had {:016x}",
                               proto::RunText(run.id), hash, run.spec_hash));
  }
  const Result<sim::RunResult> result = proto::DecodeStoredResult(run.result);
  if (!result)
    return Damaged(fmt::format("the result of run {}: {}", proto::RunText(run.id), result.error().message));
  return CheckCopies(run, *result);
}

// Test cases by individual; a run's spec must hold that of its individual.
Status CheckTestCase(const std::map<IndividualId, sim::TestCase>& test_cases, const StoredRun& run) {
  const auto known = test_cases.find(run.individual);
  if (known == test_cases.end()) return Ok{};  // individuals are stored at the end of their generation
  Result<sim::RunSpec> spec = proto::DecodeRunSpec(run.spec);
  if (!spec)
    return Damaged(fmt::format("the spec of run {}: {}", proto::RunText(run.id), spec.error().message));
  spec->test_case = known->second;
  if (proto::EncodeRunSpec(*spec) == run.spec) return Ok{};
  return Damaged(fmt::format("the stored test case of individual {} is not the one that run {} simulated",
                             run.individual, proto::RunText(run.id)));
}

}  // namespace

Status CheckCopies(const StoredRun& run, const sim::RunResult& result) {
  if (run.hash != result.hash) {
    return Damaged(fmt::format("run {} has hash {:016x} in its row, {:016x} in its result",
                               proto::RunText(run.id), run.hash, result.hash));
  }
  if (run.verdict != result.verdict) {
    return Damaged(fmt::format("run {} has verdict {} in its row, '{}' in its result", proto::RunText(run.id),
                               static_cast<int>(run.verdict), NameOf(result.verdict)));
  }
  if (std::bit_cast<std::uint64_t>(run.fitness) != std::bit_cast<std::uint64_t>(result.fitness)) {
    return Damaged(fmt::format("run {} has fitness {} in its row, {} in its result", proto::RunText(run.id),
                               run.fitness, result.fitness));
  }
  TRY(Same(run, "message", run.message, result.message));
  TRY(Same(run, "total_failure", run.total_failure, result.failure.total));
  return Same(run, "failure_type", run.failure_type, result.failure.type);
}

Status CheckSeed(const Experiment& experiment, const StoredRun& run) {
  if (RowOf(experiment).streamed) return Ok{};  // its line may have given a seed
  EvaluationRequest asked{.individual = run.individual, .evaluation = run.evaluation};
  if (RowOf(experiment).seeds_of_cases) {
    if (run.spec.empty()) return Ok{};  // rows alone are looked at
    Result<sim::RunSpec> spec = proto::DecodeRunSpec(run.spec);
    if (!spec)
      return Damaged(fmt::format("the spec of run {}: {}", proto::RunText(run.id), spec.error().message));
    asked.test_case = std::move(spec->test_case);
  }
  const std::uint64_t seed = RunSeed(experiment, asked, run.replicate);
  if (seed == run.seed) return Ok{};
  return Damaged(fmt::format(
      "run {} has seed {}, but replicate {} of evaluation {} of individual {} has {} (campaign seed {})",
      proto::RunText(run.id), run.seed, run.replicate, run.evaluation, run.individual, seed,
      experiment.seed));
}

Result<RowCheck> RowCheck::Begin(const SearchPlan& plan, ResultStore& store) {
  RowCheck check;
  check.experiment_ = &plan.experiment;
  check.expected_ = RunIdOf(plan.id, 1);
  TRY(const std::vector<StoredSearch> searches, store.LoadSearches());
  for (const StoredSearch& stored : searches) {
    if (stored.id == plan.id) check.finished_with_ = stored.finished_with;
  }
  TRY(const std::optional<SavedState> state, store.LoadNewestState(plan.id));
  if (check.finished_with_ > 0 && !state.has_value())
    return Damaged("the search has finished, but its states are missing");
  if (state.has_value()) {
    check.last_seen_ = state->last_run;
    check.generation_ = state->generation;
  }
  return check;
}

Status RowCheck::Take(const StoredRun& run) {
  if (run.id != expected_ && expected_ <= last_seen_) return Missing(expected_);
  expected_ = run.id + 1;
  return CheckSeed(*experiment_, run);
}

Status RowCheck::End() const {
  if (expected_ <= last_seen_) return Missing(expected_);
  if (finished_with_ <= last_seen_) return Ok{};
  return Damaged(
      fmt::format("the search has finished with run {}, but the newest state has seen only the runs up to {}",
                  proto::RunText(finished_with_), proto::RunText(last_seen_)));
}

Error RowCheck::Missing(RunId run) const {
  return Damaged(fmt::format("run {} is missing: the state after generation {} has seen all up to run {}",
                             proto::RunText(run), generation_, proto::RunText(last_seen_)));
}

Status CheckStored(const SearchPlan& plan, ResultStore& store, Checked what) {
  TRY(RowCheck rows, RowCheck::Begin(plan, store));
  const bool everything = what == Checked::kEverything;
  std::map<IndividualId, sim::TestCase> test_cases;
  if (everything) {
    TRY(std::vector<Individual> individuals, store.LoadIndividuals(plan.id));
    for (Individual& individual : individuals)
      test_cases.emplace(individual.id, std::move(individual.test_case));
  }
  const auto check = [&](const StoredRun& run) -> Status {
    TRY(rows.Take(run));
    if (!everything) return Ok{};
    TRY(CheckRecord(run));
    TRY(CheckTestCase(test_cases, run));
    test_cases.erase(run.individual);
    return Ok{};
  };
  TRY(everything ? store.ForEachRun(plan.id, 0, check) : store.ForEachRow(plan.id, 0, check));
  return rows.End();
}

Status CheckStored(const std::vector<SearchPlan>& plans, ResultStore& store, Checked what) {
  for (const SearchPlan& plan : plans) {
    TRY(CheckStored(plan, store, what));
  }
  return Ok{};
}

}  // namespace gauntlet
