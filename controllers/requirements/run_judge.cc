#include "controllers/requirements/run_judge.h"

namespace gauntlet::controllers::requirements {

Result<RunJudge> RunJudge::Make(const sim::RunSpec& spec, const ScenarioInfo& scenario,
                                const sim::ArenaRequirements& arena) {
  TRY(Requirements requirements, Requirements::Parse(spec.requirements, scenario.metrics));
  for (const auto& [place, name] : {std::pair{Place::kGoal, "goal"}, {Place::kStart, "start"}}) {
    if (requirements.AsksFor(place) && !arena.asks_for_path)
      return InvalidInput("requirements: the scenario '" + scenario.name + "' has no " + name +
                          "; give distance_to(X, Y) the place");
  }
  return RunJudge(std::move(requirements), arena, ToTicks(scenario.TimeLimit(spec.scenario_parameters)));
}

}  // namespace gauntlet::controllers::requirements
