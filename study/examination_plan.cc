#include "study/examination_plan.h"

#include <algorithm>

#include <fmt/format.h>

#include "controllers/run_start.h"
#include "search/failure_tally.h"
#include "search/margin/margin_stages.h"
#include "search/search_setup.h"

namespace gauntlet {
namespace {

// Half of what may be asked for is lost, or half of full scale is added: few swarms withstand that.
constexpr const char* kDropped = "noise.{}.drop=0..0.5";
constexpr const char* kAdded = "noise.{}.gaussian=0..0.5";

// Disturbances that reach the robots under test, those of whole robots first. Of a program of the user's, and
// of controllers whose devices only their process knows: no noise.
std::vector<std::string> DisturbancesOf(const Experiment& experiment) {
  if (StartsProgram(experiment)) return {};
  const auto start = controllers::StartOf(SpecOf(experiment, EmptyArena(experiment.arena), experiment.seed));
  if (!start) return {};
  std::vector<std::string> vary;
  const auto robots = std::ranges::count(start->robots, true, &sim::StartingRobot::under_test);
  if (robots >= 2) vary.push_back(fmt::format("random_faults.count=0..{}", robots / 2));
  for (const sim::DeviceInfo& device : sim::kDevices) {
    const auto has = [&](const sim::StartingRobot& robot) {
      return robot.under_test && robot.devices.Has(device.device);
    };
    if (device.most_noise > 0.0 && std::ranges::any_of(start->robots, has))
      vary.push_back(fmt::format(fmt::runtime(device.drops ? kDropped : kAdded), device.key));
  }
  return vary;
}

}  // namespace

Result<ExaminationPlan> PlanExamination(const Experiment& experiment, std::uint64_t runs) {
  ExaminationPlan plan;
  plan.runs = runs;
  if (runs == 0)
    plan.runs =
        StartsProgram(experiment) ? ExaminationPlan::kDefaultProgramRuns : ExaminationPlan::kDefaultRuns;
  if (plan.runs < ExaminationPlan::kLeastRuns)
    return InvalidInput(fmt::format("{} runs are too few for an examination: at least {} are needed",
                                    plan.runs, ExaminationPlan::kLeastRuns));
  plan.random_cases = std::min<std::uint64_t>(200, plan.runs / 10);
  plan.vary = DisturbancesOf(experiment);
  const std::uint64_t for_margins = 3 * plan.runs / 10;
  const std::size_t most = for_margins / MarginPlan::kLeastRuns;
  if (plan.vary.size() > most) {
    plan.unvaried.assign(plan.vary.begin() + static_cast<std::ptrdiff_t>(most), plan.vary.end());
    plan.vary.resize(most);
  }
  if (!plan.vary.empty()) plan.margin_runs = std::min<std::uint64_t>(600, for_margins / plan.vary.size());
  plan.search_runs = plan.runs - plan.random_cases - plan.runs / 5 - plan.margin_runs * plan.vary.size();
  return plan;
}

}  // namespace gauntlet
