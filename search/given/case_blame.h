// What each obstacle of a test case contributes to its failures: the case as it is, then without each of its
// obstacles, then, when none of these fails clearly less often, without pairs of them.
#pragma once

#include <cstddef>
#include <vector>

#include "search/given/layout_question.h"
#include "search/search_row.h"

namespace gauntlet {

class CaseBlame final : public LayoutQuestion {
 public:
  struct Part {
    std::vector<std::size_t> without;  // obstacles that were left out, from 0; none: the case as it is
    LayoutRuns runs;
  };

  // Each part is simulated `replicates` times, at least 2.
  CaseBlame(sim::Genome obstacles, int replicates);

  const Layout& layout() const override { return layout_; }
  int runs() const override { return next_ < wanted_.size() ? replicates_ : 0; }
  void Tell(const LayoutRuns& runs) override;

  // In the order in which they were simulated: the case as it is, single obstacles in their order, pairs.
  const std::vector<Part>& parts() const { return parts_; }

 private:
  void WantPairs();
  void Prepare();

  const Layout all_;
  const int replicates_;
  std::vector<std::vector<std::size_t>> wanted_;  // what to leave out
  std::size_t next_ = 0;
  Layout layout_;
  std::vector<Part> parts_;
};

// Whether the case fails clearly more often than without a part of it: by more than three standard errors of
// such a difference, so that not one of dozens of parts is blamed by chance.
bool ClearlyLess(const FailureTally& without, const FailureTally& whole);

// An experiment that asks what the obstacles of cases of `experiment` contribute, with so many runs a part:
// `gauntlet blame`.
Experiment BlameExperiment(const Experiment& experiment, int replicates);
int BlameReplicates(const Experiment& experiment);
SearchRow BlameRow();

}  // namespace gauntlet
