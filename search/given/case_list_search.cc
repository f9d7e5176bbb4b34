#include "search/given/case_list_search.h"

#include <fmt/format.h>

namespace gauntlet {

CaseListSearch::CaseListSearch(const SearchSetup& setup) : PopulationSearch(setup) {
  for (const sim::TestCase& test_case : setup.cases) {
    population_.push_back(MakeIndividual(population_.size() + 1, test_case));
  }
}

Result<std::unique_ptr<CaseListSearch>> CaseListSearch::Create(const SearchSetup& setup) {
  return std::unique_ptr<CaseListSearch>(new CaseListSearch(setup));
}

std::vector<EvaluationRequest> CaseListSearch::Ask() {
  std::vector<EvaluationRequest> requests;
  if (std::exchange(asked_, true)) return requests;
  newborns_ = population_;
  for (const Individual& one : population_) requests.push_back(Request(one, 1));
  return requests;
}

void CaseListSearch::Told(const EvaluationOutcome& outcome) {
  Record(outcome, population_[outcome.individual - 1]);
}

SearchProgress CaseListSearch::Progress() const {
  return {.generation = asked_ ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = population_.size(),
          .individuals_planned = population_.size(),
          .finished = evaluations_done_ >= population_.size()};
}

Status CaseListSearch::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
  asked_ = evaluations_done_ > 0;  // states are saved before all or after all
  return Recall(history, [this](const EvaluationOutcome& outcome) { Told(outcome); });
}

SearchRow CaseListRow() {
  return {.info = {.name = "cases",
                   .description = "given test cases from files: gauntlet evaluate",
                   .keys = {"search.replicates"}},
          .number = 2,
          .title = "given cases",
          .plan = [](const Experiment& e) { return fmt::format("{} runs each", e.search.replicates); },
          .make = Make<CaseListSearch>,
          .purpose = sim::SeedPurpose::kEvaluate,
          .given_cases = true,
          .command = "evaluate",
          .seeds_of_cases = true};
}

SearchRow ResimulationRow() {
  return {.info = {.name = "resimulation",
                   .description = "members of an evolution's population once more: gauntlet evaluate --from",
                   .keys = {"search.replicates"}},
          .number = 3,
          .title = "a population simulated again",
          .individuals = Individuals::kPopulation,
          .plan = [](const Experiment& e) { return fmt::format("{} runs each", e.search.replicates); },
          .make = Make<CaseListSearch>,
          .purpose = sim::SeedPurpose::kFinalResimulation,
          .given_cases = true,
          .command = "evaluate"};
}

}  // namespace gauntlet
