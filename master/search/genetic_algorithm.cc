#include "master/search/genetic_algorithm.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "master/search/selection.h"
#include "master/search/variation.h"
#include "sim/arena/genome_codec.h"

namespace gauntlet::master {
namespace {

// Saved states begin with it. Raise it whenever the encoding or the meaning of a state changes.
constexpr std::uint64_t kStateFormat = 1;

Error Damaged(const std::string& what) {
  return {ErrorKind::kCorrupt, "the saved search state is damaged: " + what};
}

}  // namespace

GeneticAlgorithm::GeneticAlgorithm(const SearchSetup& setup)
    : setup_(setup), generator_(MakeGenerator(setup)), search_seed_(SearchSeed(setup)) {}

Result<std::unique_ptr<GeneticAlgorithm>> GeneticAlgorithm::Create(const SearchSetup& setup) {
  const int size = setup.experiment.search.population;
  GAUNTLET_CHECK(size >= 4 && size % 2 == 0, fmt::format("population {}", size));
  std::unique_ptr<GeneticAlgorithm> search(new GeneticAlgorithm(setup));
  for (int i = 0; i < size; ++i) {
    const IndividualId id = search->next_id_++;
    sim::RandomStream random = GenomeStream(search->search_seed_, id);
    Result<sim::TestCase> test_case = search->generator_.RandomTestCase(random);
    if (!test_case.ok()) return test_case.error();
    search->population_.push_back(MakeIndividual(id, std::move(*test_case)));
  }
  return search;
}

bool GeneticAlgorithm::AllParents() const {
  return setup_.experiment.search.parent_selection == ParentSelection::kAllParentBestHalf;
}

bool GeneticAlgorithm::ReevaluatesParents() const {
  switch (setup_.experiment.search.reevaluation) {
    case Reevaluation::kPopulation:
      return true;
    case Reevaluation::kChildren:
      return false;
    case Reevaluation::kScheme:
      break;
  }
  return !AllParents();
}

std::vector<EvaluationRequest> GeneticAlgorithm::Ask() {
  const auto generations = static_cast<std::uint32_t>(setup_.experiment.search.generations);
  if (!AtBoundary() || generation_ >= generations) return {};
  ++generation_;
  if (generation_ == 1) {
    newborns_ = population_;
  } else if (AllParents()) {
    BreedAllParents();
  } else {
    BreedTwoParents();
  }

  std::vector<EvaluationRequest> requests;
  const auto request = [&](const Individual& individual) {
    if (individual.birth_generation != generation_ && !ReevaluatesParents()) return;
    requests.push_back(NextEvaluation(individual, setup_.experiment.search.replicates, generation_));
    pending_.Add(requests.back());
    genomes_seen_.insert(GenomeHash(individual.test_case.obstacles));
  };
  for (const Individual& individual : population_) request(individual);
  for (const Individual& individual : children_) request(individual);
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
  std::array<std::size_t, 2> parents{};
  if (setup_.experiment.search.parent_selection == ParentSelection::kTwoBestParentsTwoWorseAway) {
    parents = TwoFittest(population_);
  } else {
    sim::RandomStream random(search_seed_, sim::StreamPurpose::kVariation, generation_, kParentChoiceSlot);
    parents = TwoAtRandom(population_.size(), random);
  }
  BreedCouple(parents[0], parents[1], 0);
  KeepFittest(population_, population_.size() - children_.size());
  std::move(children_.begin(), children_.end(), std::back_inserter(population_));
  children_.clear();
}

void GeneticAlgorithm::BreedCouple(std::size_t first, std::size_t second, std::uint32_t couple) {
  const Individual& a = population_[first];
  const Individual& b = population_[second];
  Offspring offspring =
      Breed(a.test_case.obstacles, b.test_case.obstacles, setup_.experiment.search, generator_,
            {.search_seed = search_seed_, .generation = generation_, .couple = couple});
  AddChild(std::move(offspring.first), a, b);
  AddChild(std::move(offspring.second), a, b);
}

void GeneticAlgorithm::AddChild(sim::Genome genome, const Individual& first, const Individual& second) {
  ++children_born_;
  if (genome == first.test_case.obstacles || genome == second.test_case.obstacles) ++clones_born_;
  Individual child = MakeIndividual(next_id_++, generator_.WithObstacles(std::move(genome)));
  child.parents = {first.id, second.id};
  child.birth_generation = generation_;
  newborns_.push_back(child);
  children_.push_back(std::move(child));
}

Individual& GeneticAlgorithm::Find(IndividualId id) {
  for (std::vector<Individual>* group : {&population_, &children_}) {
    const auto found =
        std::find_if(group->begin(), group->end(), [id](const Individual& one) { return one.id == id; });
    if (found != group->end()) return *found;
  }
  CheckFailed("individual is known", __FILE__, __LINE__, fmt::format("individual {}", id));
}

void GeneticAlgorithm::Tell(const EvaluationOutcome& outcome) {
  pending_.Settle(outcome);
  RecordOutcome(outcome, setup_.experiment.search.aggregation, Find(outcome.individual));
  ++evaluations_done_;
  if (pending_.empty()) EndGeneration();
}

void GeneticAlgorithm::EndGeneration() {
  if (children_.empty()) return;
  const std::size_t size = population_.size();
  std::move(children_.begin(), children_.end(), std::back_inserter(population_));
  children_.clear();
  KeepFittest(population_, size);
}

SearchProgress GeneticAlgorithm::Progress() const {
  const auto size = static_cast<std::uint64_t>(setup_.experiment.search.population);
  const auto generations = static_cast<std::uint64_t>(setup_.experiment.search.generations);
  const std::uint64_t children = AllParents() ? size : 2;
  const std::uint64_t parents = !ReevaluatesParents() ? 0 : AllParents() ? size : size - children;
  return {.generation = generation_,
          .generations = static_cast<std::uint32_t>(generations),
          .evaluations_done = evaluations_done_,
          .evaluations_planned = size + (generations - 1) * (parents + children),
          .finished = generation_ >= generations && AtBoundary()};
}

std::vector<std::pair<std::string, double>> GeneticAlgorithm::Statistics() const {
  const double clone_rate =
      children_born_ == 0 ? 0.0 : static_cast<double>(clones_born_) / static_cast<double>(children_born_);
  return {{"distinct_individuals", static_cast<double>(genomes_seen_.size())},
          {"clone_rate", clone_rate},
          {"children", static_cast<double>(children_born_)}};
}

void GeneticAlgorithm::Save(CanonicalEncoder& encoder) const {
  GAUNTLET_CHECK(AtBoundary(), fmt::format("{} evaluations are outstanding", pending_.size()));
  WriteStateHead(kStateFormat, setup_, encoder);
  encoder.Uint(generation_);
  encoder.Uint(next_id_);
  encoder.Uint(evaluations_done_);
  encoder.Uint(children_born_);
  encoder.Uint(clones_born_);
  encoder.Uint(population_.size());
  for (const Individual& individual : population_) EncodeIndividual(individual, encoder);
  encoder.Uint(genomes_seen_.size());
  for (const std::uint64_t hash : genomes_seen_) encoder.Uint(hash);
}

Status GeneticAlgorithm::Restore(CanonicalDecoder& decoder) {
  Status head = ReadStateHead(kStateFormat, setup_, decoder);
  if (!head.ok()) return head;
  const SearchSpec& spec = setup_.experiment.search;
  const std::uint64_t generation = decoder.Uint();
  if (generation > static_cast<std::uint64_t>(spec.generations)) {
    return InvalidInput(
        fmt::format("the saved search state is in generation {}, but the experiment ends at "
                    "search.generations = {}",
                    generation, spec.generations));
  }
  const IndividualId next_id = decoder.Uint();
  const std::uint64_t evaluations_done = decoder.Uint();
  const std::uint64_t children_born = decoder.Uint();
  const std::uint64_t clones_born = decoder.Uint();
  const std::uint64_t size = decoder.Uint();
  if (!decoder.ok() || size != static_cast<std::uint64_t>(spec.population)) {
    return Damaged(fmt::format("{} individuals instead of {}", size, spec.population));
  }
  std::vector<Individual> population;
  for (std::uint64_t i = 0; i < size && decoder.ok(); ++i) {
    Individual individual = DecodeIndividual(spec.aggregation, decoder);
    if (std::ssize(individual.test_case.obstacles) != setup_.experiment.genome.genes || individual.id == 0 ||
        individual.id >= next_id) {
      return Damaged(fmt::format("individual {} does not fit", individual.id));
    }
    individual.test_case = generator_.WithObstacles(std::move(individual.test_case.obstacles));
    population.push_back(std::move(individual));
  }
  std::set<std::uint64_t> genomes_seen;
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    genomes_seen.insert(decoder.Uint());
  }
  if (!decoder.ok()) return Damaged("it is cut off");

  generation_ = static_cast<std::uint32_t>(generation);
  next_id_ = next_id;
  evaluations_done_ = evaluations_done;
  children_born_ = children_born;
  clones_born_ = clones_born;
  population_ = std::move(population);
  genomes_seen_ = std::move(genomes_seen);
  children_.clear();
  newborns_.clear();
  pending_ = {};
  return Ok{};
}

}  // namespace gauntlet::master
