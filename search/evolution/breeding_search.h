// What the searches that breed have in common: two parents out of the population, their children, and how
// many of these are copies.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "search/evolution/population_search.h"
#include "search/evolution/variation.h"

namespace gauntlet {

class BreedingSearch : public PopulationSearch {
 public:
  // clone_rate: share of the children whose genome is a parent's; children: born so far.
  std::vector<std::pair<std::string, double>> Statistics() const final;

 protected:
  using PopulationSearch::PopulationSearch;

  std::uint64_t PopulationSize() const { return static_cast<std::uint64_t>(spec().population); }
  // search.population random individuals, numbered from 1. Error: the ranges leave no room for a valid case.
  Result<std::vector<Individual>> InitialPopulation() const;
  // Indices into population_: the two fittest (2BestParents-2WorseAway) or two at random. `number` names the
  // random stream.
  std::array<std::size_t, 2> ChooseParents(std::uint32_t number) const;
  // The children of population_[first] and population_[second], not born yet.
  Offspring BreedPair(std::size_t first, std::size_t second, std::uint32_t number,
                      std::uint32_t couple) const;
  // Gives birth to a child with the next number. That it is handed over by TakeNewborns is the caller's
  // business.
  Individual GiveBirth(sim::Genome genome, const Individual& first, const Individual& second,
                       std::uint32_t generation);

  void SaveBirths(CanonicalEncoder& encoder) const;
  void RestoreBirths(CanonicalDecoder& decoder);

  IndividualId next_id_ = 1;

 private:
  std::uint64_t children_born_ = 0;
  std::uint64_t clones_born_ = 0;
};

// Keys and rules of a search that breeds, for its row.
std::vector<std::string_view> BreedingKeys();
std::optional<BrokenRule> CheckBreeding(const Experiment& experiment);

}  // namespace gauntlet
