// A search along the range of one key: the same cases under values of it, where the failure rate is found to
// change (margin_stages.h).
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "search/evolution/population_search.h"
#include "search/margin/margin_stages.h"
#include "search/search_row.h"

namespace gauntlet {

// The cases that were handed in are individuals 1, 2, ... and are not simulated themselves; then follow those
// of a value each, copies of them. The seed of a run follows from its case and from how often it was
// simulated under its value, so that different values have common seeds.
class MarginSearch final : public PopulationSearch {
 public:
  // Error: that of MakeMarginPlan; no case is given; a value of the range breaks a rule, and which; the key
  // disturbs a device that no robot under test has.
  static Result<std::unique_ptr<MarginSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return needs_metrics_; }
  SearchProgress Progress() const override;
  // At the end of each stage.
  bool AtBoundary() const override { return asked_.empty(); }

  const MarginStages* Margin() const override { return &stages_; }

 private:
  MarginSearch(const SearchSetup& setup, MarginPlan plan);

  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  EvaluationRequest RequestOf(const MarginRun& run);

  MarginStages stages_;
  const std::string_view failing_;
  const bool needs_metrics_;
  std::map<std::pair<double, std::size_t>, Individual> copies_;  // by value and case
  std::map<double, std::shared_ptr<const Experiment>> settings_;
  std::deque<MarginRun> asked_;  // not told
  IndividualId born_ = 0;
  bool ended_ = false;
};

SearchRow MarginRow();

}  // namespace gauntlet
