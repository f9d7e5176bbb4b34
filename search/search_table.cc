#include "search/search_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "base/check.h"
#include "controllers/registry.h"
#include "controllers/run_start.h"
#include "search/archive/archive_search.h"
#include "search/archive/cma_me_search.h"
#include "search/evolution/genetic_algorithm.h"
#include "search/evolution/random_search.h"
#include "search/evolution/steady_state_search.h"
#include "search/fit/fit_search.h"
#include "search/given/case_blame.h"
#include "search/given/case_minimiser.h"
#include "search/given/case_stream.h"
#include "search/given/repeated_case.h"
#include "search/margin/margin_search.h"
#include "search/probability/probability_search.h"
#include "search/repair/repair_search.h"
#include "sim/robot/disturbances.h"

namespace gauntlet {

std::string_view NameOf(Individuals individuals) {
  constexpr std::array<std::string_view, 3> kNames = {"cases", "population", "elites"};
  return kNames[static_cast<std::size_t>(individuals)];
}

std::span<const SearchRow> Searches() {
  static const std::array rows = {
      GeneticRow(),  SteadyStateRow(),  RandomRow(),       ArchiveRow(),      RandomDeletionRow(), CmaMeRow(),
      CaseListRow(), ResimulationRow(), ConfirmationRow(), MinimisationRow(), BlameRow(),          CheckRow(),
      FitRow(),      MarginRow(),       RepairRow(),       ProbabilityRow(),  StreamRow()};
  return rows;
}

const SearchRow* FindSearch(std::string_view name) {
  const auto row = std::ranges::find(Searches(), name, [](const SearchRow& one) { return one.info.name; });
  return row == Searches().end() ? nullptr : &*row;
}

const SearchRow& RowOf(const Experiment& experiment) {
  const SearchRow* row = FindSearch(experiment.search.algorithm);
  GAUNTLET_CHECK(row != nullptr, experiment.search.algorithm);
  return *row;
}

const Catalogue& BuiltInCatalogue() {
  static const std::vector<SearchInfo> searches = [] {
    std::vector<SearchInfo> infos;
    for (const SearchRow& row : Searches()) infos.push_back(row.info);
    return infos;
  }();
  static const Catalogue catalogue{controllers::Scenarios(), controllers::Controllers(), searches};
  return catalogue;
}

const std::vector<Key>& BuiltInKeys() {
  static const std::vector<Key> keys = CommonKeys(BuiltInCatalogue());
  return keys;
}

std::vector<Key> AllKeysOf(const Experiment& experiment) {
  std::vector<Key> keys = BuiltInKeys();
  const auto add = [&](std::vector<Key> more) { std::ranges::move(more, std::back_inserter(keys)); };
  if (const auto* scenario = controllers::FindScenario(experiment)) add(ScenarioParameterKeys(*scenario));
  if (const auto* controller = controllers::FindController(experiment.controller, experiment.plugin))
    add(ControllerParameterKeys(*controller));
  return keys;
}

SearchSetup SetupOf(const Experiment& experiment, const sim::ArenaRequirements& requirements,
                    std::vector<sim::TestCase> cases) {
  return {experiment, requirements, std::move(cases), &RowOf(experiment), BuiltInKeys()};
}

std::uint64_t RunSeed(const Experiment& experiment, const EvaluationRequest& evaluation,
                      std::uint32_t replicate) {
  const SearchRow& row = RowOf(experiment);
  const std::uint64_t who = row.seeds_of_cases ? CaseHash(evaluation.test_case) : evaluation.individual;
  const std::uint64_t seed = evaluation.seed.value_or(experiment.seed);
  return sim::DeriveSeed(seed, row.purpose, kSearchNumber, who, evaluation.evaluation, replicate);
}

sim::RunSpec SpecOfRun(const Experiment& experiment, const EvaluationRequest& evaluation,
                       std::uint32_t replicate) {
  const sim::RunSettings& settings = evaluation.settings != nullptr ? *evaluation.settings : experiment;
  sim::RunSpec spec{settings, evaluation.test_case, RunSeed(experiment, evaluation, replicate)};
  spec.count_contacts = RowOf(experiment).counts_contacts;
  return spec;
}

Status CheckSwarmFits(const Experiment& experiment, const sim::TestCase& test_case) {
  TRY(const auto swarm, controllers::CountSwarm(SpecOf(experiment, test_case, experiment.seed)));
  if (const auto refused = sim::RefuseDisturbances(experiment.disturbances, swarm)) {
    return InvalidInput(*refused);
  }
  return Ok{};
}

Result<std::unique_ptr<SearchAlgorithm>> MakeSearch(const Experiment& experiment,
                                                    std::vector<sim::TestCase> cases) {
  const SearchRow& row = RowOf(experiment);
  if (row.streamed) return row.make(SetupOf(experiment, {}, std::move(cases)));
  if (row.given_cases()) {
    if (!cases.empty()) return row.make(SetupOf(experiment, {}, std::move(cases)));
    return InvalidInput(fmt::format("search.algorithm = \"{}\" needs a list of test cases: use `gauntlet {}`",
                                    row.info.name, row.command));
  }
  if (controllers::FindScenario(experiment) == nullptr)
    return Error{ErrorKind::kNotFound, fmt::format("there is no scenario '{}'", experiment.scenario)};
  const sim::TestCase empty = EmptyArena(experiment.arena);
  TRY(const auto requirements, controllers::RequirementsOf(SpecOf(experiment, empty, experiment.seed)));
  TRY(auto search, row.make(SetupOf(experiment, requirements, std::move(cases))));
  // Without this every run of the search would be refused for the same reason.
  if (const Status fits = CheckSwarmFits(experiment, empty); !fits.ok()) {
    return InvalidInput("no run can begin, even without obstacles: " + fits.error().message);
  }
  return search;
}

}  // namespace gauntlet
