#include "master/campaign/campaign_summary.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>

#include "controllers/registry.h"
#include "master/campaign/campaign_status.h"
#include "master/campaign/state_digest.h"
#include "master/campaign/stored_search.h"
#include "master/campaign/verdict_text.h"
#include "master/store/event_kinds.h"
#include "search/evolution/population_search.h"
#include "search/failure_tally.h"
#include "sim/arena/genome.h"
#include "sim/run_result.h"

namespace gauntlet {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// What its scenario declares of failures.
void TakeFromScenario(const Experiment& experiment, CampaignSummary& summary) {
  if (const auto* scenario = controllers::FindScenario(experiment)) {
    for (const controllers::FailureType& one : scenario->failure_types)
      summary.failure_types.push_back({one.type, one.name});
    summary.untyped = scenario->untyped_failure;
    summary.failure_note = scenario->failure_note;
    if (FailingNeedsMetrics(scenario->failing))
      summary.failing = controllers::FindMetric(*scenario, scenario->failing)->description;
  }
}

void AddToGeneration(const StoredRun& run, std::map<std::uint32_t, GenerationSummary>& generations) {
  GenerationSummary& generation = generations[run.generation];
  generation.generation = run.generation;
  ++generation.runs;
  if (run.total_failure) ++generation.total_failures;
  if (run.verdict != static_cast<int>(sim::Verdict::kCompleted)) return;
  if (generation.completed == 0) generation.best = generation.worst = run.fitness;
  generation.best = std::min(generation.best, run.fitness);
  generation.worst = std::max(generation.worst, run.fitness);
  ++generation.completed;
  generation.mean += (run.fitness - generation.mean) / static_cast<double>(generation.completed);
}

void AddToFailures(const StoredRun& run, CampaignSummary& summary) {
  if (run.verdict != static_cast<int>(sim::Verdict::kCompleted)) ++summary.runs_failed;
  if (!run.total_failure) return;
  ++summary.total_failures;
  const auto counted = std::ranges::find(summary.failure_types, run.failure_type, &FailureCount::type);
  ++(counted != summary.failure_types.end() ? counted->runs : summary.untyped_failures);
}

Result<bool> IsFailing(const StoredRun& run, const Experiment& experiment) {
  TRY(const RunOutcome outcome, OutcomeOf(run, /*with_metrics=*/true));
  FailureTally tally;
  tally.Add(outcome, FailingOf(experiment));
  return tally.failures > 0;
}

void AddToRunsWithoutResult(const StoredRun& run, std::vector<RunsWithoutResult>& groups) {
  if (run.verdict == static_cast<int>(sim::Verdict::kCompleted)) return;
  const std::string& message = run.message;
  const auto verdict = static_cast<sim::Verdict>(run.verdict);
  const std::string rule = RuleOf(message);
  auto group = std::ranges::find_if(groups, [&](const RunsWithoutResult& one) {
    return one.verdict == verdict && one.rule == rule && (!rule.empty() || one.message == message);
  });
  if (group == groups.end()) group = groups.insert(groups.end(), {verdict, rule, message, 0, run.id});
  ++group->runs;
}

// What every run of the campaign depends on; how test cases are found is part of the search's own state.
std::string EncodeExperiment(const Experiment& experiment) {
  CanonicalEncoder encoder;
  encoder.Uint(experiment.seed);
  encoder.String(experiment.scenario);
  encoder.String(experiment.controller);
  for (const sim::Parameters* parameters :
       {&experiment.scenario_parameters, &experiment.controller_parameters}) {
    encoder.Uint(parameters->size());
    for (const auto& [name, value] : *parameters) {
      encoder.String(name);
      encoder.Double(value);
    }
  }
  for (const auto& [key, value] : sim::DisturbanceTexts(experiment.disturbances)) {
    encoder.String(key);
    encoder.String(value);
  }
  if (!experiment.plugin.empty()) {
    encoder.String("plugin");
    encoder.String(experiment.plugin);
  }
  if (!experiment.scenario_plugin.empty()) {
    encoder.String("scenario_plugin");
    encoder.String(experiment.scenario_plugin);
  }
  if (!experiment.definition.empty()) {
    encoder.String("definition");
    encoder.String(experiment.definition);
  }
  return encoder.Take();
}

std::string EncodePopulation(const std::vector<Individual>& population) {
  CanonicalEncoder encoder;
  encoder.Uint(population.size());
  for (const Individual& individual : population) {
    encoder.Uint(individual.id);
    encoder.Double(individual.fitness);
    sim::EncodeGenome(individual.test_case.obstacles, encoder);
  }
  return encoder.Take();
}

// Totals over searches; what has no meaning over several stays empty.
CampaignSummary TotalsOf(const std::vector<CampaignSummary>& searches) {
  CampaignSummary totals;
  totals.experiment = searches.front().experiment;
  totals.search = "sweep";
  totals.seed = searches.front().seed;
  totals.finished = true;
  totals.progress.finished = true;
  totals.best_fitness = totals.mean_fitness = totals.worst_fitness = kNone;
  for (const CampaignSummary& one : searches) {
    totals.runs_done += one.runs_done;
    totals.runs_failed += one.runs_failed;
    totals.total_failures += one.total_failures;
    totals.distinct_individuals += one.distinct_individuals;
    Add(one.progress, totals.progress);
    totals.finished = totals.finished && one.finished;
    totals.plugin_controllers.insert(one.plugin_controllers.begin(), one.plugin_controllers.end());
    totals.nondeterministic = std::max(totals.nondeterministic, one.nondeterministic);  // each has all
    totals.lone_verdicts = std::max(totals.lone_verdicts, one.lone_verdicts);           // likewise
    totals.best_fitness = std::fmin(totals.best_fitness, one.best_fitness);
    totals.worst_fitness = std::fmax(totals.worst_fitness, one.worst_fitness);
  }
  totals.progress.finished = totals.finished;
  return totals;
}

Result<std::uint64_t> CountEvents(ResultStore& store, const char* kind) {
  TRY(const std::vector<StoredEvent> events, store.LoadEvents());
  return static_cast<std::uint64_t>(std::ranges::count(events, kind, &StoredEvent::kind));
}

}  // namespace

Result<std::uint64_t> CountNondeterministic(ResultStore& store) {
  return CountEvents(store, event::kNondeterministic);
}

Result<std::uint64_t> CountLoneVerdicts(ResultStore& store) {
  return CountEvents(store, event::kRunGivenUpAlone);
}

Result<CampaignSummary> Summarise(const Experiment& experiment, SearchId search_id, SearchAlgorithm& search,
                                  ResultStore& store) {
  CampaignSummary summary;
  summary.experiment = experiment.name;
  summary.search = experiment.search.algorithm;
  summary.seed = experiment.seed;
  TakeFromScenario(experiment, summary);

  TRY(const SavedProgress saved, RestoreSearch(search_id, store, search));
  {
    TRY(const std::vector<Individual> individuals, store.LoadIndividuals(search_id));
    summary.distinct_individuals = CountDistinctGenomes(individuals);
  }

  std::map<IndividualId, std::vector<RunId>> runs_of;
  std::map<std::uint32_t, GenerationSummary> generations;
  const auto take = [&](const StoredRun& run) -> Status {
    ++summary.runs_done;
    runs_of[run.individual].push_back(run.id);
    AddToFailures(run, summary);
    AddToRunsWithoutResult(run, summary.runs_without_result);
    AddToGeneration(run, generations);
    if (summary.failing.empty()) return Ok{};
    TRY(const bool failing, IsFailing(run, experiment));
    if (failing) ++summary.failing_runs;
    return Ok{};
  };
  TRY(summary.failing.empty() ? store.ForEachRow(search_id, 0, take) : store.ForEachRun(search_id, 0, take));
  std::ranges::stable_sort(summary.runs_without_result, std::greater(), &RunsWithoutResult::runs);
  for (const auto& [number, generation] : generations) summary.generations.push_back(generation);

  summary.progress = search.Progress();
  summary.statistics = search.Statistics();
  summary.archive = search.Archive();
  summary.statistics.insert(summary.statistics.begin(),
                            {"distinct_individuals", static_cast<double>(summary.distinct_individuals)});

  const std::vector<Individual>& population = search.Population();
  double sum = 0.0;
  double counted = 0.0;
  summary.best_fitness = summary.mean_fitness = summary.worst_fitness = kNone;
  for (const Individual& individual : population) {
    summary.population.push_back({individual.id, individual.parents, individual.birth_generation,
                                  individual.fitness, individual.test_case.obstacles, runs_of[individual.id],
                                  individual.test_case.name});
    if (!std::isfinite(individual.fitness)) continue;
    summary.best_fitness = std::fmin(summary.best_fitness, individual.fitness);
    summary.worst_fitness = std::fmax(summary.worst_fitness, individual.fitness);
    sum += individual.fitness;
    counted += 1.0;
  }
  if (counted > 0.0) summary.mean_fitness = sum / counted;

  summary.state_hash =
      StateHash(EncodeExperiment(experiment), saved.results, EncodePopulation(population), saved.state);
  TRY(summary.nondeterministic, CountNondeterministic(store));
  if (!experiment.plugin.empty()) summary.plugin_controllers.insert(experiment.controller);
  TRY(summary.lone_verdicts, CountLoneVerdicts(store));
  TRY(std::vector<StoredSearch> searches, store.LoadSearches());
  summary.finished = std::ranges::any_of(searches, [&](const StoredSearch& stored) {
    return stored.id == search_id && HasFinished(stored, experiment, search);
  });
  return summary;
}

Result<CampaignSummary> SummariseTotals(const std::vector<SearchPlan>& plans, ResultStore& store) {
  TRY(const std::vector<SearchTotals> totals, store.LoadTotals());
  TRY(const std::vector<StoredSearch> stored, store.LoadSearches());
  std::vector<CampaignSummary> searches(plans.size());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const SearchId id = plans[i].id;
    CampaignSummary& summary = searches[i];
    summary.experiment = plans[i].experiment.name;
    TRY(const std::unique_ptr<SearchAlgorithm> search, MakeStoredSearch(plans[i], store));
    TRY(const std::optional<SavedState> state, store.LoadNewestState(id));
    summary.progress = search->Progress();
    if (state) summary.progress.generation = state->generation;
    const auto mine = std::ranges::find(totals, id, &SearchTotals::search);
    if (mine == totals.end()) continue;
    summary.runs_done = mine->runs;
    summary.runs_failed = mine->runs_failed;
    summary.total_failures = mine->total_failures;
    const auto known = std::ranges::find(stored, id, &StoredSearch::id);
    summary.finished = known != stored.end() && HasFinished(*known, plans[i].experiment, *search);
  }
  CampaignSummary all = TotalsOf(searches);
  TRY(all.nondeterministic, CountNondeterministic(store));
  return all;
}

Result<CampaignSummary> Summarise(const std::vector<SearchPlan>& plans, ResultStore& store) {
  std::vector<CampaignSummary> searches;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const SearchId id = plans[i].id;
    TRY(const std::unique_ptr<SearchAlgorithm> search, MakeStoredSearch(plans[i], store));
    TRY(CampaignSummary summary, Summarise(plans[i].experiment, id, *search, store));
    summary.settings = plans[i].settings;
    searches.push_back(std::move(summary));
  }
  if (plans.size() == 1) return std::move(searches.front());
  CampaignSummary totals = TotalsOf(searches);
  totals.searches = std::move(searches);
  return totals;
}

}  // namespace gauntlet
