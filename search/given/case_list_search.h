// Given test cases, each evaluated once: what `gauntlet evaluate` does.
#pragma once

#include <memory>

#include "search/evolution/population_search.h"
#include "search/search_row.h"

namespace gauntlet {

// Case i of SearchSetup::cases is individual i + 1; all of them are the population from the beginning. Their
// validity is the caller's business; nothing here is random.
class CaseListSearch : public PopulationSearch {
 public:
  static Result<std::unique_ptr<CaseListSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  SearchProgress Progress() const override;

 private:
  explicit CaseListSearch(const SearchSetup& setup);

  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  bool asked_ = false;
};

SearchRow CaseListRow();
// The same for relatives, the members of one evolution's population: each has seeds of its own, so that
// clones are simulated independently, and all of them count as one unit where sets are compared.
SearchRow ResimulationRow();

}  // namespace gauntlet
