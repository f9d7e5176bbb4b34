#include "master/report/confirmations.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "master/directory/campaign_ownership.h"
#include "master/report/answered_calls.h"
#include "master/report/stored_check.h"
#include "master/report/stored_search.h"
#include "master/search/confirmation_search.h"

namespace gauntlet::master {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "/confirm";

// The confirmations of one search. Error: what is stored does not read back.
Status AddConfirmations(const Experiment& experiment, SearchId search, ResultStore& store,
                        std::map<std::uint64_t, Confirmation>& known) {
  const Result<std::vector<Individual>> cases = store.LoadIndividuals(search);
  if (!cases) return cases.error();
  std::vector<Confirmation> found(cases->size());
  const std::string_view failing = FailingOf(experiment.scenario);
  const bool with_metrics = FailingNeedsMetrics(failing);
  std::optional<Error> damage;
  const auto take = [&](const StoredRun& run) {
    const Result<RunOutcome> outcome = OutcomeOf(run, with_metrics);
    if (damage || !outcome || run.individual < 1 || run.individual > found.size()) {
      if (!outcome) damage = outcome.error();
      return;
    }
    Confirmation& one = found[run.individual - 1];
    one.tally.Add(*outcome, failing);
    if (one.message.empty()) one.message = run.message;
  };
  Status read = with_metrics ? store.ForEachRun(search, 0, take) : store.ForEachRow(search, 0, take);
  if (!read) return read;
  if (damage) return *damage;
  for (std::size_t i = 0; i < found.size(); ++i) {
    Confirmation& one = found[i];
    one.verdict = VerdictOf(one.tally, ConfirmationReplicates(experiment));
    if (one.verdict == FailureVerdict::kOpen) continue;
    one.name = (*cases)[i].test_case.name;
    one.run = RunOfName(one.name);
    one.key = ConfirmationKey(experiment, (*cases)[i].test_case);
    one.interval = FailureInterval(one.tally);
    Confirmation& best = known[one.key];
    if (best.key == 0 || one.tally.runs() > best.tally.runs()) best = std::move(one);
  }
  return Ok{};
}

Status AddConfirmationsOf(const std::string& dir, std::map<std::uint64_t, Confirmation>& known) {
  const Result<CampaignView> campaign = ViewCampaign(dir, Checked::kRows);
  // One that is just being made, or whose master just ends, has nothing to tell yet.
  if (!campaign) {
    const ErrorKind kind = campaign.error().kind;
    return kind == ErrorKind::kNotFound || kind == ErrorKind::kInUse ? Status(Ok{}) : campaign.error();
  }
  const Result<std::vector<SearchPlan>> plans = ReadSearchPlans(campaign->directory);
  if (!plans) return plans.error();
  if (Status whole = CheckStored(*plans, *campaign->store, Checked::kRows); !whole) return whole;
  for (std::size_t i = 0; i < plans->size(); ++i) {
    Status added =
        AddConfirmations((*plans)[i].experiment, static_cast<SearchId>(i + 1), *campaign->store, known);
    if (!added) return added;
  }
  return Ok{};
}

}  // namespace

std::uint64_t ConfirmationKey(const Experiment& experiment, const sim::TestCase& test_case) {
  return KeyOfCase(ConfirmationOf(experiment, 0), test_case);
}

Result<std::vector<Confirmation>> ReadConfirmations(const std::string& dir) {
  std::map<std::uint64_t, Confirmation> known;
  std::error_code none;
  std::vector<std::string> calls;
  for (const fs::directory_entry& entry : fs::directory_iterator(dir + kFolder, none)) {
    calls.push_back(entry.path().string());
  }
  std::ranges::sort(calls);
  for (const std::string& call : calls) {
    if (Status added = AddConfirmationsOf(call, known); !added) return added.error();
  }
  std::vector<Confirmation> confirmations;
  for (auto& [key, one] : known) confirmations.push_back(std::move(one));
  std::ranges::sort(confirmations, [](const Confirmation& a, const Confirmation& b) {
    return std::pair(a.run, a.name) < std::pair(b.run, b.name);
  });
  return confirmations;
}

CallPlan PlanConfirmation(const std::string& dir, const QuestionedCampaign& questioned,
                          const std::vector<Confirmation>& known, int replicates) {
  std::set<std::uint64_t> settled;
  for (const Confirmation& one : known) {
    if (one.verdict == FailureVerdict::kError || one.tally.runs() >= replicates) settled.insert(one.key);
  }
  QuestionedCampaign open = questioned;
  std::erase_if(open.cases, [&](const CaseInQuestion& one) {
    return settled.contains(ConfirmationKey(open.plans[one.search].experiment, one.test_case));
  });
  return PlanCall(dir + kFolder, open, [replicates](const Experiment& experiment) {
    return ConfirmationOf(experiment, replicates);
  });
}

}  // namespace gauntlet::master
