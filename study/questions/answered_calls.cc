#include "study/questions/answered_calls.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "master/campaign/stored_search.h"
#include "master/directory/campaign_ownership.h"
#include "master/directory/search_plans.h"

namespace gauntlet {
namespace {

std::string FirstMessage(ResultStore& store, SearchId search, IndividualId individual) {
  std::string message;
  const Status read = store.ForEachRow(search, 0, [&](const StoredRun& run) {
    if (run.individual == individual && message.empty()) message = run.message;
    return Ok{};
  });
  return read ? message : read.error().message;
}

}  // namespace

std::vector<std::string> CallsIn(const std::string& folder) {
  std::error_code none;
  std::vector<std::string> calls;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    calls.push_back(entry.path().string());
  std::ranges::sort(calls);
  return calls;
}

bool HasNothingYet(const Error& error) {
  return error.kind == ErrorKind::kNotFound || error.kind == ErrorKind::kInUse;
}

Status ForEachAnswer(const std::string& directory,
                     const std::function<Status(const AnsweredSearch& answered)>& visit) {
  TRY(const auto campaign, ViewCampaign(directory));
  TRY(const auto plans, ReadSearchPlans(campaign.directory));
  ResultStore& store = *campaign.store;
  for (const SearchPlan& plan : plans) {
    const SearchId id = plan.id;
    TRY(const auto search, MakeStoredSearch(plan, store));
    TRY(RestoreSearch(id, store, *search));
    if (!search->Progress().finished) continue;
    const auto first_message = [&store, id](IndividualId one) { return FirstMessage(store, id, one); };
    TRY(visit({id, plan.experiment, *search, store, first_message}));
  }
  return Ok{};
}

std::string OutOf(const FailureTally& tally) {
  return fmt::format("{} of {}", tally.failures, tally.runs());
}

analysis::Interval FailureInterval(const FailureTally& tally) {
  if (tally.runs() == 0) return {0.0, 1.0};
  return analysis::WilsonInterval(static_cast<std::uint32_t>(tally.failures),
                                  static_cast<std::uint32_t>(tally.runs()), analysis::kConfidence);
}

}  // namespace gauntlet
