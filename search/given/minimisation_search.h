// Given test cases, each made as small as it can be while it still breaks the swarm: `gauntlet minimise`.
#pragma once

#include <memory>

#include "search/given/case_minimiser.h"
#include "search/given/layout_search.h"
#include "search/search_row.h"

namespace gauntlet {

class MinimisationSearch final : public LayoutSearch {
 public:
  static Result<std::unique_ptr<MinimisationSearch>> Create(const SearchSetup& setup);

  const CaseMinimiser& MinimiserOf(std::size_t index) const {
    return static_cast<const CaseMinimiser&>(QuestionOf(index));
  }

 private:
  using LayoutSearch::LayoutSearch;
};

// An experiment that minimises cases of `experiment`; `shorten`: also the lengths of obstacles.
Experiment MinimisationOf(const Experiment& experiment, bool shorten);
SearchRow MinimisationRow();

}  // namespace gauntlet
