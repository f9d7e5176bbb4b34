#include "study/examination_plan.h"

#include <algorithm>

#include <fmt/format.h>

#include "controllers/run_start.h"
#include "search/experiment/failure_cells.h"
#include "search/failure_tally.h"
#include "search/margin/margin_stages.h"
#include "search/search_setup.h"

namespace gauntlet {
namespace {

// What `minimise` and `blame` seldom take more than, of a case of an archive, which has few obstacles, and of
// another.
constexpr std::uint64_t kRunsToShrink = 350;
constexpr std::uint64_t kRunsToShrinkMany = 1400;
constexpr std::uint64_t kLeastSearch = 350;  // and random cases: fewer find next to nothing
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

// That the search can end with.
std::uint64_t MostCasesOf(const Experiment& experiment) {
  const auto axes = CellsOf(experiment);
  if (axes.empty()) return static_cast<std::uint64_t>(experiment.search.population);
  std::uint64_t cells = 1;
  for (const controllers::DescriptorAxis& axis : axes) cells *= static_cast<std::uint64_t>(axis.parts);
  return cells;
}

}  // namespace

Result<ExaminationPlan> PlanExamination(const Experiment& experiment, std::uint64_t runs) {
  ExaminationPlan plan;
  plan.runs = runs;
  if (runs == 0)
    plan.runs =
        StartsProgram(experiment) ? ExaminationPlan::kDefaultProgramRuns : ExaminationPlan::kDefaultRuns;
  const bool in_cells = !CellsOf(experiment).empty();
  const std::uint64_t for_cases = MostCasesOf(experiment) * static_cast<std::uint64_t>(plan.replicates);
  const std::uint64_t to_shrink = in_cells ? kRunsToShrink : kRunsToShrinkMany;
  for (plan.minimised = 3; plan.minimised > 1 && 2 * (for_cases + plan.minimised * to_shrink) > plan.runs;)
    --plan.minimised;
  const std::uint64_t for_questions = for_cases + plan.minimised * to_shrink;
  if (plan.runs < for_questions + kLeastSearch)
    return InvalidInput(fmt::format("{} runs are too few for an examination: at least {} are needed",
                                    plan.runs, for_questions + kLeastSearch));
  const std::uint64_t rest = plan.runs - for_questions;
  plan.random_cases = std::min<std::uint64_t>(200, rest / 10);
  plan.vary = DisturbancesOf(experiment);
  const std::uint64_t for_margins = 4 * rest / 10;
  const std::size_t most = for_margins / MarginPlan::kLeastRuns;
  if (plan.vary.size() > most) {
    plan.unvaried.assign(plan.vary.begin() + static_cast<std::ptrdiff_t>(most), plan.vary.end());
    plan.vary.resize(most);
  }
  if (!plan.vary.empty()) plan.margin_runs = std::min<std::uint64_t>(600, for_margins / plan.vary.size());
  plan.search_runs = rest - plan.random_cases - plan.margin_runs * plan.vary.size();
  plan.search_length = fmt::format("search.runs={}", plan.search_runs);
  if (!in_cells) {
    plan.algorithm = "genetic";
    const auto each = static_cast<std::uint64_t>(experiment.search.population) *
                      static_cast<std::uint64_t>(experiment.search.replicates);
    plan.search_length =
        fmt::format("search.generations={}", std::max<std::uint64_t>(2, plan.search_runs / each));
  }
  return plan;
}

}  // namespace gauntlet
