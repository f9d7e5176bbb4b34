// A search for many different failures, each as small as possible: an archive over how swarms fail, in each
// cell of which the smallest reliable failure stays. After the elites of MAP-Elites (Mouret and Clune 2015),
// with reliability as a constraint and the size of a layout as its quality.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "search/archive/archive_judge.h"
#include "search/archive/failure_archive.h"
#include "search/archive/failure_prior.h"
#include "search/archive/layout_proposer.h"
#include "search/evolution/population_search.h"
#include "search/search_row.h"

namespace gauntlet {

// Of a search whose length is search.runs: in words, and as evaluations of one layout each.
std::string PlanOfRuns(const Experiment& experiment);
std::uint64_t PlannedEvaluations(const Experiment& experiment);
// Error: there are no cells that failures could be collected in, or no obstacles that could cause them.
Status CheckCollecting(const Experiment& experiment);

// What an emitter has cost and given.
struct EmitterAccount {
  std::uint64_t runs = 0;
  std::uint64_t layouts = 0;
  std::uint64_t elites = 0;  // layouts that became the smallest of their cell
};

// Which lines of layouts an archive search follows.
enum class LinePolicy : std::uint8_t { kAll, kDeletionOnly };

// search.slots layouts are under test at a time, each with one run outstanding, so what is asked depends on
// exactly the results 1 .. k - slots, for any number of workers. A layout is dropped when its first run
// passes or shows that it cannot become the smallest of its cell, or when a second run passes; it is admitted
// when 3 of 3 or 4 of 5 runs fail. A layout that was admitted is followed by those with one obstacle less; a
// random case that fails, by its obstacles nearest to where it failed: 1, 2, 3, 4 of them, and then itself.
// When nothing follows, a slot goes on with a random case, obstacles across the way, an elite moved to
// another cell, a changed elite, or one more run of an elite. Elites of which fewer than 80 % of further runs
// are expected to fail (FailurePrior) are run again before anything new begins, and leave the archive when
// fewer than 60 % are, or when the next of their cell has as few obstacles and is expected to fail more
// often. What is only shorter than an elite is admitted when it is expected to fail as often.
//
// With kDeletionOnly, the baseline, it knows nothing of cells: random cases alone, each run until it is
// admitted or dropped and then shortened by one obstacle, the farthest from the way first, as long as what is
// left is admitted. The archive only collects what comes of it.
//
// Steered by robustness it remembers the layouts whose runs came nearest to failing; as long as nothing was
// admitted, every other line that begins is one of them, a little changed.
//
// Population() is the smallest of each cell, in the order of the cells.
class ArchiveSearch : public PopulationSearch {
 public:
  // Error: the scenario has no axes, or the ranges leave no room for a valid case.
  static Result<std::unique_ptr<ArchiveSearch>> Create(const SearchSetup& setup,
                                                       LinePolicy policy = LinePolicy::kAll);

  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return true; }
  SearchProgress Progress() const override;
  std::vector<std::pair<std::string, double>> Statistics() const override;
  ArchiveView Archive() const override;
  // After every kSaveInterval outcomes, and at the end. What was asked and not told is part of the state.
  bool AtBoundary() const override;

  static constexpr std::uint64_t kSaveInterval = 100;
  // Evaluations after which it is late. Chosen: of flocking's cells most hold one or two obstacles then, and
  // few are left that rows of up to three would win.
  static constexpr std::uint64_t kEarly = 1000;

 private:
  struct Step {
    Emitter emitter = Emitter::kRandom;
    sim::Genome obstacles;
  };
  // A line of layouts, each of which follows from what came of the one before.
  struct Slot {
    Emitter emitter = Emitter::kRandom;
    Finding finding;              // under test
    std::deque<Step> plan;        // what follows
    std::size_t cell = 0;         // that they are to become the smallest of
    std::optional<Finding> root;  // the random case, under test after everything that is smaller
    IndividualId parent = 0;      // of what follows; 0 = none
  };

  ArchiveSearch(const SearchSetup& setup, const controllers::ScenarioInfo& scenario, LinePolicy policy);

  void Told(const EvaluationOutcome& outcome) override;
  void SaveRest(CanonicalEncoder& encoder) const override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  bool Late() const { return evaluations_done_ > kEarly; }
  // What the outcome says of the finding.
  void Count(const EvaluationOutcome& outcome, Finding& finding) const;
  // Makes the slot's next layout, when what it has is decided.
  void Continue(Slot& slot);
  // False: there is no proposal.
  bool Begin(Slot& slot, std::optional<Proposal> proposal);
  bool BeginPlanned(Slot& slot);
  void BeginAnew(Slot& slot);
  // One of the kinds of lines that have a share; false: it is not their turn, or there is nothing to begin
  // with.
  bool BeginDrawn(Slot& slot, sim::RandomStream& random);
  // Of the elite that is expected to fail least, if that is less than `below`.
  bool BeginRecheck(Slot& slot, double below);
  // Among those that came nearest to failing.
  void Remember(const Individual& individual);
  void PlanNearest(Slot& slot);
  void PlanWithout(Slot& slot, const Finding& found);
  void Rechecked(Slot& slot);
  void UpdatePopulation();
  static void SaveFinding(const Finding& finding, CanonicalEncoder& encoder);
  Result<Finding> RestoreFinding(CanonicalDecoder& decoder) const;
  static void SaveSlot(const Slot& slot, CanonicalEncoder& encoder);
  Status RestoreSlot(CanonicalDecoder& decoder, Slot& slot) const;

  static constexpr std::size_t kRemembered = 8;
  static constexpr double kSteeredShare = 0.5;

  const bool only_deletion_;
  const bool steered_;
  const std::string_view failing_;
  FailureArchive archive_;
  const bool places_;  // the axes are the coordinates of a place
  LayoutProposer proposer_;
  FailurePrior prior_;
  const ArchiveJudge judge_;
  std::vector<Slot> slots_;
  std::deque<std::size_t> waiting_;  // slots whose run is asked for or about to be, in order
  std::size_t asked_ = 0;            // of waiting_, from its front
  IndividualId next_id_ = 1;
  std::vector<Individual> nearest_;  // to failing, of a search that is steered; the nearest first
  std::array<EmitterAccount, kEmitters> accounts_;
};

SearchRow ArchiveRow();
SearchRow RandomDeletionRow();

}  // namespace gauntlet
