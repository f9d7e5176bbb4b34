#include "master/search/steady_state_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "base/check.h"
#include "master/search/selection.h"
#include "master/search/variation.h"
#include "sim/arena/genome_codec.h"

namespace gauntlet::master {
namespace {

// Saved states begin with it. Raise it whenever the encoding or the meaning of a state changes.
constexpr std::uint64_t kSteadyStateFormat = 1;

Error DamagedState(const std::string& what) {
  return {ErrorKind::kCorrupt, "the saved search state is damaged: " + what};
}

}  // namespace

SteadyStateSearch::SteadyStateSearch(const SearchSetup& setup)
    : setup_(setup), generator_(MakeGenerator(setup)), search_seed_(SearchSeed(setup)) {}

Result<std::unique_ptr<SteadyStateSearch>> SteadyStateSearch::Create(const SearchSetup& setup) {
  const SearchSpec& spec = setup.experiment.search;
  GAUNTLET_CHECK(LagOf(spec) >= 1 && LagOf(spec) < spec.population,
                 fmt::format("lag {} of population {}", LagOf(spec), spec.population));
  std::unique_ptr<SteadyStateSearch> search(new SteadyStateSearch(setup));
  for (IndividualId id = 1; id <= search->PopulationSize(); ++id) {
    sim::RandomStream random = GenomeStream(search->search_seed_, id);
    const Result<sim::TestCase> trial = search->generator_.RandomTestCase(random);
    if (!trial.ok()) return trial.error();
  }
  search->Release();
  return search;
}

std::uint64_t SteadyStateSearch::PopulationSize() const {
  return static_cast<std::uint64_t>(setup_.experiment.search.population);
}

std::uint64_t SteadyStateSearch::Planned() const {
  return PopulationSize() * static_cast<std::uint64_t>(setup_.experiment.search.generations);
}

std::uint32_t SteadyStateSearch::GenerationOf(IndividualId id) const {
  return static_cast<std::uint32_t>((id - 1) / PopulationSize()) + 1;
}

Individual SteadyStateSearch::RandomIndividual(IndividualId id) const {
  sim::RandomStream random = GenomeStream(search_seed_, id);
  Result<sim::TestCase> test_case = generator_.RandomTestCase(random);
  GAUNTLET_CHECK(test_case.ok(), "the initial population was drawn before");
  return MakeIndividual(id, std::move(*test_case));
}

Individual SteadyStateSearch::Child(IndividualId id) {
  const SearchSpec& spec = setup_.experiment.search;
  const auto number = static_cast<std::uint32_t>(id);
  std::array<std::size_t, 2> parents{};
  if (spec.parent_selection == ParentSelection::kTwoBestParentsTwoWorseAway) {
    parents = TwoFittest(population_);
  } else {
    sim::RandomStream random(search_seed_, sim::StreamPurpose::kVariation, number, kParentChoiceSlot);
    parents = TwoAtRandom(population_.size(), random);
  }
  const Individual& first = population_[parents[0]];
  const Individual& second = population_[parents[1]];
  Offspring offspring = Breed(first.test_case.obstacles, second.test_case.obstacles, spec, generator_,
                              {.search_seed = search_seed_, .generation = number, .couple = 0});
  ++children_born_;
  const sim::Genome& genome = offspring.first;
  if (genome == first.test_case.obstacles || genome == second.test_case.obstacles) ++clones_born_;
  Individual child = MakeIndividual(id, generator_.WithObstacles(std::move(offspring.first)));
  child.parents = {first.id, second.id};
  child.birth_generation = GenerationOf(id);
  return child;
}

void SteadyStateSearch::Release() {
  const auto lag = static_cast<std::uint64_t>(LagOf(setup_.experiment.search));
  while (next_id_ <= std::min(Planned(), told_ + lag)) {
    const IndividualId id = next_id_++;
    waiting_.push_back(id <= PopulationSize() ? RandomIndividual(id) : Child(id));
    newborns_.push_back(waiting_.back());
    genomes_seen_.insert(GenomeHash(waiting_.back().test_case.obstacles));
  }
}

std::vector<EvaluationRequest> SteadyStateSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  for (; asked_ < waiting_.size(); ++asked_) {
    const Individual& individual = waiting_[asked_];
    requests.push_back(
        NextEvaluation(individual, setup_.experiment.search.replicates, individual.birth_generation));
  }
  return requests;
}

void SteadyStateSearch::Tell(const EvaluationOutcome& outcome) {
  GAUNTLET_CHECK(
      asked_ > 0 && waiting_.front().id == outcome.individual && outcome.evaluation == 0,
      fmt::format("told individual {} evaluation {} out of order", outcome.individual, outcome.evaluation));
  population_.push_back(std::move(waiting_.front()));
  waiting_.pop_front();
  --asked_;
  RecordOutcome(outcome, setup_.experiment.search.aggregation, population_.back());
  if (population_.size() > PopulationSize()) KeepFittest(population_, PopulationSize());
  ++told_;
  Release();
}

bool SteadyStateSearch::AtBoundary() const {
  return told_ % PopulationSize() == 0;
}

SearchProgress SteadyStateSearch::Progress() const {
  return {.generation = GenerationOf(std::max<std::uint64_t>(told_, 1)),
          .generations = static_cast<std::uint32_t>(setup_.experiment.search.generations),
          .evaluations_done = told_,
          .evaluations_planned = Planned(),
          .finished = told_ >= Planned()};
}

std::vector<std::pair<std::string, double>> SteadyStateSearch::Statistics() const {
  const double clone_rate =
      children_born_ == 0 ? 0.0 : static_cast<double>(clones_born_) / static_cast<double>(children_born_);
  return {{"distinct_individuals", static_cast<double>(genomes_seen_.size())},
          {"clone_rate", clone_rate},
          {"children", static_cast<double>(children_born_)}};
}

void SteadyStateSearch::Save(CanonicalEncoder& encoder) const {
  GAUNTLET_CHECK(AtBoundary(), fmt::format("{} results are told", told_));
  WriteStateHead(kSteadyStateFormat, setup_, encoder);
  encoder.Uint(next_id_);
  encoder.Uint(told_);
  encoder.Uint(children_born_);
  encoder.Uint(clones_born_);
  encoder.Uint(population_.size());
  for (const Individual& individual : population_) EncodeIndividual(individual, encoder);
  encoder.Uint(waiting_.size());
  for (const Individual& individual : waiting_) EncodeIndividual(individual, encoder);
  encoder.Uint(genomes_seen_.size());
  for (const std::uint64_t hash : genomes_seen_) encoder.Uint(hash);
}

Status SteadyStateSearch::Restore(CanonicalDecoder& decoder) {
  Status head = ReadStateHead(kSteadyStateFormat, setup_, decoder);
  if (!head.ok()) return head;
  const SearchSpec& spec = setup_.experiment.search;
  const IndividualId next_id = decoder.Uint();
  const std::uint64_t told = decoder.Uint();
  const std::uint64_t children_born = decoder.Uint();
  const std::uint64_t clones_born = decoder.Uint();
  if (decoder.ok() && told > Planned()) {
    return InvalidInput(
        fmt::format("the saved search state has {} results, but the experiment ends at search.population x "
                    "search.generations = {}",
                    told, Planned()));
  }
  // At most `most` individuals with smaller numbers than `below`.
  std::optional<std::string> damage;
  const auto read = [&](std::uint64_t most, IndividualId below) {
    std::vector<Individual> individuals;
    const std::uint64_t count = decoder.Uint();
    if (!decoder.ok() || count > most) damage = fmt::format("{} individuals instead of {}", count, most);
    for (std::uint64_t i = 0; i < count && decoder.ok() && !damage; ++i) {
      Individual individual = DecodeIndividual(spec.aggregation, decoder);
      if (std::ssize(individual.test_case.obstacles) != setup_.experiment.genome.genes ||
          individual.id == 0 || individual.id >= below) {
        damage = fmt::format("individual {} does not fit", individual.id);
      }
      individual.test_case = generator_.WithObstacles(std::move(individual.test_case.obstacles));
      individuals.push_back(std::move(individual));
    }
    return individuals;
  };
  std::vector<Individual> population = read(PopulationSize(), told + 1);
  std::vector<Individual> waiting = read(static_cast<std::uint64_t>(LagOf(spec)), next_id);
  if (damage) return DamagedState(*damage);
  std::set<std::uint64_t> genomes_seen;
  for (std::uint64_t left = decoder.Uint(); left > 0 && decoder.ok(); --left) {
    genomes_seen.insert(decoder.Uint());
  }
  if (!decoder.ok()) return DamagedState("it is cut off");
  for (std::size_t i = 0; i < waiting.size(); ++i) {
    if (waiting[i].id != told + 1 + i) return DamagedState(fmt::format("individual {} waits", waiting[i].id));
  }
  if (population.size() != std::min(told, PopulationSize()) || next_id != told + 1 + waiting.size()) {
    return DamagedState("its numbers contradict each other");
  }

  next_id_ = next_id;
  told_ = told;
  population_ = std::move(population);
  waiting_.assign(std::make_move_iterator(waiting.begin()), std::make_move_iterator(waiting.end()));
  asked_ = 0;
  children_born_ = children_born;
  clones_born_ = clones_born;
  genomes_seen_ = std::move(genomes_seen);
  newborns_.clear();
  if (told_ == 0) newborns_.assign(waiting_.begin(), waiting_.end());
  Release();  // when it was saved at the end of a shorter search
  return Ok{};
}

}  // namespace gauntlet::master
