#include "master/session/campaign_searches.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/system/atomic_file.h"
#include "master/experiment/experiment_file.h"
#include "master/search/case_list_search.h"
#include "master/search/make_search.h"
#include "master/session/search_driver.h"

namespace gauntlet::master {
namespace {

constexpr int kListFormat = 1;
constexpr std::size_t kMostListBytes = std::size_t{64} << 20;

Error BadList(const std::string& path, const std::string& what) {
  return {ErrorKind::kCorrupt, fmt::format("{}: {}", path, what)};
}

// Totals over searches; what has no meaning over several stays empty.
CampaignSummary TotalsOf(const std::vector<CampaignSummary>& searches) {
  CampaignSummary totals;
  totals.experiment = searches.front().experiment;
  totals.search = "sweep";
  totals.seed = searches.front().seed;
  totals.finished = true;
  totals.progress.finished = true;
  constexpr double kNoFitness = std::numeric_limits<double>::quiet_NaN();
  totals.best_fitness = totals.mean_fitness = totals.worst_fitness = kNoFitness;
  for (const CampaignSummary& one : searches) {
    totals.runs_done += one.runs_done;
    totals.runs_failed += one.runs_failed;
    totals.total_failures += one.total_failures;
    totals.distinct_individuals += one.distinct_individuals;
    totals.progress.generation += one.progress.generation;
    totals.progress.generations += one.progress.generations;
    totals.progress.evaluations_done += one.progress.evaluations_done;
    totals.progress.evaluations_planned += one.progress.evaluations_planned;
    totals.finished = totals.finished && one.finished;
    totals.nondeterministic = std::max(totals.nondeterministic, one.nondeterministic);  // each has all
    totals.best_fitness = std::fmin(totals.best_fitness, one.best_fitness);
    totals.worst_fitness = std::fmax(totals.worst_fitness, one.worst_fitness);
  }
  totals.progress.finished = totals.finished;
  return totals;
}

}  // namespace

std::string WriteSearchPlans(const std::vector<SearchPlan>& plans) {
  nlohmann::ordered_json searches = nlohmann::ordered_json::array();
  for (const SearchPlan& plan : plans)
    searches.push_back({{"settings", plan.settings}, {"experiment", WriteExperiment(plan.experiment, {})}});
  return nlohmann::ordered_json{{"format", kListFormat}, {"searches", std::move(searches)}}.dump(1) + "\n";
}

Result<std::vector<SearchPlan>> ReadSearchPlans(const CampaignDirectory& directory) {
  std::vector<SearchPlan> plans;
  const auto add = [&](const std::string& settings, const std::string& text,
                       const std::string& place) -> Status {
    Result<Experiment> experiment = ParseExperiment(text, place, {});
    if (!experiment) return experiment.error();
    plans.push_back({settings, *std::move(experiment)});
    return Ok{};
  };
  const std::string path = directory.searches_path();
  const Result<std::string> list = ReadSmallFile(path, kMostListBytes);
  if (!list) {
    if (list.error().kind != ErrorKind::kNotFound) return list.error();
    const Result<std::string> text = ReadSmallFile(directory.experiment_path());
    if (!text) return text.error();
    if (Status added = add("", *text, directory.experiment_path()); !added) return added.error();
    return plans;
  }
  const nlohmann::json json = nlohmann::json::parse(*list, nullptr, /*allow_exceptions=*/false);
  const bool is_list = json.is_object() && json.contains("format") && json["format"] == kListFormat &&
                       json.contains("searches") && json["searches"].is_array();
  if (!is_list) return BadList(path, fmt::format("is no list of searches in format {}", kListFormat));
  for (const nlohmann::json& search : json["searches"]) {
    const auto is_text = [&](const char* key) { return search.contains(key) && search[key].is_string(); };
    if (!search.is_object() || !is_text("experiment") || !is_text("settings"))
      return BadList(path, "a search without settings or an experiment");
    const Status added = add(search["settings"], search["experiment"], path);
    if (!added) return added.error();
  }
  if (plans.empty()) return BadList(path, "no searches");
  return plans;
}

Result<std::unique_ptr<SearchAlgorithm>> MakeStoredSearch(const Experiment& experiment, SearchId id,
                                                          ResultStore& store) {
  if (experiment.search.kind != SearchKind::kCases) return MakeSearch(experiment, kOnlySearch);
  Result<std::vector<Individual>> individuals = store.LoadIndividuals(id);
  if (!individuals) return individuals.error();
  if (individuals->empty()) {
    return Error{ErrorKind::kCorrupt,
                 "the campaign was stopped before its cases were stored: evaluate them anew"};
  }
  std::vector<sim::TestCase> cases;
  for (Individual& individual : *individuals) cases.push_back(std::move(individual.test_case));
  return std::unique_ptr<SearchAlgorithm>(
      std::make_unique<CaseListSearch>(std::move(cases), experiment.search.replicates));
}

Result<std::vector<StoredSearch>> AddSearches(const std::vector<SearchPlan>& plans, ResultStore& store) {
  Result<std::vector<StoredSearch>> known = store.LoadSearches();
  if (!known) return known;
  // A master may have died between creating the campaign and storing its searches.
  for (std::size_t i = known->size(); i < plans.size(); ++i) {
    const Experiment& experiment = plans[i].experiment;
    std::string name = experiment.name;
    if (!plans[i].settings.empty()) name += ": " + plans[i].settings;
    store.AddSearch({static_cast<SearchId>(i + 1), name, std::string(NameOf(experiment.search.kind)),
                     experiment.seed, false});
  }
  return known;
}

Result<CampaignSummary> SummariseAll(const std::vector<SearchPlan>& plans, ResultStore& store) {
  std::vector<CampaignSummary> searches;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const auto id = static_cast<SearchId>(i + 1);
    const Result<std::unique_ptr<SearchAlgorithm>> search = MakeStoredSearch(plans[i].experiment, id, store);
    if (!search) return search.error();
    Result<CampaignSummary> summary = Summarise(plans[i].experiment, id, **search, store);
    if (!summary) return summary;
    summary->settings = plans[i].settings;
    searches.push_back(*std::move(summary));
  }
  if (plans.size() == 1) return std::move(searches.front());
  CampaignSummary totals = TotalsOf(searches);
  totals.searches = std::move(searches);
  return totals;
}

}  // namespace gauntlet::master
