// Given test cases, each made as small as it can be while it still breaks the swarm: `gauntlet minimise`.
#pragma once

#include <memory>

#include "master/search/case_minimiser.h"
#include "master/search/layout_search.h"
#include "master/search/search_table.h"

namespace gauntlet::master {

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

}  // namespace gauntlet::master
