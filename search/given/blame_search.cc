#include "search/given/blame_search.h"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace gauntlet {
namespace {

const std::vector<controllers::ParameterInfo> kBlameParameters = {
    {"part_runs", "", 30, 2, 10000, true, "runs of the case, and of it without each obstacle"}};

int PartRuns(const Experiment& experiment) {
  return static_cast<int>(ValueOf(kBlameParameters[0], experiment.search.parameters));
}

}  // namespace

Experiment BlameExperiment(const Experiment& experiment, int replicates) {
  Experiment blame = LayoutExperiment(experiment, "blame");
  blame.search.parameters[std::string(kBlameParameters[0].name)] = replicates;
  return blame;
}

Result<std::unique_ptr<BlameSearch>> BlameSearch::Create(const SearchSetup& setup) {
  std::vector<std::unique_ptr<LayoutQuestion>> questions;
  for (const sim::TestCase& one : setup.cases)
    questions.push_back(std::make_unique<CaseBlame>(one.obstacles, PartRuns(setup.experiment)));
  return std::unique_ptr<BlameSearch>(new BlameSearch(setup, std::move(questions)));
}

SearchRow BlameRow() {
  return {.info = {.name = "blame",
                   .description = "what each obstacle of given cases contributes to failures: gauntlet blame",
                   .parameters = kBlameParameters},
          .number = 6,
          .title = "blame of obstacles",
          .plan = [](const Experiment& e) { return fmt::format("{} runs of each part", PartRuns(e)); },
          .make = Make<BlameSearch>,
          .purpose = sim::SeedPurpose::kBlame,
          .given_cases = true,
          .command = "blame",
          .seeds_of_cases = true};
}

}  // namespace gauntlet
