// Summaries of campaigns with several searches, made by hand.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "master/campaign/campaign_summary.h"

namespace gauntlet {

// A finished search in which each case has one run; `failing` of its cases fail.
inline SearchSummary SearchOfCases(const std::string& settings, std::uint64_t failing, std::uint64_t cases,
                                   const std::string& search = "random") {
  SearchSummary summary;
  summary.settings = settings;
  summary.search = search;
  summary.runs_done = cases;
  summary.failing_runs = failing;
  summary.finished = true;
  for (std::uint64_t i = 1; i <= cases; ++i) {
    const bool fails = i <= failing;
    summary.population.push_back(
        {.id = i, .fitness = fails ? 0.0 : 1.0, .genome = {}, .runs = {i}, .failing_runs = fails ? 1U : 0U});
  }
  return summary;
}

inline CampaignSummary SweptCampaign(const std::vector<SearchSummary>& searches) {
  CampaignSummary summary;
  summary.experiment = "flocking";
  summary.searches = searches;
  summary.finished = true;
  for (const SearchSummary& one : searches) summary.Add(one);
  return summary;
}

}  // namespace gauntlet
