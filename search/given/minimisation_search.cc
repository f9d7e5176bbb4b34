#include "search/given/minimisation_search.h"

#include <array>
#include <utility>

namespace gauntlet {
namespace {

const std::vector<controllers::ParameterInfo> kMinimisationParameters = {
    {"shorten", "bool", 0, 0, 1, true, "make obstacles shorter too, and round their lengths"}};

}  // namespace

Experiment MinimisationOf(const Experiment& experiment, bool shorten) {
  Experiment minimisation = LayoutExperiment(experiment, "minimisation");
  minimisation.search.parameters[std::string(kMinimisationParameters[0].name)] = shorten ? 1.0 : 0.0;
  return minimisation;
}

Result<std::unique_ptr<MinimisationSearch>> MinimisationSearch::Create(const SearchSetup& setup) {
  const controllers::FailurePlace* place = FailurePlaceOf(setup.experiment);
  const MinimisingRules rules{
      .same_within = place == nullptr ? 0.0 : place->same_within,
      .shorten = ValueOf(kMinimisationParameters[0], setup.experiment.search.parameters) != 0.0};
  std::vector<std::unique_ptr<LayoutQuestion>> minimisers;
  for (const sim::TestCase& one : setup.cases)
    minimisers.push_back(std::make_unique<CaseMinimiser>(one.obstacles, rules));
  return std::unique_ptr<MinimisationSearch>(new MinimisationSearch(setup, std::move(minimisers)));
}

SearchRow MinimisationRow() {
  return {.info = {.name = "minimisation",
                   .description = "the smallest part of given cases that still fails: gauntlet minimise",
                   .parameters = kMinimisationParameters},
          .number = 5,
          .title = "minimisation of cases",
          .plan = [](const Experiment&) { return std::string("about 100 runs each"); },
          .make = Make<MinimisationSearch>,
          .purpose = sim::SeedPurpose::kMinimise,
          .given_cases = true,
          .command = "minimise",
          .seeds_of_cases = true};
}

}  // namespace gauntlet
