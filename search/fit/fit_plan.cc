#include "search/fit/fit_plan.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/number_text.h"
#include "base/split.h"
#include "controllers/registry.h"

namespace gauntlet {
namespace {

// Settings for each direction in which they vary, and one more: at least, and if the runs are enough for it.
constexpr std::size_t kLeastSettings = 10;
constexpr std::size_t kManySettings = 30;
constexpr int kLeastRuns = 20;  // of a setting on each kind of cases, for a spread to mean anything

std::size_t DirectionsOf(std::span<const VariedKey> varied) {
  std::size_t directions = 0;
  for (const VariedKey& key : varied) directions += key.values.size() > 2 ? key.values.size() : 1;
  return directions;
}

// Runs of a setting that do not depend on the budget; 0 = they do.
int FixedRuns(const FitCases& cases) {
  if (cases.given() == 0) return cases.count;
  const int given = static_cast<int>(cases.given());
  return given * ((kLeastRuns + given - 1) / given);
}

int JudgedRuns(const FitPlan& plan, const FitCases& cases, int judged) {
  int least = 0;
  bool others = false;
  for (const FitTarget& target : plan.targets) {
    if (!(target.cases == cases)) continue;
    if (target.demand == FitTarget::Demand::kEvery) {
      least = std::max(least, static_cast<int>(target.n));
    } else {
      others = true;
    }
  }
  const int runs = others ? std::max(least, judged) : least;
  const int given = static_cast<int>(cases.given());
  return given == 0 ? runs : given * ((runs + given - 1) / given);
}

}  // namespace

std::size_t FitPlan::CasesOf(const FitTarget& target) const {
  return static_cast<std::size_t>(std::ranges::find(cases, target.cases) - cases.begin());
}

std::size_t FitPlan::SettingsOfRound(std::size_t round) const {
  const std::size_t later = 2 * settings / (3 * (kRounds - 1));
  return round == 0 ? settings - later * (kRounds - 1) : later;
}

int FitPlan::RunsEach() const {
  int sum = 0;
  for (const int one : runs) sum += one;
  return sum;
}

int FitPlan::RunsJudged() const {
  int sum = 0;
  for (const int one : judged) sum += one;
  return sum;
}

Result<FitPlan> MakeFitPlan(const Experiment& experiment, std::span<const Key> keys) {
  const FitSpec& spec = experiment.fit;
  const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment);
  if (scenario == nullptr)
    return Error{ErrorKind::kNotFound, fmt::format("there is no scenario '{}'", experiment.scenario)};
  if (experiment.search.replicates != 1)
    return InvalidInput(fmt::format("search.replicates = {}: a fit simulates every evaluation once",
                                    experiment.search.replicates));
  if (spec.targets.empty()) return InvalidInput("there is no target to fit to");
  FitPlan plan;
  TRY(plan.varied, ParseVariedKeys(WordsOf(spec.vary), keys, experiment));
  TRY(plan.targets, ParseFitTargets(spec.targets, *scenario));
  int fixed = 0;
  int free = 0;
  for (const FitTarget& target : plan.targets) {
    if (std::ranges::find(plan.cases, target.cases) != plan.cases.end()) continue;
    plan.cases.push_back(target.cases);
    plan.runs.push_back(FixedRuns(target.cases));
    plan.judged.push_back(JudgedRuns(plan, target.cases, spec.judged));
    fixed += plan.runs.back();
    if (plan.runs.back() == 0) ++free;
  }
  const std::size_t directions = DirectionsOf(plan.varied) + 1;
  const auto least_each = static_cast<std::size_t>(fixed + free * kLeastRuns);
  const auto budget = static_cast<std::size_t>(spec.runs);
  plan.settings = std::min(budget / least_each, kManySettings * directions);
  if (plan.settings < kLeastSettings * directions) {
    return InvalidInput(fmt::format(
        "{} runs are too few for a posterior over {}: at least {} settings with {} runs each are needed, {} "
        "runs in all",
        FormatCount(budget), Counted(plan.varied.size(), "key"), kLeastSettings * directions, least_each,
        FormatCount(kLeastSettings * directions * least_each)));
  }
  const int each = static_cast<int>(budget / plan.settings);
  for (int& runs : plan.runs) {
    if (runs == 0) runs = (each - fixed) / free;
  }
  return plan;
}

}  // namespace gauntlet
