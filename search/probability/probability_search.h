// The search for a failure probability over conditions: samples of them, each a case with settings of its
// own, run once (probability_course.h).
#pragma once

#include <memory>
#include <utility>

#include "search/probability/probability_course.h"
#include "search/search_row.h"
#include "search/settings/settings_search.h"

namespace gauntlet {

class ProbabilitySearch final : public SettingsSearch {
 public:
  // Error: that of Conditions::Make; a value within a distribution breaks a rule, and which.
  static Result<std::unique_ptr<ProbabilitySearch>> Create(const SearchSetup& setup);

  const ProbabilityCourse* Probability() const override { return course_.get(); }

 private:
  ProbabilitySearch(const SearchSetup& setup, std::unique_ptr<ProbabilityCourse> course)
      : SettingsSearch(setup, *course), course_(std::move(course)) {}

  std::unique_ptr<ProbabilityCourse> course_;
};

SearchRow ProbabilityRow();

}  // namespace gauntlet
