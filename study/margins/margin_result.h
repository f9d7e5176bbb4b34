// What a campaign of margin searches has come to: the values at which a swarm's failures cross a share, and
// which setting it withstands least.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/tables/section.h"
#include "base/result.h"
#include "search/margin/margin_stages.h"

namespace gauntlet {

// Of one key.
struct Margin {
  Experiment experiment;  // of its search
  MarginPlan plan;
  int runs = 0;
  int without_result = 0;  // of these
  bool finished = false;
  std::optional<MarginEstimate> estimate = {};  // nothing: no run has a result
  // What is crossed first, as a share of its range, has 1; those whose intervals overlap share a rank.
  int rank = 1;
};

// In the order of the campaign's searches. Error: those of reading; it holds no margin.
Result<std::vector<Margin>> ReadMargins(const std::string& dir);
// Gives each its rank.
void RankMargins(std::vector<Margin>& margins);

// For programs: "within", "below_everywhere", "above_everywhere", "undecided".
std::string CrossesOf(const Margin& margin);
// "Failures cross 50 % where noise.x.drop is about 0.125 (0.1 to 0.15, 95 %)."
std::string OutcomeOf(const Margin& margin);
std::vector<Section> TellMargins(const std::vector<Margin>& margins, const std::string& dir,
                                 const std::string& program);
// [{key, share, threshold: {value, interval} or null, runs, points: [{value, k, n, interval, fit}], ...}];
// ends of an interval that may lie outside the range are null.
nlohmann::ordered_json MarginValues(const std::vector<Margin>& margins);
// {directory, finished, cases, keys: MarginValues}; of one key its values also beside these.
std::string MarginJson(const std::vector<Margin>& margins, const std::string& dir);
// A line for each value: runs, failures, the fit.
Table LevelTable(const Margin& margin);

}  // namespace gauntlet
