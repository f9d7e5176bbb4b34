// The genetic algorithm of thesis 3.2: generation 1 is a random population; every further generation selects
// parents, crosses and mutates them, and simulates again. Readings of the thesis: spec section 7, A-1 to A-6.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "master/search/genome_generator.h"
#include "master/search/individuals.h"
#include "master/search/search_algorithm.h"
#include "master/search/search_setup.h"

namespace gauntlet::master {

// Ask gives one whole generation; at its last Tell the algorithm stands at a boundary, and the next Ask
// breeds.
//
//   2BestParents-2WorseAway, 2RandomParents-2WorseAway: two parents make two children, which take the places
//     of the two least fit; then everybody is simulated with new seeds (20 x 50 = 1000 evaluations, A-1), or
//     the children only (reevaluation = children).
//   AllParent-BestHalf: everybody is a parent, in random couples; the children are simulated (20 + 20 x 29 =
//     600 evaluations in 30 generations, A-2), or parents and children (reevaluation = population); the
//     fitter half of both stays.
//
// Population() is in order of birth; children of AllParent-BestHalf belong to it once they have survived.
class GeneticAlgorithm : public SearchAlgorithm {
 public:
  // Draws the initial population. Error: the ranges leave no room for a valid case.
  static Result<std::unique_ptr<GeneticAlgorithm>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  void Tell(const EvaluationOutcome& outcome) override;
  SearchProgress Progress() const override;
  std::vector<Individual> Population() const override { return population_; }
  std::vector<Individual> TakeNewborns() override { return std::exchange(newborns_, {}); }
  // distinct_individuals: different genomes simulated so far; clone_rate: share of the children whose genome
  // is a parent's; children: born so far.
  std::vector<std::pair<std::string, double>> Statistics() const override;
  bool AtBoundary() const override { return pending_.empty(); }
  void Save(CanonicalEncoder& encoder) const override;
  Status Restore(CanonicalDecoder& decoder) override;

 private:
  explicit GeneticAlgorithm(const SearchSetup& setup);

  bool AllParents() const;
  bool ReevaluatesParents() const;
  void BreedAllParents();
  void BreedTwoParents();
  // Appends the two children of population_[first] and population_[second] to children_.
  void BreedCouple(std::size_t first, std::size_t second, std::uint32_t couple);
  void AddChild(sim::Genome genome, const Individual& first, const Individual& second);
  void EndGeneration();
  Individual& Find(IndividualId id);

  SearchSetup setup_;
  GenomeGenerator generator_;
  std::uint64_t search_seed_;

  std::uint32_t generation_ = 0;  // 0 before the first Ask
  IndividualId next_id_ = 1;
  std::vector<Individual> population_;
  std::vector<Individual> children_;  // of AllParent-BestHalf, until their generation is complete
  std::uint64_t evaluations_done_ = 0;
  std::uint64_t children_born_ = 0;
  std::uint64_t clones_born_ = 0;
  std::set<std::uint64_t> genomes_seen_;  // GenomeHash

  std::vector<Individual> newborns_;
  PendingRequests pending_;
};

}  // namespace gauntlet::master
