// Facts of a campaign, made by hand.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "report/figures/campaign_facts.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {

inline SearchPlan PlanOf(const std::string& experiment, const std::string& settings = "",
                         std::uint64_t seed = 1) {
  SearchPlan plan{settings, LoadExperiment(experiment, {}, BuiltInCatalogue()).value()};
  plan.experiment.seed = seed;
  return plan;
}

// A campaign of one search without runs.
inline CampaignFacts FactsOf(const std::string& experiment) {
  CampaignFacts facts;
  facts.directory = "campaigns/one";
  facts.plans = {PlanOf(experiment)};
  facts.summary.experiment = experiment;
  facts.summary.searches.resize(1);
  return facts;
}

inline MeanAndRange FitnessOf(double value) {
  MeanAndRange fitness;
  fitness.Add(value);
  return fitness;
}

// A completed run; a total failure when `type` is not -2. Descriptors that are not given have no value.
inline RunFacts RunOf(RunId id, double fitness, int type = -2, std::vector<double> descriptors = {}) {
  constexpr std::size_t kEnough = 16;  // for every scenario
  descriptors.resize(kEnough, std::numeric_limits<double>::quiet_NaN());
  return {.id = id,
          .search = 1,
          .individual = id,
          .generation = 1,
          .completed = true,
          .total_failure = type != -2,
          .failure_type = type == -2 ? -1 : type,
          .fitness = fitness,
          .descriptors = std::move(descriptors)};
}

}  // namespace gauntlet
