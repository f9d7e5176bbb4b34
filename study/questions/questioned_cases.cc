#include "study/questions/questioned_cases.h"

#include <fmt/format.h>

#include <charconv>
#include <set>
#include <utility>

#include "base/hash.h"
#include "master/directory/campaign_ownership.h"
#include "master/store/run_numbers.h"
#include "proto/run_codec.h"
#include "search/failure_tally.h"
#include "search/search_table.h"
#include "study/sets/subset.h"

namespace gauntlet {
namespace {

constexpr std::string_view kOfRun = "run ";  // begins the name of a run's case

Result<CaseInQuestion> CaseOfRun(ResultStore& store, RunId id, const std::string& dir) {
  TRY(const auto run, store.LoadRun(id));
  if (!run.has_value()) return Error{ErrorKind::kNotFound, fmt::format("there is no run {} in {}", id, dir)};
  TRY(auto spec, proto::DecodeRunSpec(run->spec));
  return CaseInQuestion{fmt::format("{}{}", kOfRun, id), run->search - 1, std::move(spec.test_case)};
}

// Every different case of a subset, named by its first run in it.
Result<QuestionedCampaign> CasesOfSubset(const std::string& dir, const std::string& subset,
                                         bool only_failing) {
  TRY(const auto opened, OpenSubset({dir, subset}));
  ResultStore& store = *opened.campaign.store;
  QuestionedCampaign questioned{opened.plans, {}};
  const auto add = [&](const SubsetSearch& search) -> Status {
    const std::string failing(FailingOf(search.plan.experiment));
    TRY(const auto runs, SelectRuns(search, store, opened.subset, failing));
    std::set<IndividualId> individuals;
    std::set<std::uint64_t> cases;
    for (const SelectedRun& run : runs) {
      if ((only_failing && run.value != 1.0) || !individuals.insert(run.individual).second) continue;
      TRY(auto one, CaseOfRun(store, run.run, dir));
      if (cases.insert(CaseHash(one.test_case)).second) questioned.cases.push_back(std::move(one));
    }
    return Ok{};
  };
  TRY(ForEachSearch(opened.plans, store, dir, opened.subset, add));
  return questioned;
}

}  // namespace

Result<QuestionedCampaign> CasesOfRuns(const std::string& dir, const std::vector<RunId>& runs) {
  TRY(const auto campaign, ViewCampaign(dir, Checked::kRows));
  TRY(auto plans, ReadSearchPlans(campaign.directory));
  QuestionedCampaign questioned{std::move(plans), {}};
  for (const RunId id : runs) {
    TRY(auto one, CaseOfRun(*campaign.store, id, dir));
    questioned.cases.push_back(std::move(one));
  }
  return questioned;
}

Result<QuestionedCampaign> FailingCases(const std::string& dir) {
  return CasesOfSubset(dir, "all", /*only_failing=*/true);
}

Result<QuestionedCampaign> PopulationCases(const std::string& dir) {
  return CasesOfSubset(dir, "final", /*only_failing=*/false);
}

RunId RunOfName(const std::string& name) {
  RunId run = 0;
  if (!name.starts_with(kOfRun)) return 0;
  const char* end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + kOfRun.size(), end, run);
  return read.ec == std::errc() && read.ptr == end ? run : 0;
}

std::uint64_t KeyOfCase(const Experiment& about, const sim::TestCase& test_case) {
  Fnv1a64 hash;
  hash.AddBytes(SearchIdentity(SetupOf(about, {}, {test_case})));
  return hash.value();
}

CallPlan PlanCall(const std::string& folder, const QuestionedCampaign& questioned,
                  const std::function<Experiment(const Experiment& experiment)>& about) {
  std::vector<SearchPlan> plans = questioned.plans;
  for (SearchPlan& plan : plans) plan.experiment = about(plan.experiment);
  std::set<std::uint64_t> asked;
  Fnv1a64 call;
  for (const CaseInQuestion& one : questioned.cases) {
    SearchPlan& plan = plans[one.search];
    const std::uint64_t key = KeyOfCase(plan.experiment, one.test_case);
    if (!asked.insert(key).second) continue;
    call.AddUint64(key);
    plan.cases.push_back(one.test_case);
    plan.cases.back().name = one.name;
  }
  std::erase_if(plans, [](const SearchPlan& plan) { return plan.cases.empty(); });
  if (plans.size() == 1) plans.front().settings.clear();
  return {fmt::format("{}/{:016x}", folder, call.value()), std::move(plans)};
}

}  // namespace gauntlet
