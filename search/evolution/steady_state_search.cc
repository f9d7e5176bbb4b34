#include "search/evolution/steady_state_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/check.h"
#include "base/number_text.h"
#include "search/evolution/selection.h"

namespace gauntlet {
namespace {

const std::vector<controllers::ParameterInfo> kSteadyStateParameters = {
    {"lag", "", 0, 0, 9999, true,
     "steady-state only: a child knows all results but the last so many; workers it can keep busy; 0 = "
     "population "
     "- 1"}};

// search.lag. 0 stands for the largest possible, which is no more than a generation waits on average.
int LagOf(const SearchSpec& spec) {
  const auto lag = static_cast<int>(ValueOf(kSteadyStateParameters[0], spec.parameters));
  return lag > 0 ? lag : spec.population - 1;
}

std::optional<BrokenRule> CheckSteadyState(const Experiment& experiment) {
  if (std::optional<BrokenRule> broken = CheckBreeding(experiment)) return broken;
  const SearchSpec& spec = experiment.search;
  if (LagOf(spec) >= spec.population) {
    return BrokenRule{"search.lag", fmt::format("search.lag = {} must be below search.population = {}: the "
                                                "first child needs two parents",
                                                LagOf(spec), spec.population)};
  }
  if (spec.reevaluation != Reevaluation::kPopulation) return std::nullopt;
  return BrokenRule{"search.reevaluation",
                    "search.reevaluation = \"population\" needs generations: with search.algorithm = "
                    "\"steady-state\" everybody is evaluated once (use search.replicates)"};
}

}  // namespace

Result<std::unique_ptr<SteadyStateSearch>> SteadyStateSearch::Create(const SearchSetup& setup) {
  const std::optional<BrokenRule> broken = CheckSteadyState(setup.experiment);
  GAUNTLET_CHECK(!broken, broken->message);
  std::unique_ptr<SteadyStateSearch> search(new SteadyStateSearch(setup));
  TRY(search->initial_, search->InitialPopulation());
  search->Release();
  return search;
}

std::uint64_t SteadyStateSearch::Lag() const {
  return static_cast<std::uint64_t>(LagOf(spec()));
}

std::uint64_t SteadyStateSearch::Planned() const {
  return PopulationSize() * static_cast<std::uint64_t>(spec().generations);
}

std::uint32_t SteadyStateSearch::GenerationOf(IndividualId id) const {
  return static_cast<std::uint32_t>((id - 1) / PopulationSize()) + 1;
}

void SteadyStateSearch::Release() {
  while (next_id_ <= evaluations_done_ + Lag()) {
    if (next_id_ <= PopulationSize()) {
      waiting_.push_back(initial_[next_id_ - 1]);
      ++next_id_;
      continue;
    }
    const auto number = static_cast<std::uint32_t>(next_id_);
    const auto [first, second] = ChooseParents(number);
    Offspring offspring = BreedPair(first, second, number, 0);
    waiting_.push_back(GiveBirth(std::move(offspring.first), population_[first], population_[second],
                                 GenerationOf(next_id_)));
  }
}

std::vector<EvaluationRequest> SteadyStateSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  for (; asked_ < waiting_.size() && waiting_[asked_].id <= Planned(); ++asked_) {
    newborns_.push_back(waiting_[asked_]);
    requests.push_back(Request(waiting_[asked_], waiting_[asked_].birth_generation));
  }
  return requests;
}

void SteadyStateSearch::Told(const EvaluationOutcome& outcome) {
  Record(outcome, waiting_.front());
  population_.push_back(std::move(waiting_.front()));
  waiting_.pop_front();
  --asked_;
  if (population_.size() > PopulationSize()) KeepFittest(population_, PopulationSize());
  Release();
}

SearchProgress SteadyStateSearch::Progress() const {
  return {.generation = GenerationOf(std::max<std::uint64_t>(evaluations_done_, 1)),
          .generations = static_cast<std::uint32_t>(spec().generations),
          .evaluations_done = evaluations_done_,
          .evaluations_planned = Planned(),
          .individuals_planned = Planned(),
          .finished = evaluations_done_ >= Planned()};
}

void SteadyStateSearch::SaveRest(CanonicalEncoder& encoder) const {
  SaveBirths(encoder);
  SaveIndividuals(population_, encoder);
  SaveIndividuals({waiting_.begin(), waiting_.end()}, encoder);
}

Status SteadyStateSearch::RestoreRest(CanonicalDecoder& decoder, const History& /*history*/) {
  RestoreBirths(decoder);
  if (next_id_ != evaluations_done_ + Lag() + 1) {
    return Damaged("its numbers contradict each other");
  }
  TRY(population_,
      RestoreIndividuals(std::min(evaluations_done_, PopulationSize()), evaluations_done_ + 1, decoder));
  TRY(auto waiting, RestoreIndividuals(next_id_ - evaluations_done_ - 1, next_id_, decoder));
  waiting_.assign(std::make_move_iterator(waiting.begin()), std::make_move_iterator(waiting.end()));
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (waiting_[i].id != evaluations_done_ + 1 + i) {
      return Damaged(fmt::format("individual {} waits", waiting_[i].id));
    }
  }
  return Ok{};
}

SearchRow SteadyStateRow() {
  return {.info = {.name = "steady-state",
                   .description = "the genetic search child after child, without waiting for a generation",
                   .keys = BreedingKeys(),
                   .parameters = kSteadyStateParameters,
                   .length = "search.generations",
                   .check = CheckSteadyState},
          .number = 0,  // the first population is that of the genetic search
          .title = "steady-state genetic search",
          .individuals = Individuals::kPopulation,
          .plan =
              [](const Experiment& e) {
                const auto cases = static_cast<std::uint64_t>(e.search.population) *
                                   static_cast<std::uint64_t>(e.search.generations);
                return fmt::format("{} test cases, lag {}", FormatCount(cases), LagOf(e.search));
              },
          .make = Make<SteadyStateSearch>};
}

}  // namespace gauntlet
