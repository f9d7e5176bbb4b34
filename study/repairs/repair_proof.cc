#include "study/repairs/repair_proof.h"

#include <algorithm>

#include <fmt/format.h>

#include "master/campaign/campaign_summary.h"
#include "master/campaign/stored_campaign.h"
#include "master/directory/campaign_directory.h"
#include "search/search_table.h"
#include "study/repairs/repair_result.h"

namespace gauntlet {
namespace {

// The experiment of a search that `repair` stands in for, with about so many runs.
Experiment SearchedBy(Experiment experiment, const std::string& algorithm, int runs) {
  experiment.search.algorithm = algorithm;
  experiment.search.replicates = 1;
  experiment.search.parameters = {};
  experiment.repair = {};
  const int each = std::max(experiment.search.population, 1);
  experiment.search.generations = std::max(runs / each, 1);
  if (algorithm == "archive") experiment.search.parameters["runs"] = runs;
  return experiment;
}

}  // namespace

std::string ProofOf(const std::string& dir) {
  return dir + "/proof";
}

std::vector<SearchPlan> ProofSearches(const Repair& repair, int runs) {
  std::vector<SearchPlan> plans;
  for (const char* algorithm : {"genetic", "archive"}) {
    for (const bool repaired : {false, true}) {
      Experiment experiment =
          SearchedBy(repaired ? RepairedExperiment(repair) : repair.experiment, algorithm, runs);
      const auto& check = RowOf(experiment).info.check;
      if (check && check(experiment)) return plans;  // no cells that an archive could fill, or too few runs
      plans.push_back({fmt::format("{}, {}", repaired ? "repaired" : "original", algorithm), experiment});
    }
  }
  return plans;
}

Result<std::vector<FreshSearch>> ReadFreshSearches(const std::string& dir) {
  std::vector<FreshSearch> searches;
  if (!CampaignDirectory::IsCampaign(ProofOf(dir))) return searches;
  TRY(const StoredCampaign campaign, OpenStoredCampaign(ProofOf(dir)));
  TRY(const CampaignSummary summary, Summarise(campaign.plans, *campaign.view.store));
  if (!summary.finished) return searches;
  for (std::size_t i = 0; i + 1 < campaign.plans.size(); i += 2) {
    FreshSearch& fresh = searches.emplace_back();
    fresh.title = RowOf(campaign.plans[i].experiment).title;
    fresh.archive = !summary.searches[i].archive.axes.empty();
    for (const std::size_t number : {i, i + 1}) {
      FreshSearch::Found& found = number == i ? fresh.before : fresh.after;
      const SearchSummary& of = summary.searches[number];
      found.runs = of.runs_done;
      found.failures = of.failing_runs + of.runs_failed;
      found.cells = of.archive.failures.size();
      TRY(campaign.view.store->ForEachRow(campaign.plans[number].id, 0, [&](const StoredRun& run) -> Status {
        if (run.completed()) found.fitness.push_back(run.fitness);
        return Ok{};
      }));
    }
  }
  return searches;
}

}  // namespace gauntlet
