#include "master/report/run_set.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "controllers/registry.h"
#include "master/directory/campaign_ownership.h"
#include "master/report/csv_column.h"
#include "master/report/stored_check.h"
#include "master/report/stored_search.h"
#include "master/search/search_table.h"
#include "proto/run_codec.h"
#include "sim/random/random_stream.h"

namespace gauntlet::master {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFitness = "fitness";

struct RunValue {
  RunId run = 0;
  IndividualId individual = 0;
  std::uint32_t evaluation = 0;
  std::optional<double> value;  // none: without a result, or nothing to measure
};

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// The metrics that can be compared, for messages.
struct MetricName {
  std::string_view name;
};

Status CheckMetric(const Experiment& experiment, const std::string& metric) {
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment.scenario);
  if (metric == kFitness || scenario == nullptr || controllers::FindMetric(*scenario, metric) != nullptr) {
    return Ok{};
  }
  std::vector<MetricName> known = {{kFitness}};
  for (const controllers::MetricInfo& info : scenario->metrics) known.push_back({info.name});
  return InvalidInput(fmt::format("--metric: {}", UnknownName("metric", metric, known)));
}

std::optional<double> MetricOf(const sim::RunResult& result, const controllers::MetricInfo* info,
                               const std::string& metric) {
  const auto found = std::ranges::find(result.metrics, metric, &std::pair<std::string, double>::first);
  if (found == result.metrics.end() || !std::isfinite(found->second)) return std::nullopt;
  if (info != nullptr && info->may_be_none && found->second == -1.0) return std::nullopt;
  return found->second;
}

// One value for each stored run of a search, in logical order.
Result<std::vector<RunValue>> LoadValues(const Experiment& experiment, SearchId search, ResultStore& store,
                                         const std::string& metric) {
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment.scenario);
  const auto* info = scenario == nullptr ? nullptr : controllers::FindMetric(*scenario, metric);
  std::vector<RunValue> values;
  std::optional<Error> damage;
  const auto take = [&](const StoredRun& run) {
    RunValue& value = values.emplace_back(RunValue{run.id, run.individual, run.evaluation, std::nullopt});
    if (damage || run.verdict != static_cast<int>(sim::Verdict::kCompleted)) return;
    if (metric == kFitness) {
      if (std::isfinite(run.fitness)) value.value = run.fitness;
      return;
    }
    const Result<sim::RunResult> result = proto::DecodeStoredResult(run.result);
    if (!result) {
      damage = result.error();
    } else {
      value.value = MetricOf(*result, info, metric);
    }
  };
  const Status read =
      metric == kFitness ? store.ForEachRow(search, 0, take) : store.ForEachRun(search, 0, take);
  if (!read) return read.error();
  if (damage) return *damage;
  return values;
}

// Of the newest evaluation of each member of the population.
Result<std::vector<RunValue>> FinalValues(const Experiment& experiment, SearchId id, ResultStore& store,
                                          const std::vector<RunValue>& all) {
  const Result<std::unique_ptr<SearchAlgorithm>> search = MakeStoredSearch(experiment, id, store);
  if (!search) return search.error();
  const Result<SavedProgress> saved = RestoreSearch(id, store, **search);
  if (!saved) return saved.error();
  std::map<IndividualId, std::uint32_t> newest;
  for (const Individual& individual : (*search)->Population()) newest[individual.id] = 0;
  const auto counts = [&](const RunValue& run) {
    return run.run <= saved->last_run && newest.contains(run.individual);
  };
  for (const RunValue& run : all) {
    if (counts(run)) newest[run.individual] = std::max(newest[run.individual], run.evaluation);
  }
  std::vector<RunValue> final;
  std::ranges::copy_if(all, std::back_inserter(final), [&](const RunValue& run) {
    return counts(run) && run.evaluation == newest[run.individual];
  });
  return final;
}

// `count` of them, in their order.
Result<std::vector<RunValue>> Drawn(std::vector<RunValue> all, std::uint64_t count, std::uint64_t seed,
                                    const std::string& place) {
  std::erase_if(all, [](const RunValue& run) { return !run.value; });
  if (count > all.size()) {
    return InvalidInput(
        fmt::format("{}: {} runs cannot be drawn from {} that have a value", place, count, all.size()));
  }
  sim::RandomStream random(seed, sim::StreamPurpose::kStatistics, 0, 1);  // the bootstrap's have b = 0
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(all[i], all[i + random.Below(static_cast<std::uint32_t>(all.size() - i))]);
  }
  all.resize(count);
  std::ranges::sort(all, {}, &RunValue::run);
  return all;
}

// One evolution is one unit, as its individuals are relatives; otherwise each case is one.
void AddClusters(const std::vector<RunValue>& runs, bool evolves, RunSet& set) {
  std::map<IndividualId, std::vector<double>> units;
  for (const RunValue& run : runs) {
    if (run.value) units[evolves ? 0 : run.individual].push_back(*run.value);
  }
  for (auto& [individual, values] : units) set.values.clusters.push_back(std::move(values));
}

Status AddSearch(const Experiment& experiment, SearchId id, ResultStore& store, const std::string& place,
                 const Subset& subset, const std::string& metric, RunSet& set) {
  if (Status known = CheckMetric(experiment, metric); !known) return known;
  Result<std::vector<RunValue>> runs = LoadValues(experiment, id, store, metric);
  if (runs && subset.kind == Subset::Kind::kFinal) runs = FinalValues(experiment, id, store, *runs);
  if (runs && subset.kind == Subset::Kind::kRandom) {
    runs = Drawn(*std::move(runs), subset.count, experiment.seed, place);
  }
  if (!runs) return runs.error();
  const auto left_out = std::ranges::count_if(*runs, [](const RunValue& run) { return !run.value; });
  if (left_out > 0) {
    set.notes.push_back(
        fmt::format("{}: {} of {} runs are left out: without a result, or without a value of {}", place,
                    left_out, runs->size(), metric));
  }
  const bool evolves = RowOf(experiment).members == "population";
  AddClusters(*runs, evolves, set);
  const std::string unit = evolves ? "evolution" : "case";
  set.unit = set.unit.empty() || set.unit == unit ? unit : "evolution or case";
  return Ok{};
}

struct SetPart {
  std::string path;
  std::string rest;  // behind the colon
};

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

Status AddCampaign(const SetPart& part, const std::string& metric, RunSet& set) {
  const Result<Subset> subset = ParseSubset(part.rest, part.path);
  if (!subset) return subset.error();
  const Result<CampaignView> view = ViewCampaign(part.path, Checked::kRows);
  if (!view) return view.error();
  const Result<std::vector<SearchPlan>> plans = ReadSearchPlans(view->directory);
  if (!plans) return plans.error();
  if (Status whole = CheckStored(*plans, *view->store, Checked::kRows); !whole) return whole;
  if (view->lock == nullptr) {
    set.notes.push_back(fmt::format("{} is being written: its runs {}", part.path,
                                    view->as_of.empty() ? "as they were stored just now" : view->as_of));
  }
  Result<proto::GoldenHashes> hashes = proto::ReadGoldenHashes(view->store->meta().golden_hashes);
  if (!hashes) return hashes.error();
  const RunOrigin campaign{part.path, {}, view->store->meta().software_version, *std::move(hashes)};
  return AddRuns(*plans, *view->store, campaign, *subset, metric, set);
}

Status AddCsv(const SetPart& part, const std::string& metric, RunSet& set) {
  const Result<std::vector<double>> values = ReadCsvColumn(part.path, part.rest.empty() ? metric : part.rest);
  if (!values) return values.error();
  for (const double value : *values) set.values.clusters.push_back({value});
  set.unit = set.unit.empty() || set.unit == "row" ? "row" : set.unit + " or row";
  return Ok{};
}

}  // namespace

Result<Subset> ParseSubset(const std::string& text, const std::string& place) {
  const Error wrong = InvalidInput(fmt::format(
      "{}: no subset '{}'; known: final, all, random:N, and search:N in front of them", place, text));
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
  const auto count =
      words.size() == 2 && words[0] == "random" ? ParseNumber<std::uint64_t>(words[1]) : std::nullopt;
  if (!count || *count == 0) return wrong;
  subset.kind = Subset::Kind::kRandom;
  subset.count = *count;
  return subset;
}

Status AddRuns(const std::vector<SearchPlan>& plans, ResultStore& store, const RunOrigin& campaign,
               const Subset& subset, const std::string& metric, RunSet& set) {
  if (subset.search > plans.size()) {
    return InvalidInput(fmt::format("{} has no search {}: its searches are 1 to {}", campaign.place,
                                    subset.search, plans.size()));
  }
  const Result<std::vector<StoredSearch>> stored = store.LoadSearches();
  if (!stored) return stored.error();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const auto id = static_cast<SearchId>(i + 1);
    if (subset.search != 0 && subset.search != id) continue;
    RunOrigin origin = campaign;
    origin.experiment = plans[i].experiment;
    if (plans.size() > 1) origin.place += fmt::format(":search:{}", id);
    if (Status added = AddSearch(origin.experiment, id, store, origin.place, subset, metric, set); !added) {
      return added;
    }
    const Result<std::unique_ptr<SearchAlgorithm>> search = MakeStoredSearch(origin.experiment, id, store);
    if (!search) return search.error();
    const bool finished = std::ranges::any_of(*stored, [&](const StoredSearch& one) {
      return one.id == id && HasFinished(one, origin.experiment, **search);
    });
    if (!finished) set.notes.push_back(origin.place + " is half-finished: what it has so far is compared");
    set.origins.push_back(std::move(origin));
  }
  return Ok{};
}

Result<RunSet> ReadRunSet(const std::string& text, const std::string& metric) {
  RunSet set;
  set.values.name = text;
  std::error_code error;
  for (const std::string& one : fs::exists(text, error) ? std::vector{text} : Split(text, ',')) {
    const Result<SetPart> part = SplitPart(one);
    if (!part) return part.error();
    const Status added =
        fs::is_directory(part->path, error) ? AddCampaign(*part, metric, set) : AddCsv(*part, metric, set);
    if (!added) return added.error();
  }
  return set;
}

std::vector<std::string> WhatDiffers(const RunSet& first, const RunSet& second) {
  std::vector<const RunOrigin*> origins;
  for (const RunSet* set : {&first, &second}) {
    for (const RunOrigin& origin : set->origins) origins.push_back(&origin);
  }
  std::vector<std::string> differences;
  for (const RunOrigin* origin : origins) {
    const RunOrigin& base = *origins.front();
    const auto differs = [&](const std::string& what, const std::string& there, const std::string& here) {
      differences.push_back(
          fmt::format("{}: {} has {}, {} has {}", what, base.place, there, origin->place, here));
    };
    if (origin->experiment.scenario != base.experiment.scenario) {
      differs("scenario", base.experiment.scenario, origin->experiment.scenario);
      continue;
    }
    for (const auto& [name, value] : base.experiment.scenario_parameters) {
      const auto other = origin->experiment.scenario_parameters.find(name);
      if (other != origin->experiment.scenario_parameters.end() && other->second == value) continue;
      differs(
          "scenario_parameters." + name, fmt::format("{}", value),
          other == origin->experiment.scenario_parameters.end() ? "none" : fmt::format("{}", other->second));
    }
    if (origin->software_version != base.software_version) {
      differs("version", base.software_version, origin->software_version);
    }
    for (const auto& [controller, hash] : base.golden_hashes) {
      const auto other = origin->golden_hashes.find(controller);
      if (other == origin->golden_hashes.end() || other->second == hash) continue;
      differs("golden hash of controller " + controller, fmt::format("{:016x}", hash),
              fmt::format("{:016x}", other->second));
    }
  }
  return differences;
}

}  // namespace gauntlet::master
