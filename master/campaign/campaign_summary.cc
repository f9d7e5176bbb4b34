#include "master/campaign/campaign_summary.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "controllers/registry.h"
#include "master/campaign/state_digest.h"
#include "master/campaign/stored_check.h"
#include "master/campaign/stored_search.h"
#include "master/campaign/verdict_text.h"
#include "master/store/event_kinds.h"
#include "search/evolution/population_search.h"
#include "search/failure_tally.h"
#include "sim/arena/genome.h"
#include "sim/run_result.h"

namespace gauntlet {
namespace {

// What it is, before a run is looked at.
SearchSummary Described(const Experiment& experiment) {
  SearchSummary summary;
  summary.search = experiment.search.algorithm;
  summary.seed = experiment.seed;
  const controllers::ScenarioInfo& scenario = controllers::DeclaredScenario(experiment);
  summary.types = scenario.failure_types;
  if (FailingNeedsMetrics(scenario.failing))
    summary.failing = controllers::FindMetric(scenario, scenario.failing)->description;
  return summary;
}

void AddToRunsWithoutResult(const StoredRun& run, std::vector<RunsWithoutResult>& groups) {
  const std::string& message = run.message;
  const std::string rule = RuleOf(message);
  auto group = std::ranges::find_if(groups, [&](const RunsWithoutResult& one) {
    return one.verdict == run.verdict && one.rule == rule && (!rule.empty() || one.message == message);
  });
  if (group == groups.end()) group = groups.insert(groups.end(), {run.verdict, rule, message, 0, run.id});
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
  if (!experiment.requirements.empty()) {
    encoder.String("requirements");
    encoder.String(experiment.requirements);
  }
  return encoder.Take();
}

std::string EncodePopulation(const std::vector<Individual>& population) {
  CanonicalEncoder encoder;
  if (!population.empty()) {
    constexpr std::size_t kBytesOfAnObstacle = 40;
    const std::size_t obstacles = population.front().test_case.obstacles.size();
    encoder.Reserve(population.size() * (24 + obstacles * kBytesOfAnObstacle));
  }
  encoder.Uint(population.size());
  for (const Individual& individual : population) {
    encoder.Uint(individual.id);
    encoder.Double(individual.fitness);
    sim::EncodeGenome(individual.test_case.obstacles, encoder);
  }
  return encoder.Take();
}

struct RunOfCase {
  IndividualId individual = 0;
  RunId id = 0;
  bool failing = false;
};

// Brings the search to its newest state, and takes everything that is told of its stored runs.
Result<SavedProgress> RestoreAndAddRuns(const SearchPlan& plan, ResultStore& store, bool check,
                                        SearchAlgorithm& search, SearchSummary& summary,
                                        std::vector<RunOfCase>& runs_of) {
  const Experiment& experiment = plan.experiment;
  std::optional<RowCheck> rows;
  if (check) {
    TRY(rows, RowCheck::Begin(plan, store));
  }
  const std::string_view failing = FailingOf(experiment);
  std::map<std::uint32_t, GenerationSummary> generations;
  const auto add = [&](const StoredRun& run, const RunOutcome& outcome) -> Status {
    if (rows) {
      TRY(rows->Take(run));
    }
    const bool completed = outcome.verdict == sim::Verdict::kCompleted;
    GenerationSummary& generation = generations[run.generation];
    generation.generation = run.generation;
    ++generation.runs;
    ++summary.runs_done;
    const bool fails = completed && Fails(outcome, failing);
    runs_of.push_back({run.individual, run.id, fails});
    if (completed) generation.fitness.Add(run.fitness);
    if (!completed) ++summary.runs_failed;
    if (!completed) AddToRunsWithoutResult(run, summary.runs_without_result);
    if (fails) ++summary.failing_runs;
    if (!run.total_failure) return Ok{};
    ++summary.total_failures;
    ++generation.total_failures;
    if (summary.types.Find(run.failure_type) != nullptr) {
      ++summary.runs_of_type[run.failure_type];
    } else {
      ++summary.untyped_failures;
    }
    return Ok{};
  };
  TRY(SavedProgress saved,
      RestoreSearch(plan.id, store, search,
                    {.take = add, .with_metrics = FailingNeedsMetrics(failing), .end = [&] {
                       return rows ? rows->End() : Status(Ok{});
                     }}));
  std::ranges::stable_sort(summary.runs_without_result, std::greater(), &RunsWithoutResult::runs);
  for (auto& [number, generation] : generations) summary.generations.push_back(generation);
  return saved;
}

// `stored`: nullptr when the store does not know the search.
Result<SearchSummary> SummariseSearch(const SearchPlan& plan, const StoredSearch* stored, ResultStore& store,
                                      bool check) {
  const Experiment& experiment = plan.experiment;
  SearchSummary summary = Described(experiment);
  std::unique_ptr<SearchAlgorithm> search;
  {
    TRY(std::vector<Individual> individuals, store.LoadIndividuals(plan.id));
    summary.distinct_individuals = CountDistinctGenomes(individuals);
    TRY(search, MakeStoredSearch(plan, std::move(individuals)));
  }
  std::vector<RunOfCase> runs_of;
  TRY(const SavedProgress saved, RestoreAndAddRuns(plan, store, check, *search, summary, runs_of));
  summary.settings = plan.settings;
  summary.progress = search->Progress();
  summary.archive = search->Archive();
  summary.statistics = search->Statistics();
  summary.statistics.insert(summary.statistics.begin(),
                            {"distinct_individuals", static_cast<double>(summary.distinct_individuals)});

  summary.state_hash = StateHash(EncodeExperiment(experiment), saved.results,
                                 EncodePopulation(search->Population()), saved.state);
  summary.finished = stored != nullptr && HasFinished(*stored, experiment, *search);
  std::ranges::stable_sort(runs_of, {}, &RunOfCase::individual);
  std::vector<Individual> population = search->TakePopulation();
  summary.population.reserve(population.size());
  for (Individual& one : population) {
    PopulationMember& member = summary.population.emplace_back(PopulationMember{
        one.id, std::move(one.parents), one.birth_generation, one.fitness, std::move(one.test_case.obstacles),
        std::vector<RunId>(), std::move(one.test_case.name)});
    auto run = std::ranges::lower_bound(runs_of, one.id, {}, &RunOfCase::individual);
    for (; run != runs_of.end() && run->individual == one.id; ++run) {
      member.runs.push_back(run->id);
      if (run->failing) ++member.failing_runs;
    }
    if (std::isfinite(one.fitness)) summary.fitness.Add(one.fitness);
  }
  return summary;
}

// What the searches come to together.
CampaignSummary TotalsOf(const std::vector<SearchPlan>& plans, const std::vector<SearchTally>& searches) {
  CampaignSummary totals;
  totals.experiment = plans.front().experiment.name;
  for (const SearchPlan& plan : plans) {
    if (!plan.experiment.plugin.empty()) totals.plugin_controllers.insert(plan.experiment.controller);
  }
  totals.finished = true;
  for (const SearchTally& one : searches) {
    totals.Add(one);
    SearchProgress progress = one.progress;
    progress.finished = one.finished;
    totals.each.Add(progress);
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

void SearchTally::Add(const SearchTally& other) {
  gauntlet::Add(other.progress, progress);
  runs_done += other.runs_done;
  runs_failed += other.runs_failed;
  total_failures += other.total_failures;
  failing_runs += other.failing_runs;
  distinct_individuals += other.distinct_individuals;
  fitness.Add(other.fitness);
  finished = finished && other.finished;
}

Result<CampaignSummary> SummariseTotals(const std::vector<SearchPlan>& plans, ResultStore& store) {
  TRY(const std::vector<SearchTotals> totals, store.LoadTotals());
  TRY(const std::vector<StoredSearch> stored, store.LoadSearches());
  std::vector<SearchTally> searches(plans.size());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const SearchId id = plans[i].id;
    SearchTally& tally = searches[i];
    TRY(const std::unique_ptr<SearchAlgorithm> search, MakeStoredSearch(plans[i], store));
    TRY(const std::optional<SavedState> state, store.LoadNewestState(id));
    tally.progress = search->Progress();
    if (state) tally.progress.generation = state->generation;
    const auto mine = std::ranges::find(totals, id, &SearchTotals::search);
    if (mine == totals.end()) continue;
    tally.runs_done = mine->runs;
    tally.runs_failed = mine->runs_failed;
    tally.total_failures = mine->total_failures;
    const auto known = std::ranges::find(stored, id, &StoredSearch::id);
    tally.finished = known != stored.end() && HasFinished(*known, plans[i].experiment, *search);
  }
  CampaignSummary all = TotalsOf(plans, searches);
  TRY(all.nondeterministic, CountNondeterministic(store));
  TRY(all.lone_verdicts, CountLoneVerdicts(store));
  TRY(all.reproducibility, ReadReproducibility(plans, store));
  return all;
}

namespace {

Result<CampaignSummary> SummariseAll(const std::vector<SearchPlan>& plans, ResultStore& store, bool check) {
  TRY(const std::vector<StoredSearch> stored, store.LoadSearches());
  std::vector<SearchSummary> searches;
  for (const SearchPlan& plan : plans) {
    const auto known = std::ranges::find(stored, plan.id, &StoredSearch::id);
    TRY(SearchSummary summary,
        SummariseSearch(plan, known == stored.end() ? nullptr : &*known, store, check));
    searches.push_back(std::move(summary));
  }
  CampaignSummary all = TotalsOf(plans, {searches.begin(), searches.end()});
  all.searches = std::move(searches);
  TRY(all.nondeterministic, CountNondeterministic(store));
  TRY(all.lone_verdicts, CountLoneVerdicts(store));
  TRY(all.reproducibility, ReadReproducibility(plans, store));
  return all;
}

}  // namespace

Result<CampaignSummary> Summarise(const std::vector<SearchPlan>& plans, ResultStore& store) {
  return SummariseAll(plans, store, /*check=*/false);
}

Result<CampaignSummary> CheckAndSummarise(const std::vector<SearchPlan>& plans, ResultStore& store) {
  return SummariseAll(plans, store, /*check=*/true);
}

}  // namespace gauntlet
