#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/output/summary.h"
#include "master/campaign/verdict_text.h"
#include "master/session/reproduction_bundle.h"
#include "proto/json_text.h"
#include "report/tables/conditions.h"
#include "report/tables/distinct_failures.h"
#include "report/tables/summary_tables.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

Json FitnessJson(double fitness) {
  return JsonValue(fitness);
}

// Metrics or statistics by their names.
Json FiguresJson(const std::vector<std::pair<std::string, double>>& figures) {
  Json json = Json::object();
  for (const auto& [name, value] : figures) json[name] = FitnessJson(value);
  return json;
}

Json TextOrNull(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

Json WithoutResultJson(const SearchSummary& summary) {
  Json groups = Json::array();
  for (const RunsWithoutResult& group : summary.runs_without_result) {
    groups.push_back({{"verdict", NameOf(group.verdict)},
                      {"rule", TextOrNull(group.rule)},
                      {"message", group.message},
                      {"runs", group.runs},
                      {"first_run", group.first_run},
                      {"bundle", LeavesBundle(group.verdict) ? Json(BundleName(group.first_run)) : Json()}});
  }
  return groups;
}

Json ArchiveJson(const SearchSummary& summary) {
  const ArchiveView& archive = summary.archive;
  if (archive.axes.empty()) return {};
  Json descriptors = Json::array();
  for (const controllers::DescriptorAxis& axis : archive.axes) {
    descriptors.push_back(
        {{"metric", axis.metric}, {"min", axis.min}, {"max", axis.max}, {"parts", axis.parts}});
  }
  return {{"descriptors", std::move(descriptors)},
          {"cells", CellsOf(archive)},
          {"filled", archive.failures.size()},
          {"elites", ArchiveTable(summary).ToJson()}};
}

Json OneSearch(const SearchSummary& search, const CampaignSummary& campaign, const std::string& directory) {
  std::vector<const PopulationMember*> population;
  for (const PopulationMember& member : search.population) population.push_back(&member);
  return {{"experiment", campaign.experiment},
          {"directory", directory},
          {"search", search.search},
          {"seed", fmt::format("{}", search.seed)},
          {"generation", search.progress.generation},
          {"generations", search.progress.generations},
          {"evaluations_done", search.progress.evaluations_done},
          {"evaluations_planned", search.progress.evaluations_planned},
          {"runs_done", search.runs_done},
          {"runs_failed", search.runs_failed},
          {"runs_without_result", WithoutResultJson(search)},
          {"distinct_individuals", search.distinct_individuals},
          {"best_fitness", FitnessJson(search.fitness.lowest())},
          {"mean_fitness", FitnessJson(search.fitness.mean())},
          {"worst_fitness", FitnessJson(search.fitness.highest())},
          {"total_failures", search.total_failures},
          {"failing_runs", search.failing_runs},
          {"failure_types", FailureTypeTable(search).ToJson()},
          {"unclassified_failures", search.untyped_failures},
          {"statistics", FiguresJson(search.statistics)},
          {"history", GenerationTable(search).ToJson()},
          {"population", PopulationTable(population, /*named=*/false).ToJson()},
          {"archive", ArchiveJson(search)},
          {"state_hash", search.state_hash},
          {"nondeterministic", campaign.nondeterministic > 0},
          {"verdicts_of_one_worker", campaign.lone_verdicts},
          {"finished", search.finished}};
}

Json SweepJson(const CampaignSummary& summary, const std::string& directory) {
  Json searches = Json::array();
  for (const SearchSummary& one : summary.searches) {
    Json search = {{"number", searches.size() + 1}, {"settings", one.settings}};
    search.update(OneSearch(one, summary, directory));
    searches.push_back(std::move(search));
  }
  return {{"experiment", summary.experiment},
          {"directory", directory},
          {"search", "sweep"},
          {"runs_done", summary.runs_done},
          {"runs_failed", summary.runs_failed},
          {"total_failures", summary.total_failures},
          {"nondeterministic", summary.nondeterministic > 0},
          {"verdicts_of_one_worker", summary.lone_verdicts},
          {"finished", summary.finished},
          {"conditions", ConditionsTable(ConditionsOf(summary)).ToJson()},
          {"searches", std::move(searches)}};
}

}  // namespace

std::string SummaryJson(const CampaignSummary& summary, const CampaignAnswers& answers,
                        const std::string& directory) {
  const SearchSummary* only = summary.OnlySearch();
  Json json = only != nullptr ? OneSearch(*only, summary, directory) : SweepJson(summary, directory);
  if (const ObservedReproducibility& seen = summary.reproducibility; seen.observed()) {
    json["reproducible"] = seen.Name();
    json["reproducible_hosts"] = seen.Hosts();
  }
  json["empty_arena"] = nullptr;
  if (!answers.baselines.empty()) {
    const FailureTally& tally = answers.baselines.front().tally;
    json["empty_arena"] = {{"k", tally.failures}, {"n", tally.runs()}};
  }
  json["baseline"] = answers.baselines.empty() ? Json() : BaselinesTable(answers.baselines).ToJson();
  json["confirmed"] = ConfirmationsTable(answers.confirmations).ToJson();
  const DistinctFailures distinct = DistinctFailuresOf(answers.confirmations, answers.smallest_layouts);
  json["distinct_failures"] = DistinctFailuresTable(distinct.All()).ToJson();
  json["failure_groupings"] = FailureGroupingsTable(distinct).ToJson();
  return JsonText(json);
}

std::string ReplayJson(const ReplayReport& report) {
  Json disturbances = Json::object();
  for (const auto& [key, value] : sim::DisturbanceTexts(report.spec.disturbances)) disturbances[key] = value;
  const bool completed = report.replayed.verdict == sim::Verdict::kCompleted;
  return JsonText({{"run", JsonValue(report.stored.id)},
                   {"reproduced", report.differences.empty()},
                   {"stored_hash", fmt::format("{:016x}", report.stored_result.hash)},
                   {"hash", fmt::format("{:016x}", report.replayed.hash)},
                   {"differences", report.differences},
                   {"disturbances", std::move(disturbances)},
                   {"verdict", NameOf(report.replayed.verdict)},
                   {"message", TextOrNull(report.replayed.message)},
                   {"fitness", completed ? FitnessJson(report.replayed.fitness) : Json()},
                   {"total_failure", report.replayed.failure.total},
                   {"failure", TextOrNull(report.replayed.failure.label)},
                   {"metrics", FiguresJson(report.replayed.metrics)}});
}

}  // namespace gauntlet
