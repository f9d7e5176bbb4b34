#include "search/evolution/genetic_algorithm.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/check.h"
#include "base/number_text.h"
#include "search/evolution/selection.h"

namespace gauntlet {

Result<std::unique_ptr<GeneticAlgorithm>> GeneticAlgorithm::Create(const SearchSetup& setup) {
  const int size = setup.experiment.search.population;
  GAUNTLET_CHECK(size >= 4 && size % 2 == 0, fmt::format("population {}", size));
  std::unique_ptr<GeneticAlgorithm> search(new GeneticAlgorithm(setup));
  TRY(search->population_, search->InitialPopulation());
  search->next_id_ += search->PopulationSize();
  return search;
}

bool GeneticAlgorithm::AllParents() const {
  return spec().parent_selection == ParentSelection::kAllParentBestHalf;
}

bool GeneticAlgorithm::ReevaluatesParents() const {
  return spec().reevaluation == Reevaluation::kScheme ? !AllParents()
                                                      : spec().reevaluation == Reevaluation::kPopulation;
}

std::vector<EvaluationRequest> GeneticAlgorithm::Ask() {
  if (!AtBoundary() || generation_ >= static_cast<std::uint32_t>(spec().generations)) return {};
  ++generation_;
  if (generation_ == 1) {
    newborns_ = population_;
  } else if (AllParents()) {
    BreedAllParents();
  } else {
    BreedTwoParents();
  }

  std::vector<EvaluationRequest> requests;
  for (const std::vector<Individual>* group : {&population_, &children_}) {
    for (const Individual& individual : *group) {
      if (individual.birth_generation != generation_ && !ReevaluatesParents()) continue;
      requests.push_back(Request(individual, generation_));
    }
  }
  return requests;
}

void GeneticAlgorithm::BreedAllParents() {
  sim::RandomStream random(search_seed_, sim::StreamPurpose::kVariation, generation_, kParentChoiceSlot);
  const std::vector<std::size_t> order = Shuffled(population_.size(), random);
  for (std::size_t i = 0; i + 1 < order.size(); i += 2) {
    BreedCouple(order[i], order[i + 1], static_cast<std::uint32_t>(i / 2));
  }
}

void GeneticAlgorithm::BreedTwoParents() {
  const auto [first, second] = ChooseParents(generation_);
  BreedCouple(first, second, 0);
  KeepFittest(population_, population_.size() - children_.size());
  std::move(children_.begin(), children_.end(), std::back_inserter(population_));
  children_.clear();
}

void GeneticAlgorithm::BreedCouple(std::size_t first, std::size_t second, std::uint32_t couple) {
  Offspring offspring = BreedPair(first, second, generation_, couple);
  for (sim::Genome* genome : {&offspring.first, &offspring.second}) {
    children_.push_back(GiveBirth(std::move(*genome), population_[first], population_[second], generation_));
    newborns_.push_back(children_.back());
  }
}

Individual& GeneticAlgorithm::Find(IndividualId id) {
  for (std::vector<Individual>* group : {&population_, &children_}) {
    const auto found = std::ranges::find(*group, id, &Individual::id);
    if (found != group->end()) return *found;
  }
  CheckFailed("individual is known", __FILE__, __LINE__, fmt::format("individual {}", id));
}

void GeneticAlgorithm::Told(const EvaluationOutcome& outcome) {
  Record(outcome, Find(outcome.individual));
  if (!AtBoundary() || children_.empty()) return;
  std::move(children_.begin(), children_.end(), std::back_inserter(population_));
  children_.clear();
  KeepFittest(population_, PopulationSize());
}

SearchProgress GeneticAlgorithm::Progress() const {
  const std::uint64_t size = PopulationSize();
  const auto generations = static_cast<std::uint64_t>(spec().generations);
  const std::uint64_t children = AllParents() ? size : 2;
  const std::uint64_t parents = !ReevaluatesParents() ? 0 : AllParents() ? size : size - children;
  return {.generation = generation_,
          .generations = static_cast<std::uint32_t>(generations),
          .evaluations_done = evaluations_done_,
          .evaluations_planned = size + (generations - 1) * (parents + children),
          .individuals_planned = size + (generations - 1) * children,
          .finished = generation_ >= generations && AtBoundary()};
}

void GeneticAlgorithm::SaveRest(CanonicalEncoder& encoder) const {
  encoder.Uint(generation_);
  SaveBirths(encoder);
  SaveIndividuals(population_, encoder);
}

Status GeneticAlgorithm::RestoreRest(CanonicalDecoder& decoder, const History& /*history*/) {
  generation_ = static_cast<std::uint32_t>(decoder.Uint());
  RestoreBirths(decoder);
  TRY(population_, RestoreIndividuals(PopulationSize(), next_id_, decoder));
  return Ok{};
}

SearchRow GeneticRow() {
  return {.info = {.name = "genetic",
                   .description =
                       "a population of test cases is bred for low fitness, generation after generation: "
                       "gauntlet evolve",
                   .keys = BreedingKeys(),
                   .length = "search.generations",
                   .check = CheckBreeding},
          .number = 0,
          .title = "genetic search",
          .individuals = Individuals::kPopulation,
          .plan =
              [](const Experiment& e) {
                return fmt::format("{} test cases x {}", e.search.population,
                                   Counted(e.search.generations, "generation"));
              },
          .make = Make<GeneticAlgorithm>};
}

}  // namespace gauntlet
