// The smallest part of a test case that still breaks the swarm: which layouts to simulate, and what follows
// from their runs.
#pragma once

#include <cstddef>
#include <vector>

#include "search/given/layout_question.h"
#include "search/search_row.h"

namespace gauntlet {

// How a layout came out of the one before.
struct MinimisingStep {
  enum class Change {
    kNone,      // the case as it is
    kNearest,   // only the obstacles that are nearest to the failures
    kWithout,   // `obstacle` was taken away
    kShortened  // `obstacle` was made `length` long
  };
  Change change = Change::kNone;
  std::size_t obstacle = 0;  // of the case, from 0
  double length = 0.0;       // m
  Layout layout = {};
  FailureTally found = {};  // in the runs that decided for the step
};

enum class MinimisedTo {
  kOpen,       // not known yet
  kNoFailure,  // the case as it is fails in less than half of its runs: refused
  kError,      // a run of the case as it is ended without a result: refused
  kEmpty,      // the empty arena fails in most runs too: refused
  kLayout,     // some obstacles are left, which may be all of them
};

struct MinimisingRules {
  // m: a failure is the same one when it happens so near to one of the case as it is; 0 = failures have no
  // place.
  double same_within = 0.0;
  bool shorten = false;  // lengths too, when no obstacle can be spared any more
};

// First the case as it is has to be confirmed (VerdictOf), and the empty arena must not fail mostly. Where
// failures have a place, the k obstacles that are nearest to it are kept, k = 1, 2, ..., until they fail
// alone; then each that is left is taken away, the farthest first, and put back if it was needed. Without a
// place the second part begins with all of them, those that robots visited least first. It is repeated until
// none can be spared. A step is taken when a sequential probability ratio test (Wald 1945) prefers a failure
// probability of .95 to .75, with error
// probabilities of .1. Many tests in a row select for luck, so what is left must fail in 24 of 30 more runs,
// and at least half of these failures be the same ones; if not, the newest step that does is taken, or the
// search goes on with one obstacle more.
class CaseMinimiser final : public LayoutQuestion {
 public:
  static constexpr int kVerifyingRuns = 30;
  static constexpr int kVerifyingFailures = 24;
  // Only a case of which nothing smaller is left may be verified without being so.
  static bool IsReliable(const FailureTally& verified) { return verified.failures >= kVerifyingFailures; }

  CaseMinimiser(sim::Genome obstacles, const MinimisingRules& rules);

  const Layout& layout() const override { return layout_; }
  int runs() const override { return runs_; }
  // Runs without a result count as if the swarm had not failed, but in the case as it is.
  void Tell(const LayoutRuns& runs) override;

  MinimisedTo outcome() const { return outcome_; }
  const FailureTally& original() const { return original_.tally; }  // of the case as it is
  const FailureTally& empty() const { return empty_; }              // of the arena without obstacles
  // From the case as it is to what is left; what was taken back is not among them. Empty when refused.
  const std::vector<MinimisingStep>& steps() const { return steps_; }
  // Of what is left, in runs that took no part in choosing it.
  const LayoutRuns& verification() const { return verification_; }
  // Whether at least half of the failures happened where the case as it is fails.
  bool SameFailures(const LayoutRuns& runs) const;

 private:
  enum class Phase { kOriginal, kEmpty, kNearest, kWithout, kVerify, kShorten };

  bool HasPlaces() const { return rules_.same_within > 0.0 && !original_.places.empty(); }
  const Layout& Smallest() const { return steps_.back().layout; }
  void Try(Phase phase, MinimisingStep step);
  void End(MinimisedTo outcome);
  void Decide(bool fails);
  void Confirmed();
  void TryNearest(std::size_t count);
  void BeginTakingAway();
  void TryWithoutNext();
  void Verify();
  void Verified();
  void RollBack();
  void TryShorterNext();
  int RunsNeeded() const;
  bool Fails() const;

  const sim::Genome obstacles_;
  const MinimisingRules rules_;
  Phase phase_ = Phase::kOriginal;
  Layout layout_;
  int runs_ = 0;
  MinimisingStep trying_;  // what layout_ is a try of
  LayoutRuns told_;        // of layout_ in this phase
  MinimisedTo outcome_ = MinimisedTo::kOpen;
  LayoutRuns original_;
  FailureTally empty_;
  std::vector<std::size_t> order_;       // all obstacles, those that are probably needed first
  std::size_t nearest_ = 0;              // how many of them are being tried
  std::vector<std::size_t> left_;        // that have not been tried to take away, the next one last
  bool taken_away_ = false;              // something, since all that are left were tried
  std::vector<MinimisingStep> steps_;    // each was found to fail
  LayoutRuns verification_;              // of the newest step that was verified
  std::size_t verified_steps_ = 0;       // steps up to that one; 0 = none yet
  std::vector<MinimisingStep> shorter_;  // to be tried, the next one last
};

// The rules by which such an experiment minimises cases.
MinimisingRules RulesOf(const Experiment& minimisation);
// An experiment that minimises cases of `experiment`; `shorten`: also the lengths of obstacles.
Experiment MinimisationOf(const Experiment& experiment, bool shorten);
SearchRow MinimisationRow();

}  // namespace gauntlet
