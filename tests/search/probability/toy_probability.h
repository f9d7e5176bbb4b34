// A swarm whose failure probability is known: four conditions that are drawn evenly, and a robustness that
// falls with the sum of their normal deviates.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "search/experiment/experiment_file.h"
#include "search/probability/probability_search.h"
#include "search/search_table.h"

namespace gauntlet {

inline SearchSetup SetupOfToyProbability(std::uint64_t seed, int runs,
                                         const std::vector<std::string>& more = {}) {
  std::vector<std::string> sets = {"scenario=flocking",
                                   "search.algorithm=probability",
                                   "genome.genes=0",
                                   "requirements.near=always distance_to(center) < 3",
                                   "conditions.noise.proximity.gaussian=0..0.2",
                                   "conditions.noise.proximity.uniform=0..0.2",
                                   "conditions.noise.wheels.gaussian=0..0.2",
                                   "conditions.noise.wheels.uniform=0..0.2",
                                   "seed=" + std::to_string(seed),
                                   "probability.runs=" + std::to_string(runs)};
  sets.insert(sets.end(), more.begin(), more.end());
  const Experiment experiment = ParseExperiment("", "toy.toml", sets, BuiltInCatalogue()).value();
  return SetupOf(experiment, {}, {EmptyArena(experiment.arena)});
}

// It fails with the probability that a standard normal value lies above `threshold`; `chance`: the share of
// the robustness that its seed decides, from 0 to 1.
struct ToySwarm {
  double threshold = 0.0;
  double chance = 0.0;

  RunOutcome Run(const Sample& sample, std::uint64_t seed) const {
    double sum = 0.0;
    for (const double score : sample.scores) sum += score;
    const double normal = sum / std::sqrt(static_cast<double>(sample.scores.size()));
    const double drawn = sim::RandomStream(seed, sim::StreamPurpose::kTest).Gaussian();
    const double robustness = threshold - std::sqrt(1.0 - chance) * normal - std::sqrt(chance) * drawn;
    RunOutcome run{.total_failure = robustness < 0.0};
    run.metrics = {{"robustness", robustness}};
    return run;
  }
};

inline std::unique_ptr<ProbabilityCourse> ToyCourse(const SearchSetup& setup) {
  Conditions conditions = Conditions::Make(setup, AllKeysOf(setup.experiment)).value();
  return std::make_unique<ProbabilityCourse>(setup, std::move(conditions), controllers::kTotalFailure);
}

// Stage by stage to its end.
inline void DriveToy(ProbabilityCourse& course, const ToySwarm& swarm, std::uint64_t seed) {
  while (!course.AtEnd()) {
    for (const SettingsRun& run : course.Next())
      course.Tell(run, swarm.Run(course.SampleOf(run.setting + 1), seed * 1'000'003 + run.setting));
  }
}

}  // namespace gauntlet
