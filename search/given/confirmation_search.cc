#include "search/given/confirmation_search.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace gauntlet {
namespace {

const std::vector<controllers::ParameterInfo> kConfirmationParameters = {
    {"confirmations", "", 0, 0, 100000, true, "runs of each case; 0 = until there is a verdict"}};

std::string Plan(const Experiment& experiment) {
  const int replicates = ConfirmationReplicates(experiment);
  return replicates > 0 ? fmt::format("{} runs each", replicates) : "5 to 10 runs each";
}

}  // namespace

int ConfirmationReplicates(const Experiment& experiment) {
  return static_cast<int>(ValueOf(kConfirmationParameters[0], experiment.search.parameters));
}

Experiment ConfirmationOf(const Experiment& experiment, int replicates) {
  Experiment confirmation = experiment;
  confirmation.search = SearchSpec{};
  confirmation.search.cells = experiment.search.cells;
  confirmation.search.algorithm = "confirmation";
  confirmation.search.parameters[std::string(kConfirmationParameters[0].name)] = replicates;
  return confirmation;
}

Experiment CheckOf(const Experiment& experiment) {
  Experiment check = ConfirmationOf(experiment, 0);
  check.search.algorithm = "check";
  check.search.parameters.clear();
  check.search.cells.clear();
  return check;
}

ConfirmationSearch::ConfirmationSearch(const SearchSetup& setup)
    : PopulationSearch(setup),
      failing_(FailingOf(setup.experiment)),
      replicates_(ConfirmationReplicates(setup.experiment)),
      cases_(setup.cases.size()) {
  for (const sim::TestCase& test_case : setup.cases) {
    population_.push_back(MakeIndividual(population_.size() + 1, test_case));
  }
  newborns_ = population_;
}

Result<std::unique_ptr<ConfirmationSearch>> ConfirmationSearch::Create(const SearchSetup& setup) {
  return std::unique_ptr<ConfirmationSearch>(new ConfirmationSearch(setup));
}

std::vector<EvaluationRequest> ConfirmationSearch::Ask() {
  if (evaluations_done_ == 0 && AtBoundary()) {
    for (std::size_t index = 0; index < cases_.size(); ++index) AskMore(index);
  }
  return std::exchange(requests_, {});
}

void ConfirmationSearch::AskMore(std::size_t index) {
  Case& one = cases_[index];
  if (one.waiting > 0) return;
  const int runs = RunsToVerdict(one.tally, replicates_);
  for (; one.waiting < runs; ++one.waiting) {
    requests_.push_back(Request(population_[index], 1, static_cast<std::uint32_t>(one.waiting)));
  }
}

void ConfirmationSearch::Count(const EvaluationOutcome& outcome) {
  const std::size_t index = outcome.individual - 1;
  Record(outcome, population_[index]);
  for (const RunOutcome& run : outcome.runs) cases_[index].tally.Add(run, failing_);
}

void ConfirmationSearch::Told(const EvaluationOutcome& outcome) {
  Count(outcome);
  const std::size_t index = outcome.individual - 1;
  --cases_[index].waiting;
  AskMore(index);
}

SearchProgress ConfirmationSearch::Progress() const {
  std::uint64_t missing = 0;
  for (const Case& one : cases_) {
    missing += static_cast<std::uint64_t>(std::max(one.waiting, RunsToVerdict(one.tally, replicates_)));
  }
  return {.generation = evaluations_done_ > 0 || !AtBoundary() ? 1U : 0U,
          .generations = 1,
          .evaluations_done = evaluations_done_,
          .evaluations_planned = evaluations_done_ + missing,
          .individuals_planned = cases_.size(),
          .finished = missing == 0};
}

Status ConfirmationSearch::RestoreRest(CanonicalDecoder& /*decoder*/, const History& history) {
  // Runs are asked for as long as a case is open, so a state is saved at the end only.
  Status recalled = Recall(history, [this](const EvaluationOutcome& outcome) { Count(outcome); });
  if (recalled && !Progress().finished) return Damaged("a case has no verdict");
  return recalled;
}

SearchRow ConfirmationRow() {
  return {.info = {.name = "confirmation",
                   .description = "how often given cases fail with fresh seeds: gauntlet confirm",
                   .keys = {"search.cells"},
                   .parameters = kConfirmationParameters},
          .number = 4,
          .title = "confirmation of cases",
          .plan = Plan,
          .make = Make<ConfirmationSearch>,
          .purpose = sim::SeedPurpose::kConfirm,
          .given_cases = true,
          .command = "confirm",
          .seeds_of_cases = true};
}

SearchRow CheckRow() {
  SearchRow row = ConfirmationRow();
  row.info.name = "check";
  row.info.keys = {};
  row.info.parameters = {};
  row.info.description = "whether the cases of a corpus still fail: gauntlet check";
  row.number = 7;
  row.title = "check of a corpus";
  row.purpose = sim::SeedPurpose::kCheck;
  row.command = "check";
  return row;
}

}  // namespace gauntlet
