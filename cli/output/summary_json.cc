#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cli/output/archive_table.h"
#include "cli/output/confirmation_table.h"
#include "cli/output/summary.h"
#include "master/campaign/verdict_text.h"
#include "master/session/reproduction_bundle.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

// Integers up to here are exact in every JSON reader.
constexpr std::uint64_t kExactInJson = 1ULL << 53;

Json IdJson(std::uint64_t id) {
  return id <= kExactInJson ? Json(id) : Json(fmt::format("{}", id));
}

Json IdsJson(const std::vector<std::uint64_t>& ids) {
  Json list = Json::array();
  for (const std::uint64_t id : ids) list.push_back(IdJson(id));
  return list;
}

Json FitnessJson(double fitness) {
  return std::isfinite(fitness) ? Json(fitness) : Json();
}

// Keys as in case files (proto/run.proto, message Obstacle), so that a genome can be copied into one.
Json GenomeJson(const sim::Genome& genome) {
  Json list = Json::array();
  for (const sim::ObstacleGene& gene : genome) {
    list.push_back({{"x", gene.x},
                    {"y", gene.y},
                    {"length", gene.length},
                    {"width", gene.width},
                    {"orientationDeg", gene.orientation_deg}});
    if (gene.Moves()) {
      Json path = Json::array();
      for (const sim::Vec2& point : gene.path) path.push_back({{"x", point.x()}, {"y", point.y()}});
      list.back()["motion"] = {{"speed", gene.speed}, {"path", std::move(path)}};
    }
    if (gene.Lit()) list.back()["light"] = sim::NameOf(gene.light);
  }
  return list;
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

Json OneSearch(const CampaignSummary& summary, const std::string& directory) {
  Json generations = Json::array();
  for (const GenerationSummary& generation : summary.generations) {
    const auto fitness = [&](double value) { return generation.completed > 0 ? FitnessJson(value) : Json(); };
    generations.push_back({{"generation", generation.generation},
                           {"runs", generation.runs},
                           {"best_fitness", fitness(generation.best)},
                           {"mean_fitness", fitness(generation.mean)},
                           {"worst_fitness", fitness(generation.worst)},
                           {"total_failures", generation.total_failures}});
  }

  Json population = Json::array();
  for (const PopulationMember& member : summary.population) {
    population.push_back({{"id", IdJson(member.id)},
                          {"fitness", FitnessJson(member.fitness)},
                          {"birth_generation", member.birth_generation},
                          {"parents", IdsJson(member.parents)},
                          {"genome", GenomeJson(member.genome)},
                          {"runs", IdsJson(member.runs)}});
    if (!member.name.empty()) population.back()["name"] = member.name;
  }

  Json failure_types = Json::array();
  for (const FailureCount& failure : summary.failure_types) {
    failure_types.push_back({{"type", failure.type}, {"name", failure.name}, {"runs", failure.runs}});
  }

  Json without_result = Json::array();
  for (const RunsWithoutResult& group : summary.runs_without_result) {
    without_result.push_back(
        {{"verdict", NameOf(group.verdict)},
         {"rule", TextOrNull(group.rule)},
         {"message", group.message},
         {"runs", group.runs},
         {"first_run", group.first_run},
         {"bundle", LeavesBundle(group.verdict) ? Json(BundleName(group.first_run)) : Json()}});
  }

  return {{"experiment", summary.experiment},
          {"directory", directory},
          {"search", summary.search},
          {"seed", fmt::format("{}", summary.seed)},
          {"generation", summary.progress.generation},
          {"generations", summary.progress.generations},
          {"evaluations_done", summary.progress.evaluations_done},
          {"evaluations_planned", summary.progress.evaluations_planned},
          {"runs_done", summary.runs_done},
          {"runs_failed", summary.runs_failed},
          {"runs_without_result", std::move(without_result)},
          {"distinct_individuals", summary.distinct_individuals},
          {"best_fitness", FitnessJson(summary.best_fitness)},
          {"mean_fitness", FitnessJson(summary.mean_fitness)},
          {"worst_fitness", FitnessJson(summary.worst_fitness)},
          {"total_failures", summary.total_failures},
          {"failing_runs", summary.failing.empty() ? summary.total_failures : summary.failing_runs},
          {"failure_types", std::move(failure_types)},
          {"unclassified_failures", summary.untyped_failures},
          {"statistics", FiguresJson(summary.statistics)},
          {"history", std::move(generations)},
          {"population", std::move(population)},
          {"archive", ArchiveJson(summary)},
          {"state_hash", summary.state_hash},
          {"nondeterministic", summary.nondeterministic > 0},
          {"verdicts_of_one_worker", summary.lone_verdicts},
          {"finished", summary.finished}};
}

Json SweepJson(const CampaignSummary& summary, const std::string& directory) {
  Json searches = Json::array();
  for (std::size_t i = 0; i < summary.searches.size(); ++i) {
    Json search = {{"number", i + 1}, {"settings", summary.searches[i].settings}};
    search.update(OneSearch(summary.searches[i], directory));
    searches.push_back(std::move(search));
  }
  return {{"experiment", summary.experiment},
          {"directory", directory},
          {"search", summary.search},
          {"runs_done", summary.runs_done},
          {"runs_failed", summary.runs_failed},
          {"total_failures", summary.total_failures},
          {"nondeterministic", summary.nondeterministic > 0},
          {"verdicts_of_one_worker", summary.lone_verdicts},
          {"finished", summary.finished},
          {"searches", std::move(searches)}};
}

}  // namespace

std::string SummaryJson(const CampaignSummary& summary, const CampaignAnswers& answers,
                        const std::string& directory) {
  Json json = summary.searches.empty() ? OneSearch(summary, directory) : SweepJson(summary, directory);
  json["confirmed"] = ConfirmationsTable(answers.confirmations).ToJson();
  json["distinct_failures"] = DistinctFailuresJson(answers);
  return JsonText(json);
}

std::string ReplayJson(const ReplayReport& report) {
  Json disturbances = Json::object();
  for (const auto& [key, value] : sim::DisturbanceTexts(report.spec.disturbances)) disturbances[key] = value;
  const bool completed = report.replayed.verdict == sim::Verdict::kCompleted;
  return JsonText({{"run", IdJson(report.stored.id)},
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
