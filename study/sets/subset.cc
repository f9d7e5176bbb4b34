#include "study/sets/subset.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "controllers/registry.h"
#include "master/campaign/stored_campaign.h"
#include "master/campaign/stored_search.h"
#include "proto/run_codec.h"
#include "search/search_table.h"
#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFitness = "fitness";
constexpr const char* kFailureType = "failure_type";

bool IsColumn(const std::string& metric) {
  return metric == kFitness || metric == controllers::kTotalFailure || metric == kFailureType;
}

// What the row of a run with a result says of it.
std::optional<double> ColumnOf(const StoredRun& run, const std::string& metric) {
  if (metric == controllers::kTotalFailure) return run.total_failure ? 1.0 : 0.0;
  if (metric == kFailureType) {
    return run.total_failure && run.failure_type >= 0 ? std::optional<double>(run.failure_type)
                                                      : std::nullopt;
  }
  return std::isfinite(run.fitness) ? std::optional(run.fitness) : std::nullopt;
}

std::optional<double> MetricOf(const sim::RunResult& result, const controllers::MetricInfo* info,
                               const std::string& metric) {
  const std::optional<double> value = controllers::ReportedValue(result.metrics, metric);
  return value ? MeasuredValue(info, *value) : std::nullopt;
}

// One value for each stored run of a search, in logical order.
Result<std::vector<SelectedRun>> LoadValues(const SearchPlan& plan, ResultStore& store,
                                            const std::string& metric) {
  const auto* info = controllers::FindMetric(controllers::DeclaredScenario(plan.experiment), metric);
  std::vector<SelectedRun> values;
  const auto take = [&](const StoredRun& run) -> Status {
    SelectedRun& value = values.emplace_back(
        SelectedRun{run.id, run.individual, run.evaluation, run.generation, std::nullopt});
    if (!run.completed()) return Ok{};
    if (IsColumn(metric)) {
      value.value = ColumnOf(run, metric);
      return Ok{};
    }
    TRY(const sim::RunResult result, proto::DecodeStoredResult(run.result));
    value.value = MetricOf(result, info, metric);
    return Ok{};
  };
  TRY(IsColumn(metric) ? store.ForEachRow(plan.id, 0, take) : store.ForEachRun(plan.id, 0, take));
  return values;
}

// Of the newest evaluation of each member of the population.
Result<std::vector<SelectedRun>> FinalValues(const SearchPlan& plan, ResultStore& store,
                                             const std::vector<SelectedRun>& all) {
  TRY(const auto search, MakeStoredSearch(plan, store, /*restored=*/true));
  TRY(const auto saved, RestoreSearch(plan.id, store, *search));
  std::map<IndividualId, std::uint32_t> newest;
  for (const Individual& individual : search->Population()) newest[individual.id] = 0;
  const auto counts = [&](const SelectedRun& run) {
    return run.run <= saved.last_run && newest.contains(run.individual);
  };
  for (const SelectedRun& run : all) {
    if (counts(run)) newest[run.individual] = std::max(newest[run.individual], run.evaluation);
  }
  std::vector<SelectedRun> final;
  std::ranges::copy_if(all, std::back_inserter(final), [&](const SelectedRun& run) {
    return counts(run) && run.evaluation == newest[run.individual];
  });
  return final;
}

Status CheckEnough(const std::vector<SelectedRun>& runs, std::uint64_t count, const std::string& place) {
  if (count <= runs.size()) return Ok{};
  return InvalidInput(
      fmt::format("{}: {} runs cannot be taken from {} that have a value", place, count, runs.size()));
}

// `count` of them, in their order.
Result<std::vector<SelectedRun>> Drawn(std::vector<SelectedRun> all, std::uint64_t count, std::uint64_t seed,
                                       const std::string& place) {
  std::erase_if(all, [](const SelectedRun& run) { return !run.value; });
  TRY(CheckEnough(all, count, place));
  sim::RandomStream random(seed, sim::StreamPurpose::kStatistics, 0, 1);  // the bootstrap's have b = 0
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(all[i], all[i + random.Below(static_cast<std::uint32_t>(all.size() - i))]);
  }
  all.resize(count);
  std::ranges::sort(all, {}, &SelectedRun::run);
  return all;
}

// The `count` of lowest value, of equal ones the earlier; in their order.
Result<std::vector<SelectedRun>> Lowest(std::vector<SelectedRun> all, std::uint64_t count,
                                        const std::string& place) {
  std::erase_if(all, [](const SelectedRun& run) { return !run.value; });
  TRY(CheckEnough(all, count, place));
  std::ranges::stable_sort(all, {}, [](const SelectedRun& run) { return *run.value; });
  all.resize(count);
  std::ranges::sort(all, {}, &SelectedRun::run);
  return all;
}

// The path is the longest beginning that exists, so that it may hold colons.
Result<SetPart> SplitPart(const std::string& text) {
  std::error_code error;
  for (std::size_t end = text.size(); end != std::string::npos && end > 0; end = text.rfind(':', end - 1)) {
    const std::string path = text.substr(0, end);
    if (fs::exists(path, error)) return SetPart{path, end < text.size() ? text.substr(end + 1) : ""};
  }
  return Error{ErrorKind::kNotFound,
               fmt::format("{}: no such campaign or CSV file (DIR, DIR:final, DIR:all, DIR:random:100, "
                           "DIR:search:2:final, FILE.csv:COLUMN)",
                           text)};
}

}  // namespace

std::optional<double> MeasuredValue(const controllers::MetricInfo* info, double value) {
  if (!std::isfinite(value) || (info != nullptr && info->none == value)) return std::nullopt;
  return value;
}

Result<Subset> ParseSubset(const std::string& text, const std::string& place) {
  const Error wrong = InvalidInput(
      fmt::format("{}: no subset '{}'; known: final, all, random:N, worst:N, and search:N in front of them",
                  place, text));
  Subset subset;
  if (text.empty()) return subset;
  std::vector<std::string> words = Split(text, ':');
  if (words.front() == "search") {
    const auto number = words.size() > 1 ? ParseNumber<std::uint32_t>(words[1]) : std::nullopt;
    if (!number || *number == 0) return wrong;
    subset.search = *number;
    words.erase(words.begin(), words.begin() + 2);
    if (words.empty()) return subset;
  }
  if (words.size() == 1 && words[0] == "final") return subset;
  if (words.size() == 1 && words[0] == "all") {
    subset.kind = Subset::Kind::kAll;
    return subset;
  }
  const auto count = words.size() == 2 && (words[0] == "random" || words[0] == "worst")
                         ? ParseNumber<std::uint64_t>(words[1])
                         : std::nullopt;
  if (!count || *count == 0) return wrong;
  subset.kind = words[0] == "random" ? Subset::Kind::kRandom : Subset::Kind::kWorst;
  subset.count = *count;
  return subset;
}

Result<std::vector<SetPart>> SplitSet(const std::string& text) {
  std::error_code error;
  std::vector<SetPart> parts;
  for (const std::string& one : fs::exists(text, error) ? std::vector{text} : Split(text, ',')) {
    TRY(auto part, SplitPart(one));
    const auto same = [&](const SetPart& other) {
      return other.rest == part.rest && fs::equivalent(other.path, part.path, error);
    };
    if (std::ranges::any_of(parts, same))
      return InvalidInput(fmt::format("{} is in the set '{}' twice: its runs would count twice", one, text));
    parts.push_back(std::move(part));
  }
  return parts;
}

Status CheckOneSetting(const std::vector<SearchPlan>& plans, const std::string& place, ResultStore* store) {
  const auto varies = [](const SearchPlan& plan) { return RowOf(plan.experiment).varies_settings; };
  const auto one = std::ranges::find_if(plans, varies);
  if (one == plans.end()) return Ok{};
  if (RowOf(one->experiment).streamed && store != nullptr) {
    TRY(const std::vector<StoredLine> lines, store->LoadLines(one->id, 0));
    if (std::ranges::none_of(lines, &StoredLine::HasSettings)) return Ok{};
    return InvalidInput(
        place +
        ": lines of it had settings of their own, so its runs are neither one set nor cases for other runs");
  }
  return InvalidInput(fmt::format(
      "{} is a {}: its runs have different settings, so they are neither one set nor cases for other runs",
      place, RowOf(one->experiment).command));
}

Result<OpenedSubset> OpenSubset(const SetPart& part) {
  TRY(const auto subset, ParseSubset(part.rest, part.path));
  TRY(auto stored, OpenStoredCampaign(part.path));
  return OpenedSubset{std::move(stored.view), std::move(stored.plans), subset,
                      std::move(stored.being_written)};
}

Status ForEachSearch(const std::vector<SearchPlan>& plans, ResultStore& store, const std::string& place,
                     const Subset& subset, const std::function<Status(const SubsetSearch&)>& visit) {
  if (subset.search > plans.size()) {
    return InvalidInput(
        fmt::format("{} has no search {}: its searches are 1 to {}", place, subset.search, plans.size()));
  }
  TRY(const auto stored, store.LoadSearches());
  for (const SearchPlan& plan : plans) {
    const SearchId id = plan.id;
    if (subset.search != 0 && subset.search != id) continue;
    TRY(const auto search, MakeStoredSearch(plan, store));
    const bool finished = std::ranges::any_of(stored, [&](const StoredSearch& one) {
      return one.id == id && HasFinished(one, plan.experiment, *search);
    });
    const std::string name = plans.size() > 1 ? fmt::format("{}:search:{}", place, id) : place;
    TRY(visit({plan, name, finished}));
  }
  return Ok{};
}

Status CheckMetric(const Experiment& experiment, const std::string& metric) {
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment);
  if (IsColumn(metric) || scenario == nullptr || controllers::FindMetric(*scenario, metric) != nullptr) {
    return Ok{};
  }
  std::vector<std::string_view> known = {kFitness, controllers::kTotalFailure, kFailureType};
  for (const controllers::MetricInfo& info : scenario->metrics) known.push_back(info.name);
  return InvalidInput(UnknownName("metric", metric, known));
}

Result<std::vector<SelectedRun>> SelectRuns(const SubsetSearch& search, ResultStore& store,
                                            const Subset& subset, const std::string& metric) {
  TRY(CheckMetric(search.plan.experiment, metric));
  // What is chosen by its fitness is chosen before the metric is looked at.
  const bool worst = subset.kind == Subset::Kind::kWorst;
  Result<std::vector<SelectedRun>> runs = LoadValues(search.plan, store, metric);
  if (runs && subset.kind == Subset::Kind::kFinal) {
    return FinalValues(search.plan, store, *runs);
  }
  if (runs && subset.kind == Subset::Kind::kRandom) {
    return Drawn(*std::move(runs), subset.count, search.plan.experiment.seed, search.place);
  }
  if (!runs || !worst) return runs;
  Result<std::vector<SelectedRun>> by_fitness = LoadValues(search.plan, store, kFitness);
  if (by_fitness) by_fitness = Lowest(*std::move(by_fitness), subset.count, search.place);
  if (!by_fitness) return by_fitness;
  std::erase_if(*runs, [&](const SelectedRun& run) {
    return !std::ranges::binary_search(*by_fitness, run.run, {}, &SelectedRun::run);
  });
  return runs;
}

}  // namespace gauntlet
