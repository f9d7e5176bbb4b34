// Searches of a campaign under the same settings: a sweep's conditions, and how often the swarm fails in
// each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/interval.h"
#include "analysis/tables/table.h"
#include "master/campaign/campaign_summary.h"

namespace gauntlet {

struct Condition {
  std::string settings;               // "scenario_parameters.birds=5"; "" where it is the only one
  std::vector<std::size_t> searches;  // from 0: they differ in their seed, or in where their cases come from
  std::uint64_t runs = 0;
  std::uint64_t failing_runs = 0;
  double share = 0.0;  // of failing runs: the mean over units; NaN without a run
  // 95 %, over the units: the cases of a single search whose cases are independent of one another (of an only
  // case its runs), else the searches. None of an only search.
  std::optional<analysis::Interval> interval = std::nullopt;
};

// The settings of a search without its seed, and of the search that its cases come from only the campaign.
std::string ConditionOf(const std::string& settings);
// In the order of their first searches.
std::vector<Condition> ConditionsOf(const CampaignSummary& summary);
Table ConditionsTable(const std::vector<Condition>& conditions);
// "from 3.3 % (scenario_parameters.birds=6) to 23.3 % (scenario_parameters.birds=15)"; of two or more.
std::string RangeOf(const std::vector<Condition>& conditions);

}  // namespace gauntlet
