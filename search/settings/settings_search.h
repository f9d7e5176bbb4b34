// A search over settings under which given cases are simulated with common seeds (settings_course.h).
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "search/evolution/population_search.h"
#include "search/settings/settings_course.h"

namespace gauntlet {

// The cases that were handed in are individuals 1, 2, ... and are not simulated themselves; then follow those
// of a setting each, copies of them. The seed of a run follows from its case and from how often it was
// simulated under its setting (SearchRow::seeds_of_cases), so that different settings have common seeds.
class SettingsSearch : public PopulationSearch {
 public:
  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return course_.WantsMetrics(); }
  SearchProgress Progress() const override;
  // At the end of each stage.
  bool AtBoundary() const override { return asked_.empty(); }

 protected:
  // `course` lives as long as the search.
  SettingsSearch(const SearchSetup& setup, SettingsCourse& course);

 private:
  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  EvaluationRequest RequestOf(const SettingsRun& run);

  SettingsCourse& course_;
  struct Copy {
    Individual individual;
    std::uint32_t asked = 0;  // evaluations that are not told
  };
  std::map<std::pair<std::size_t, std::size_t>, Copy> copies_;  // by setting and case
  std::map<std::size_t, std::shared_ptr<const Experiment>> settings_;
  std::deque<SettingsRun> asked_;  // not told
  IndividualId born_ = 0;
  bool ended_ = false;
};

}  // namespace gauntlet
