#include "search/evolution/breeding_search.h"

#include <fmt/format.h>

#include "search/evolution/selection.h"

namespace gauntlet {

std::vector<std::pair<std::string, double>> BreedingSearch::Statistics() const {
  const auto born = static_cast<double>(children_born_);
  const double clone_rate = children_born_ == 0 ? 0.0 : static_cast<double>(clones_born_) / born;
  return {{"clone_rate", clone_rate}, {"children", born}};
}

Result<std::vector<Individual>> BreedingSearch::InitialPopulation() const {
  std::vector<Individual> population;
  for (IndividualId id = 1; id <= PopulationSize(); ++id) {
    TRY(auto test_case, DrawCase(id));
    population.push_back(MakeIndividual(id, std::move(test_case)));
  }
  return population;
}

std::array<std::size_t, 2> BreedingSearch::ChooseParents(std::uint32_t number) const {
  if (spec().parent_selection == ParentSelection::kTwoBestParentsTwoWorseAway) return TwoFittest(population_);
  sim::RandomStream random(search_seed_, sim::StreamPurpose::kVariation, number, kParentChoiceSlot);
  return TwoAtRandom(population_.size(), random);
}

Offspring BreedingSearch::BreedPair(std::size_t first, std::size_t second, std::uint32_t number,
                                    std::uint32_t couple) const {
  return Breed(population_[first].test_case.obstacles, population_[second].test_case.obstacles, spec(),
               generator_, {.search_seed = search_seed_, .generation = number, .couple = couple});
}

Individual BreedingSearch::GiveBirth(sim::Genome genome, const Individual& first, const Individual& second,
                                     std::uint32_t generation) {
  ++children_born_;
  if (genome == first.test_case.obstacles || genome == second.test_case.obstacles) ++clones_born_;
  Individual child = MakeIndividual(next_id_++, generator_.WithObstacles(std::move(genome)));
  child.parents = {first.id, second.id};
  child.birth_generation = generation;
  return child;
}

void BreedingSearch::SaveBirths(CanonicalEncoder& encoder) const {
  encoder.Uint(next_id_);
  encoder.Uint(children_born_);
  encoder.Uint(clones_born_);
}

void BreedingSearch::RestoreBirths(CanonicalDecoder& decoder) {
  next_id_ = decoder.Uint();
  children_born_ = decoder.Uint();
  clones_born_ = decoder.Uint();
}

std::vector<std::string_view> BreedingKeys() {
  return {"search.population",   "search.generations",           "search.parent_selection",
          "search.crossover",    "search.crossover_probability", "search.mutation_probability",
          "search.reevaluation", "search.fitness_aggregation",   "search.objective",
          "search.replicates",   "search.variation_tries",       "genome."};
}

std::optional<BrokenRule> CheckBreeding(const Experiment& experiment) {
  if (experiment.genome.genes == 0) {
    return BrokenRule{"genome.genes", "genome.genes = 0 leaves nothing to evolve: use 1 or more"};
  }
  if (std::optional<BrokenRule> objective = CheckObjective(experiment)) return objective;
  if (experiment.search.population % 2 == 0) return std::nullopt;
  return BrokenRule{"search.population", fmt::format("search.population = {} must be even: couples breed",
                                                     experiment.search.population)};
}

}  // namespace gauntlet
