// The genetic algorithm without generations: as soon as one evaluation is told, the next child is bred, so no
// worker waits for the slowest run of a generation. After the steady-state schemes of Whitley (GENITOR, 1989)
// with the lag made explicit.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "search/evolution/breeding_search.h"
#include "search/search_row.h"

namespace gauntlet {

// Evaluation k is the only one of individual k. It is asked for when results 1 .. k-L are known, L being
// search.lag, and depends on exactly these, however many more there are: so the outcome is the same for any
// number of workers, of which at most L have work.
//
//   k <= population: a random case, the same as in the generational search.
//   else: the first child of two parents out of the `population` fittest of results 1 .. k-L: the two fittest
//     (2BestParents-2WorseAway), or two at random (the other schemes).
//
// Those who would come next are born at the end of a search too, though nobody asks for them: a longer search
// goes on with them. population x generations evaluations in all; "generation" counts populations' worth of
// them. Population() is those who have been told and are among the fittest, in order of birth; at most
// search.population.
class SteadyStateSearch : public BreedingSearch {
 public:
  // Error: the ranges leave no room for a valid case.
  static Result<std::unique_ptr<SteadyStateSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  SearchProgress Progress() const override;
  // After every population's worth of results. What was asked and not told is part of the state.
  bool AtBoundary() const override { return evaluations_done_ % PopulationSize() == 0; }

 private:
  explicit SteadyStateSearch(const SearchSetup& setup) : BreedingSearch(setup) {}

  void Told(const EvaluationOutcome& outcome) override;
  void SaveRest(CanonicalEncoder& encoder) const override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  std::uint64_t Lag() const;
  std::uint64_t Planned() const;
  std::uint32_t GenerationOf(IndividualId id) const;
  // Gives birth to everybody who may be asked for by now, however long the search is.
  void Release();

  std::vector<Individual> initial_;
  std::deque<Individual> waiting_;  // asked for or about to be, and not told; in order of birth
  std::size_t asked_ = 0;           // of `waiting_`, from its front
};

SearchRow SteadyStateRow();

}  // namespace gauntlet
