#include "search/evolution/random_search.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/number_text.h"

namespace gauntlet {
namespace {

// Cases drawn before the search starts, to find ranges that leave no room.
constexpr std::uint64_t kTrialCases = 20;

const std::vector<controllers::ParameterInfo> kRandomParameters = {
    {"cases", "", 1000, 1, 1e8, true, "test cases of random search"}};

std::uint64_t PlannedCases(const Experiment& experiment) {
  return static_cast<std::uint64_t>(ValueOf(kRandomParameters[0], experiment.search.parameters));
}

}  // namespace

Result<std::unique_ptr<RandomSearch>> RandomSearch::Create(SearchSetup setup) {
  std::unique_ptr<RandomSearch> search(new RandomSearch(std::move(setup)));
  for (IndividualId id = 1; id <= std::min(kTrialCases, search->Planned()); ++id) {
    TRY(search->DrawCase(id));
  }
  return search;
}

std::uint64_t RandomSearch::Planned() const {
  return PlannedCases(setup_.experiment);
}

Individual RandomSearch::Draw(IndividualId id) const {
  if (id <= setup_.cases.size()) return MakeIndividual(id, setup_.cases[id - 1]);
  sim::RandomStream random = GenomeStream(search_seed_, id);
  while (true) {
    Result<sim::TestCase> test_case = generator_.RandomTestCase(random);
    if (test_case.ok()) return MakeIndividual(id, std::move(*test_case));
  }
}

std::vector<EvaluationRequest> RandomSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  if (waiting_.size() >= kLookahead) return requests;
  const std::uint64_t asked = evaluations_done_ + waiting_.size();
  for (IndividualId id = asked + 1; id <= std::min(Planned(), asked + kChunk); ++id) {
    newborns_.push_back(waiting_.emplace_back(Draw(id)));
    requests.push_back(Request(waiting_.back(), 1));
  }
  return requests;
}

void RandomSearch::Told(const EvaluationOutcome& outcome) {
  Record(outcome, waiting_.front());
  population_.push_back(std::move(waiting_.front()));
  waiting_.pop_front();
}

SearchProgress RandomSearch::Progress() const {
  return {.generation = evaluations_done_ + waiting_.size() > 0 ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = Planned(),
          .individuals_planned = Planned(),
          .finished = evaluations_done_ >= Planned()};
}

bool RandomSearch::AtBoundary() const {
  return evaluations_done_ % kSaveInterval == 0 || evaluations_done_ == Planned();
}

Status RandomSearch::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
  population_.reserve(setup_.cases.size());
  return Recall(history, [this](const EvaluationOutcome& outcome) {
    const std::size_t place = population_.size();  // whose case nobody asks for again
    population_.push_back(place < setup_.cases.size()
                              ? MakeIndividual(place + 1, std::move(setup_.cases[place]))
                              : Draw(place + 1));
    Record(outcome, population_.back());
  });
}

SearchRow RandomRow() {
  return {.info = {.name = "random",
                   .description = "independent random test cases, the baseline: gauntlet random",
                   .keys = {"search.replicates", "search.objective", "genome."},
                   .parameters = kRandomParameters,
                   .length = "search.cases",
                   .check = CheckObjective},
          .number = 1,
          .title = "random search",
          .plan = [](const Experiment& e) { return FormatCount(PlannedCases(e)) + " test cases"; },
          .make = Make<RandomSearch>,
          .command = "random",
          .length_option = "--cases"};
}

}  // namespace gauntlet
