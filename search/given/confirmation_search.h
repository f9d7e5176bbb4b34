// Given test cases, each simulated with fresh seeds until it is known whether it fails: `gauntlet confirm`.
#pragma once

#include <memory>
#include <vector>

#include "search/evolution/population_search.h"
#include "search/failure_tally.h"
#include "search/search_row.h"

namespace gauntlet {

// Case i of SearchSetup::cases is individual i + 1. The runs without which a case can have no verdict are
// asked for at once, and more only when these are told, so that none is wasted; the cases do not wait for
// each other.
class ConfirmationSearch : public PopulationSearch {
 public:
  static Result<std::unique_ptr<ConfirmationSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return FailingNeedsMetrics(failing_); }
  SearchProgress Progress() const override;

 private:
  struct Case {
    FailureTally tally;
    int waiting = 0;  // runs that were asked for and not told
  };

  explicit ConfirmationSearch(const SearchSetup& setup);

  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;
  void Count(const EvaluationOutcome& outcome);
  void AskMore(std::size_t index);

  const std::string_view failing_;
  const int replicates_;
  std::vector<Case> cases_;
  std::vector<EvaluationRequest> requests_;  // that Ask has not handed out; they follow from what was told
};

// Runs that each case of such an experiment is given; 0 = until there is a verdict.
int ConfirmationReplicates(const Experiment& experiment);
// An experiment that confirms cases of `experiment`.
Experiment ConfirmationOf(const Experiment& experiment, int replicates);
SearchRow ConfirmationRow();

// The same question of the cases of a corpus, with seeds of its own: `gauntlet check`.
Experiment CheckOf(const Experiment& experiment);
SearchRow CheckRow();

}  // namespace gauntlet
