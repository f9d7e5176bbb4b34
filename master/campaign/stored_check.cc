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

Status CheckStored(const SearchPlan& plan, ResultStore& store, Checked what) {
  const SearchId search = plan.id;
  TRY(std::vector<StoredSearch> searches, store.LoadSearches());
  RunId finished_with = 0;
  for (const StoredSearch& stored : searches) {
    if (stored.id == search) finished_with = stored.finished_with;
  }
  TRY(std::optional<SavedState> state, store.LoadNewestState(search));
  if (finished_with > 0 && !state.has_value())
    return Damaged("the search has finished, but its states are missing");
  const RunId last_seen = state.has_value() ? state->last_run : 0;

  const bool everything = what == Checked::kEverything;
  std::map<IndividualId, sim::TestCase> test_cases;
  if (everything) {
    TRY(std::vector<Individual> individuals, store.LoadIndividuals(search));
    for (Individual& individual : individuals)
      test_cases.emplace(individual.id, std::move(individual.test_case));
  }
  const auto missing = [&](RunId run) {
    return Damaged(fmt::format("run {} is missing: the state after generation {} has seen all up to run {}",
                               proto::RunText(run), state->generation, proto::RunText(last_seen)));
  };
  RunId expected = RunIdOf(search, 1);
  const auto check = [&](const StoredRun& run) -> Status {
    if (run.id != expected && expected <= last_seen) return missing(expected);
    expected = run.id + 1;
    TRY(CheckSeed(plan.experiment, run));
    if (!everything) return Ok{};
    TRY(CheckRecord(run));
    TRY(CheckTestCase(test_cases, run));
    test_cases.erase(run.individual);
    return Ok{};
  };
  TRY(everything ? store.ForEachRun(search, 0, check) : store.ForEachRow(search, 0, check));
  if (expected <= last_seen) return missing(expected);
  if (finished_with > last_seen) {
    return Damaged(fmt::format(
        "the search has finished with run {}, but the newest state has seen only the runs up to {}",
        proto::RunText(finished_with), proto::RunText(last_seen)));
  }
  return Ok{};
}

Status CheckStored(const std::vector<SearchPlan>& plans, ResultStore& store, Checked what) {
  for (const SearchPlan& plan : plans) {
    TRY(CheckStored(plan, store, what));
  }
  return Ok{};
}

}  // namespace gauntlet
