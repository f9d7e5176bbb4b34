// Judges a run by what its spec requires.
#pragma once

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "controllers/requirements/requirements.h"
#include "sim/arena/validity.h"
#include "sim/run_spec.h"

namespace gauntlet::controllers::requirements {

class RunJudge {
 public:
  // `scenario`: the row without what requirements add; `arena`: what it asks of this run's. Error: what is
  // wrong with the spec's requirements, or that the scenario has no goal that they speak of.
  static Result<RunJudge> Make(const sim::RunSpec& spec, const ScenarioInfo& scenario,
                               const sim::ArenaRequirements& arena);

  // Whether positions count.
  bool Measures() const { return requirements_.Measures(); }

  // `outcome`: a sim::Outcome or RunResult of a run that was completed; gets the metrics of the requirements,
  // says whether the run failed by them, and is annotated with what was violated. `robots`: under test, one
  // at least.
  template <typename Outcome>
  void Judge(const sim::Observer& observer, const sim::Arena& arena, std::vector<sim::RobotIndex> robots,
             Outcome& outcome) const {
    const Judgement judgement = requirements_.Judge({.observer = observer,
                                                     .arena = arena,
                                                     .robots = std::move(robots),
                                                     .start = start_,
                                                     .goal = goal_,
                                                     .tick_limit = tick_limit_},
                                                    outcome.metrics);
    // A failure that the scenario knows nothing of is of none of its types.
    if (outcome.failure.total != judgement.failed) outcome.failure = {.total = judgement.failed};
    std::ranges::copy(judgement.metrics, std::back_inserter(outcome.metrics));
    std::ranges::copy(judgement.annotations, std::back_inserter(outcome.annotations));
  }

 private:
  RunJudge(Requirements requirements, const sim::ArenaRequirements& arena, sim::Tick tick_limit)
      : requirements_(std::move(requirements)),
        start_(arena.start),
        goal_(arena.goal),
        tick_limit_(tick_limit) {}

  Requirements requirements_;
  sim::Vec2 start_;
  sim::Vec2 goal_;
  sim::Tick tick_limit_ = 0;
};

}  // namespace gauntlet::controllers::requirements
