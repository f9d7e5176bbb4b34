#include "cli/given_cases.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/number_text.h"
#include "controllers/registry.h"
#include "controllers/run_start.h"
#include "master/campaign/verdict_text.h"
#include "master/directory/campaign_directory.h"
#include "search/cases/case_file.h"
#include "search/search_setup.h"
#include "search/search_table.h"
#include "sim/arena/validity.h"

namespace gauntlet {
namespace {

// Each different case once, under the name that came first.
void AskOnce(CommandContext& context, QuestionedCampaign& questioned) {
  std::map<std::pair<std::size_t, std::uint64_t>, std::string> names;
  std::erase_if(questioned.cases, [&](const CaseInQuestion& one) {
    const auto [first, is_new] = names.try_emplace({one.search, CaseHash(one.test_case)}, one.name);
    if (!is_new && first->second != one.name)
      PrintMessage(context, fmt::format("{} has the same case as {}", one.name, first->second));
    return !is_new;
  });
}

}  // namespace

std::optional<CaseRefusal> RefusalOf(const Experiment& experiment, const sim::TestCase& test_case) {
  if (controllers::FindScenario(experiment) == nullptr) return std::nullopt;
  const auto requirements = controllers::RequirementsOf(SpecOf(experiment, test_case, experiment.seed));
  if (!requirements) return CaseRefusal{"", requirements.error().message};
  if (const auto violation = sim::CheckValidity(test_case, *requirements))
    return CaseRefusal{std::string(sim::NameOf(violation->rule)), violation->message};
  if (const Status fits = CheckSwarmFits(experiment, test_case); !fits)
    return CaseRefusal{RuleOf(fits.error().message), fits.error().message};
  return std::nullopt;
}

Result<QuestionedCampaign> GivenCases(CommandContext& context, const std::string& directory,
                                      const std::vector<std::string>& cases) {
  if (const auto swapped = std::ranges::find_if(cases, CampaignDirectory::IsCampaign);
      swapped != cases.end() && !CampaignDirectory::IsCampaign(directory)) {
    return InvalidInput(fmt::format(
        "{} is a campaign and {} is none: the campaign comes first, then its runs", *swapped, directory));
  }
  std::vector<RunId> runs;
  std::vector<CaseInQuestion> files;
  for (const std::string& text : cases) {
    if (std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; })) {
      TRY(const std::uint64_t run, ParseRunId(text));
      runs.push_back(run);
      continue;
    }
    TRY(LoadedCase loaded, LoadCase(text));
    files.push_back({std::filesystem::path(text).filename().string(), 0, std::move(loaded.test_case)});
  }
  TRY(QuestionedCampaign questioned, CasesOfRuns(directory, runs));
  if (!files.empty() && questioned.plans.size() > 1) {
    return InvalidInput(fmt::format(
        "{} has {} searches with different settings: to which would the file {} belong? Name runs instead",
        directory, questioned.plans.size(), files.front().name));
  }
  for (CaseInQuestion& file : files) {
    if (const auto refusal = RefusalOf(questioned.plans.front().experiment, file.test_case))
      return InvalidInput(fmt::format("{}: {}", file.name, refusal->message));
    questioned.cases.push_back(std::move(file));
  }
  AskOnce(context, questioned);
  return questioned;
}

Status CheckHaveObstacles(const QuestionedCampaign& questioned) {
  const auto bare = std::ranges::find_if(
      questioned.cases, [](const CaseInQuestion& one) { return one.test_case.obstacles.empty(); });
  if (bare == questioned.cases.end()) return Ok{};
  return InvalidInput(fmt::format("{} has no obstacles: there is nothing to leave out", bare->name));
}

CampaignRun RunOfCall(CommandContext& context, const CallPlan& plan, int workers,
                      const ServingOptions& serving) {
  std::size_t cases = 0;
  for (const SearchPlan& search : plan.searches) cases += search.cases.size();
  CampaignRun campaign;
  campaign.directory = plan.directory;
  campaign.same_command_resumes = true;
  campaign.announcement = fmt::format("{} with fresh seeds, {}, in {}", Counted(cases, "case"),
                                      Counted(workers, "worker"), plan.directory);
  campaign.serving = serving;
  campaign.session.workers = workers;
  campaign.run = [&context, plan](const SessionOptions& session) {
    return CampaignDirectory::IsCampaign(plan.directory)
               ? context.campaigns.Resume(plan.directory, session)
               : context.campaigns.Start(plan.directory, plan.searches, session);
  };
  return campaign;
}

}  // namespace gauntlet
