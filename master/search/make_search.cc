#include "master/search/make_search.h"

#include <fmt/format.h>

#include <utility>

#include "controllers/registry.h"
#include "master/search/genetic_algorithm.h"
#include "master/search/random_search.h"
#include "master/search/search_setup.h"
#include "master/search/steady_state_search.h"
#include "sim/robot/disturbances.h"

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

Status CheckSwarmFits(const Experiment& experiment, const sim::TestCase& test_case) {
  const Result<std::size_t> robots = controllers::CountSwarm(SpecOf(experiment, test_case, experiment.seed));
  if (!robots.ok()) return robots.error();
  if (const auto refused = sim::RefuseDisturbances(experiment.disturbances, *robots)) {
    return InvalidInput(*refused);
  }
  return Ok{};
}

Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment, std::uint32_t search_id) {
  const Result<sim::ArenaRequirements> requirements = RequirementsOf(experiment);
  if (!requirements.ok()) return requirements.error();
  auto search = MakeSearch(experiment, *requirements, search_id);
  if (!search.ok()) return search;
  // Without this every run of the search would be refused for the same reason.
  if (const Status fits = CheckSwarmFits(experiment, EmptyArena(experiment.arena)); !fits.ok()) {
    return InvalidInput("no run can begin, even without obstacles: " + fits.error().message);
  }
  return search;
}

Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment,
                                                    const sim::ArenaRequirements& requirements,
                                                    std::uint32_t search_id) {
  const SearchSetup setup{experiment, requirements, search_id};
  switch (experiment.search.kind) {
    case SearchKind::kGenetic:
      if (experiment.search.mode == SearchMode::kSteadyState) return Make<SteadyStateSearch>(setup);
      return Make<GeneticAlgorithm>(setup);
    case SearchKind::kRandom:
      return Make<RandomSearch>(setup);
    case SearchKind::kCases:
      break;
  }
  return InvalidInput("search.algorithm = \"cases\" needs a list of test cases: use `gauntlet evaluate`");
}

}  // namespace gauntlet::master
