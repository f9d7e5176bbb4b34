#include "master/search/make_search.h"

#include <fmt/format.h>

#include <utility>

#include "controllers/registry.h"
#include "master/search/genetic_algorithm.h"
#include "master/search/random_search.h"
#include "master/search/search_setup.h"

namespace gauntlet::master {
namespace {

template <typename Search>
Result<std::unique_ptr<SearchAlgorithm>> Make(const SearchSetup& setup) {
  Result<std::unique_ptr<Search>> search = Search::Create(setup);
  if (!search.ok()) return search.error();
  return std::unique_ptr<SearchAlgorithm>(std::move(*search));
}

}  // namespace

Result<sim::ArenaRequirements> RequirementsOf(const Experiment& experiment) {
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment.scenario);
  if (scenario == nullptr) {
    return Error{ErrorKind::kNotFound, fmt::format("there is no scenario '{}'", experiment.scenario)};
  }
  return scenario->requirements(experiment.scenario_parameters, EmptyArena(experiment.arena));
}

Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment, std::uint32_t search_id) {
  const Result<sim::ArenaRequirements> requirements = RequirementsOf(experiment);
  if (!requirements.ok()) return requirements.error();
  return MakeSearch(experiment, *requirements, search_id);
}

Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment,
                                                    const sim::ArenaRequirements& requirements,
                                                    std::uint32_t search_id) {
  const SearchSetup setup{experiment, requirements, search_id};
  switch (experiment.search.kind) {
    case SearchKind::kGenetic:
      return Make<GeneticAlgorithm>(setup);
    case SearchKind::kRandom:
      return Make<RandomSearch>(setup);
    case SearchKind::kCases:
      break;
  }
  return InvalidInput("search.algorithm = \"cases\" needs a list of test cases: use `gauntlet evaluate`");
}

}  // namespace gauntlet::master
