// CMA-ME with improvement emitters, a baseline from the literature beside our own archive search: M. C.
// Fontaine, J. Togelius, S. Nikolaidis, A. K. Hoover, "Covariance Matrix Adaptation for the Rapid
// Illumination of Behavior Space" (GECCO 2020).
#pragma once

#include <compare>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "search/archive/failure_archive.h"
#include "search/evolution/population_search.h"
#include "search/repair/cma_es.h"
#include "search/search_row.h"

namespace gauntlet {

// What came of a proposal, the best first.
struct EmitterRank {
  enum class Entry : std::uint8_t { kNewCell, kImprovedCell, kNone };
  Entry entry = Entry::kNone;
  double value = 0.0;     // the fitness; of what improved its cell, how much higher it is than the one before
  std::size_t place = 0;  // in the generation
  auto operator<=>(const EmitterRank&) const = default;
};

// A solution is all obstacles of a case, five numbers each. search.emitters emitters, each a CMA-ES, propose
// a generation after the other, beginning at a uniformly drawn elite (in the middle of all ranges as long as
// there is none), and anew when nothing of a generation entered the archive. The archive keeps the lowest
// fitness of each cell, whether the run failed or not; a run that had nothing to measure is in no cell. What
// the paper leaves open or has otherwise:
// - Obstacles of a proposal that break a validity rule are drawn anew as in random cases, and so is, of each,
//   whether it moves or carries lights.
// - The better half of a generation is always followed: where fewer entered the archive, the toughest of the
//   others fill it up.
//
// A generation is drawn when the last run of the emitter's one before is told, so what is asked depends on
// the results of all runs before that, in order, for any number of workers. A state says only how many
// outcomes were told: they are told again. Population() and Archive() are the elites that fail.
class CmaMeSearch : public PopulationSearch {
 public:
  static constexpr std::uint64_t kSaveInterval = 100;  // outcomes from boundary to boundary

  // Error: the scenario has no axes, or the ranges leave no room for a valid case.
  static Result<std::unique_ptr<CmaMeSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  bool WantsMetrics() const override { return true; }
  SearchProgress Progress() const override;
  std::vector<std::pair<std::string, double>> Statistics() const override;
  ArchiveView Archive() const override;
  // After every kSaveInterval outcomes, and at the end. What was asked and not told is asked again.
  bool AtBoundary() const override;

 private:
  struct Emitter {
    CmaEs cma;
    IndividualId parent = 0;              // where it began; 0 = no elite
    std::vector<EmitterRank> ranks = {};  // of the generation, of those that are told
  };
  struct Proposal {
    Finding finding;  // its `failures`: of all runs that have a cell
    SettingsPoint point;
    std::size_t emitter = 0;

    // In half of its runs or more.
    bool fails() const {
      return finding.tally.failures > 0 && finding.tally.failures >= finding.tally.passes;
    }
  };

  explicit CmaMeSearch(const SearchSetup& setup);

  void Told(const EvaluationOutcome& outcome) override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  Emitter Begin() const;
  void Propose(std::size_t emitter);
  sim::TestCase CaseAt(const SettingsPoint& point, IndividualId id) const;
  bool HasCell(const RunOutcome& run, const Descriptor& descriptor) const;
  // Puts it into its cell, if it is the best there. What it is worth to its emitter.
  std::pair<EmitterRank::Entry, double> Enter(Proposal proposal);

  const std::string failing_;
  const DescriptorGrid grid_;
  std::vector<Emitter> emitters_;
  std::deque<Proposal> waiting_;  // to be told
  std::size_t asked_ = 0;         // of waiting_, from its front
  IndividualId next_id_ = 1;
  std::map<std::size_t, Proposal> elites_;  // by cell
  std::uint64_t restarts_ = 0;
};

SearchRow CmaMeRow();

}  // namespace gauntlet
