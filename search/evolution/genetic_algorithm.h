// The genetic algorithm of thesis 3.2: generation 1 is a random population; every further generation selects
// parents, crosses and mutates them, and simulates again.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "search/evolution/breeding_search.h"
#include "search/search_row.h"

namespace gauntlet {

// Ask gives one whole generation; at its last Tell the algorithm stands at a boundary, and the next Ask
// breeds.
//
//   2BestParents-2WorseAway, 2RandomParents-2WorseAway: two parents make two children, which take the places
//     of the two least fit; then everybody is simulated with new seeds (20 x 50 = 1000 evaluations), or the
//     children only (reevaluation = children).
//   AllParent-BestHalf: everybody is a parent, in random couples; the children are simulated (20 + 20 x 29 =
//     600 evaluations in 30 generations), or parents and children (reevaluation = population); the fitter
//     half of both stays.
//
// Population() is in order of birth; children of AllParent-BestHalf belong to it once they have survived.
class GeneticAlgorithm : public BreedingSearch {
 public:
  // Draws the initial population. Error: the ranges leave no room for a valid case.
  static Result<std::unique_ptr<GeneticAlgorithm>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  SearchProgress Progress() const override;

 private:
  explicit GeneticAlgorithm(const SearchSetup& setup) : BreedingSearch(setup) {}

  void Told(const EvaluationOutcome& outcome) override;
  void SaveRest(CanonicalEncoder& encoder) const override;
  Status RestoreRest(CanonicalDecoder& decoder, const History& history) override;

  bool AllParents() const;
  bool ReevaluatesParents() const;
  void BreedAllParents();
  void BreedTwoParents();
  // Appends the two children of population_[first] and population_[second] to children_.
  void BreedCouple(std::size_t first, std::size_t second, std::uint32_t couple);
  Individual& Find(IndividualId id);

  std::uint32_t generation_ = 0;      // 0 before the first Ask
  std::vector<Individual> children_;  // of AllParent-BestHalf, until their generation is complete
};

SearchRow GeneticRow();

}  // namespace gauntlet
