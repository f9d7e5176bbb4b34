// Given cases as they are, each evaluated once, or so often as was asked, or until it is known whether it
// fails: what `gauntlet evaluate`, `confirm` and `check` do.
#pragma once

#include "search/given/layout_question.h"
#include "search/search_row.h"

namespace gauntlet {

class RepeatedCase final : public LayoutQuestion {
 public:
  // `replicates`: 0 = until there is a verdict (VerdictOf). A run without a result ends it.
  RepeatedCase(const sim::Genome& obstacles, int replicates)
      : layout_(AllOf(obstacles)), replicates_(replicates) {}

  const Layout& layout() const override { return layout_; }
  int runs() const override { return RunsToVerdict(told_.tally, replicates_); }
  void Tell(const LayoutRuns& runs) override { told_.Add(runs); }

 private:
  const Layout layout_;
  const int replicates_;
  LayoutRuns told_;
};

// Each case is evaluated once.
SearchRow CaseListRow();
// The same for relatives, the members of one evolution's population: each has seeds of its own, so that
// clones are simulated independently, and all of them count as one unit where sets are compared.
SearchRow ResimulationRow();

// Runs that each case of such an experiment is given; 0 = until there is a verdict.
int ConfirmationReplicates(const Experiment& experiment);
// An experiment that confirms cases of `experiment`.
Experiment ConfirmationOf(const Experiment& experiment, int replicates);
SearchRow ConfirmationRow();

// The same question of the cases of a corpus, with seeds of its own: `gauntlet check`.
Experiment CheckOf(const Experiment& experiment);
SearchRow CheckRow();

}  // namespace gauntlet
