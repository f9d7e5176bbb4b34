// The genetic algorithm without generations: as soon as one evaluation is told, the next child is bred, so no
// worker waits for the slowest run of a generation. After the steady-state schemes of Whitley (GENITOR, 1989)
// with the lag made explicit.
#pragma once

#include <cstdint>
#include <deque>
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

// Evaluation k is the only one of individual k. It is asked for when results 1 .. k-L are known, L being
// search.lag, and depends on exactly these, however many more there are: so the outcome is the same for any
// number of workers, of which at most L have work.
//
//   k <= population: a random case, the same as in the generational search.
//   else: the first child of two parents out of the `population` fittest of results 1 .. k-L: the two fittest
//     (2BestParents-2WorseAway), or two at random (the other schemes).
//
// population x generations evaluations in all; "generation" counts populations' worth of them.
class SteadyStateSearch : public SearchAlgorithm {
 public:
  // Error: the ranges leave no room for a valid case.
  static Result<std::unique_ptr<SteadyStateSearch>> Create(const SearchSetup& setup);

  std::vector<EvaluationRequest> Ask() override;
  void Tell(const EvaluationOutcome& outcome) override;
  SearchProgress Progress() const override;
  // Those that have been told, in order of birth; at most search.population.
  std::vector<Individual> Population() const override { return population_; }
  std::vector<Individual> TakeNewborns() override { return std::exchange(newborns_, {}); }
  // distinct_individuals, clone_rate, children: as of GeneticAlgorithm.
  std::vector<std::pair<std::string, double>> Statistics() const override;
  // After every population's worth of results. What was asked and not told is part of the state.
  bool AtBoundary() const override;
  void Save(CanonicalEncoder& encoder) const override;
  Status Restore(CanonicalDecoder& decoder) override;

 private:
  explicit SteadyStateSearch(const SearchSetup& setup);

  std::uint64_t PopulationSize() const;
  std::uint64_t Planned() const;
  std::uint32_t GenerationOf(IndividualId id) const;
  // Gives birth to everybody who may be asked for by now.
  void Release();
  Individual RandomIndividual(IndividualId id) const;
  Individual Child(IndividualId id);

  SearchSetup setup_;
  GenomeGenerator generator_;
  std::uint64_t search_seed_;

  IndividualId next_id_ = 1;
  std::uint64_t told_ = 0;
  std::vector<Individual> population_;
  std::deque<Individual> waiting_;  // asked for or about to be, and not told; in order of birth
  std::size_t asked_ = 0;           // of `waiting_`, from its front
  std::uint64_t children_born_ = 0;
  std::uint64_t clones_born_ = 0;
  std::set<std::uint64_t> genomes_seen_;  // GenomeHash of all who were born
  std::vector<Individual> newborns_;
};

}  // namespace gauntlet::master
