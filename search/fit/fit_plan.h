// How the runs of a fit are spent: on how many settings, in which rounds, on which cases.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "search/experiment/experiment.h"
#include "search/experiment/schema.h"
#include "search/experiment/varied_keys.h"
#include "search/fit/fit_targets.h"

namespace gauntlet {

struct FitPlan {
  static constexpr std::size_t kRounds = 4;  // the first covers the ranges, the others what is likely by then

  std::vector<VariedKey> varied;
  std::vector<FitTarget> targets;
  std::vector<FitCases> cases;  // different ones among the targets', in their order
  std::vector<int> runs;        // of a setting, for each of `cases`
  std::vector<int> judged;      // the same of the chosen setting, which is judged at the end
  std::size_t settings = 0;     // over all rounds, without those that are judged

  // Number of the target's cases.
  std::size_t CasesOf(const FitTarget& target) const;
  std::size_t SettingsOfRound(std::size_t round) const;  // rounds 0 to kRounds - 1
  int RunsEach() const;
  int RunsJudged() const;
};

// Of experiment.fit. `keys`: all of the experiment, those of its scenario and controller among them. Error:
// there is no such scenario; that of ParseVariedKeys or ParseFitTargets; fewer runs than a posterior needs,
// and how many it needs.
Result<FitPlan> MakeFitPlan(const Experiment& experiment, std::span<const Key> keys);

}  // namespace gauntlet
