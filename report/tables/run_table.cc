#include "report/tables/run_table.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "controllers/registry.h"
#include "master/campaign/verdict_text.h"
#include "proto/run_codec.h"
#include "proto/run_text.h"
#include "sim/robot/foot_bot.h"
#include "study/sets/subset.h"

namespace gauntlet {
namespace {

const std::vector<DataColumn> kNumbers = {
    {"id", "", "number of the run within the campaign, as `replay` takes it"},
    {"run", "", "the same as SEARCH:RUN, its number within its search, as `replay` takes it too"}};

const std::vector<DataColumn>& ColumnsOfTheRun() {
  static const std::vector<DataColumn> columns = {
      {"individual", "", "number of the test case within its search"},
      {"generation", "", "generation in which it was run, from 1"},
      {"evaluation", "", "round of runs of this test case, from 0"},
      {"replicate", "", "number of the run within this evaluation, from 0"},
      {"seed", "", "seed of the run, 64 bits"},
      {"verdict", "", "completed, or why there is no result: refused, crashed, hung, ..."},
      {"fitness", "", "lower = tougher; empty without a result"},
      {"total_failure", "", "whether the whole swarm failed"},
      {"failure_type", "", "number of the failure type; empty when there is none"},
      {"failure", "", "the failure type in words"}};
  return columns;
}

const std::vector<DataColumn>& ColumnsBehindMetrics() {
  static const std::vector<DataColumn> columns = {
      {"simulated_time", "s", "how long the run lasted in the simulation"},
      {"cpu_seconds", "s", "CPU time that the simulation took"},
      {"hash", "", "hash of the result, 16 hexadecimal digits"},
      {"worker", "", "worker that simulated it"},
      {"attempt", "", "number of the attempt that gave the result, from 1"},
      {"message", "", "why there is no result"}};
  return columns;
}

template <typename Some>
void Append(const Some& some, auto& all) {
  all.insert(all.end(), std::begin(some), std::end(some));
}

Error InRun(RunId run, const Error& error) {
  return {error.kind, fmt::format("run {}: {}", proto::RunText(run), error.message)};
}

// The metrics of the search's first completed run, in the scenario's order; none when it has no such run.
Result<std::vector<std::string>> MetricsOf(SearchId search, ResultStore& store) {
  std::optional<RunId> completed;
  TRY(store.ForEachRow(search, 0, [&](const StoredRun& run) {
    if (!completed && run.completed()) completed = run.id;
    return Ok{};
  }));
  std::vector<std::string> names;
  if (!completed) return names;
  TRY(const auto run, store.LoadRun(*completed));
  const Result<sim::RunResult> result = proto::DecodeStoredResult(run->result);
  if (!result) return InRun(*completed, result.error());
  for (const auto& [name, value] : result->metrics) names.push_back(name);
  return names;
}

}  // namespace

RunColumns CommonRunColumns() {
  std::vector<DataColumn> before = kNumbers;
  Append(CommonSearchColumns(), before);
  Append(ColumnsOfTheRun(), before);
  return {std::move(before), ColumnsBehindMetrics()};
}

Result<RunTable> RunTable::Make(const std::vector<SearchPlan>& plans, ResultStore& store) {
  std::vector<std::vector<std::string>> metrics;
  for (const SearchPlan& plan : plans) {
    TRY(auto names, MetricsOf(plan.id, store));
    metrics.push_back(std::move(names));
  }
  return RunTable(plans, metrics);
}

RunTable::RunTable(const std::vector<SearchPlan>& plans, const std::vector<std::vector<std::string>>& metrics)
    : searches_(plans), columns_(kNumbers), metrics_(plans.size()) {
  Append(searches_.columns(), columns_);
  Append(ColumnsOfTheRun(), columns_);
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const controllers::ScenarioInfo& scenario = controllers::DeclaredScenario(plans[i].experiment);
    untyped_failures_.push_back(scenario.failure_types.untyped);
    for (const std::string& name : metrics[i]) {
      const auto* info = controllers::FindMetric(scenario, name);
      auto column = std::ranges::find(columns_, name, &DataColumn::name);
      if (column == columns_.end()) {
        column = columns_.insert(columns_.end(), {name, std::string(info == nullptr ? "" : info->unit),
                                                  std::string(info == nullptr ? "" : info->description)});
      }
      metrics_[i][name] = {static_cast<std::size_t>(column - columns_.begin()), info};
    }
  }
  Append(ColumnsBehindMetrics(), columns_);
}

Result<std::vector<Value>> RunTable::Row(const StoredRun& run) const {
  const Result<sim::RunResult> result = proto::DecodeStoredResult(run.result);
  if (!result) return InRun(run.id, result.error());
  const bool completed = result->verdict == sim::Verdict::kCompleted;
  const sim::SwarmFailure& failure = result->failure;
  const bool typed = failure.type >= 0;
  const std::string& untyped = untyped_failures_.at(run.search - 1);
  std::vector<Value> cells = {run.id, proto::RunAddress(run.id)};
  cells.reserve(columns_.size());
  Append(searches_.CellsOf(run.search), cells);
  Append(std::initializer_list<Value>{run.individual, std::uint64_t{run.generation},
                                      std::uint64_t{run.evaluation}, std::uint64_t{run.replicate},
                                      fmt::format("{}", run.seed), std::string(NameOf(result->verdict)),
                                      completed ? NumberValue(result->fitness) : Value(), failure.total,
                                      typed ? Value(std::int64_t{failure.type}) : Value(),
                                      TextValue(failure.total && !typed ? untyped : failure.label)},
         cells);

  cells.resize(columns_.size() - ColumnsBehindMetrics().size());
  for (const auto& [name, value] : result->metrics) {
    if (!completed) break;
    const auto metric = metrics_.at(run.search - 1).find(name);
    if (metric == metrics_.at(run.search - 1).end())
      return Error{ErrorKind::kCorrupt,
                   fmt::format("run {} has the metric {}, which its search's first run has not",
                               proto::RunText(run.id), name)};
    if (const auto measured = MeasuredValue(metric->second.info, value))
      cells[metric->second.place] = *measured;
  }
  Append(std::initializer_list<Value>{static_cast<double>(result->ticks) / sim::kTicksPerSecond,
                                      result->cpu_seconds, fmt::format("{:016x}", run.hash), run.worker,
                                      std::uint64_t{run.attempt}, TextValue(result->message)},
         cells);
  return cells;
}

}  // namespace gauntlet
