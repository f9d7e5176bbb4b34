#include "master/report/confirmations.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "analysis/statistics/proportions.h"
#include "base/hash.h"
#include "master/directory/campaign_ownership.h"
#include "master/report/stored_check.h"
#include "master/report/stored_search.h"
#include "master/report/subset.h"
#include "master/search/confirmation_search.h"
#include "master/store/run_numbers.h"
#include "proto/run_codec.h"

namespace gauntlet::master {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = "/confirm";
constexpr std::string_view kOfRun = "run ";  // begins the name of a run's case
constexpr double kConfidence = 0.95;

// 0 when the name is that of a file's case.
RunId RunOfName(const std::string& name) {
  RunId run = 0;
  if (!name.starts_with(kOfRun)) return 0;
  const char* end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + kOfRun.size(), end, run);
  return read.ec == std::errc() && read.ptr == end ? run : 0;
}

Result<CaseInQuestion> CaseOfRun(ResultStore& store, RunId id, const std::string& dir) {
  const Result<std::optional<StoredRun>> run = store.LoadRun(id);
  if (!run) return run.error();
  if (!run->has_value()) return Error{ErrorKind::kNotFound, fmt::format("there is no run {} in {}", id, dir)};
  Result<sim::RunSpec> spec = proto::DecodeRunSpec((*run)->spec);
  if (!spec) return spec.error();
  return CaseInQuestion{fmt::format("{}{}", kOfRun, id), (*run)->search - 1, std::move(spec->test_case)};
}

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
    if (one.tally.runs() > 0) {
      one.interval = analysis::WilsonInterval(static_cast<std::uint32_t>(one.tally.failures),
                                              static_cast<std::uint32_t>(one.tally.runs()), kConfidence);
    } else {
      one.interval = {0.0, 1.0};
    }
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

Result<QuestionedCampaign> CasesOfRuns(const std::string& dir, const std::vector<RunId>& runs) {
  const Result<CampaignView> campaign = ViewCampaign(dir, Checked::kRows);
  if (!campaign) return campaign.error();
  Result<std::vector<SearchPlan>> plans = ReadSearchPlans(campaign->directory);
  if (!plans) return plans.error();
  QuestionedCampaign questioned{*std::move(plans), {}};
  for (const RunId id : runs) {
    Result<CaseInQuestion> one = CaseOfRun(*campaign->store, id, dir);
    if (!one) return one.error();
    questioned.cases.push_back(*std::move(one));
  }
  return questioned;
}

Result<QuestionedCampaign> FailingCases(const std::string& dir) {
  const Result<OpenedSubset> opened = OpenSubset({dir, "all"});
  if (!opened) return opened.error();
  ResultStore& store = *opened->campaign.store;
  QuestionedCampaign questioned{opened->plans, {}};
  const auto add = [&](const SubsetSearch& search) -> Status {
    const std::string failing(FailingOf(search.experiment.scenario));
    const Result<std::vector<SelectedRun>> runs = SelectRuns(search, store, opened->subset, failing);
    if (!runs) return runs.error();
    std::set<IndividualId> individuals;
    std::set<std::uint64_t> cases;
    for (const SelectedRun& run : *runs) {
      if (run.value != 1.0 || !individuals.insert(run.individual).second) continue;
      Result<CaseInQuestion> one = CaseOfRun(store, run.run, dir);
      if (!one) return one.error();
      if (cases.insert(CaseHash(one->test_case)).second) questioned.cases.push_back(*std::move(one));
    }
    return Ok{};
  };
  if (Status visited = ForEachSearch(opened->plans, store, dir, opened->subset, add); !visited)
    return visited.error();
  return questioned;
}

std::uint64_t ConfirmationKey(const Experiment& experiment, const sim::TestCase& test_case) {
  Fnv1a64 hash;
  hash.AddBytes(SearchIdentity({ConfirmationOf(experiment, 0), {}, kOnlySearch, {test_case}}));
  return hash.value();
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

ConfirmationPlan PlanConfirmation(const std::string& dir, const QuestionedCampaign& questioned,
                                  const std::vector<Confirmation>& known, int replicates) {
  std::vector<SearchPlan> plans = questioned.plans;
  std::set<std::uint64_t> settled;
  for (const Confirmation& one : known) {
    if (one.verdict == FailureVerdict::kError || one.tally.runs() >= replicates) settled.insert(one.key);
  }
  Fnv1a64 call;
  call.AddUint64(static_cast<std::uint64_t>(replicates));
  for (const CaseInQuestion& one : questioned.cases) {
    SearchPlan& plan = plans[one.search];
    const std::uint64_t key = ConfirmationKey(plan.experiment, one.test_case);
    if (!settled.insert(key).second) continue;
    call.AddUint64(key);
    plan.cases.push_back(one.test_case);
    plan.cases.back().name = one.name;
  }
  std::erase_if(plans, [](const SearchPlan& plan) { return plan.cases.empty(); });
  for (SearchPlan& plan : plans) plan.experiment = ConfirmationOf(plan.experiment, replicates);
  if (plans.size() == 1) plans.front().settings.clear();
  return {fmt::format("{}{}/{:016x}", dir, kFolder, call.value()), std::move(plans)};
}

}  // namespace gauntlet::master
