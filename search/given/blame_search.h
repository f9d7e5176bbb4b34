// Given test cases, each simulated without its obstacles in turn: `gauntlet blame`.
#pragma once

#include <memory>

#include "search/given/case_blame.h"
#include "search/given/layout_search.h"
#include "search/search_row.h"

namespace gauntlet {

class BlameSearch final : public LayoutSearch {
 public:
  static Result<std::unique_ptr<BlameSearch>> Create(const SearchSetup& setup);

  const CaseBlame& BlameOf(std::size_t index) const {
    return static_cast<const CaseBlame&>(QuestionOf(index));
  }

 private:
  using LayoutSearch::LayoutSearch;
};

// An experiment that asks what the obstacles of cases of `experiment` contribute, with so many runs a part.
Experiment BlameExperiment(const Experiment& experiment, int replicates);
SearchRow BlameRow();

}  // namespace gauntlet
