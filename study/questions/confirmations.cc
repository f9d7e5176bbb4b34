#include "study/questions/confirmations.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "controllers/registry.h"
#include "master/campaign/stored_check.h"
#include "master/campaign/stored_search.h"
#include "master/directory/campaign_ownership.h"
#include "search/experiment/failure_cells.h"
#include "search/given/confirmation_search.h"
#include "study/questions/answered_calls.h"

namespace gauntlet {
namespace {

constexpr const char* kFolder = "/confirm";

// What the runs of one case tell.
class CaseRuns {
 public:
  CaseRuns(const Experiment& experiment, const sim::TestCase& test_case) : failing_(FailingOf(experiment)) {
    if (const controllers::ScenarioInfo* scenario = controllers::FindScenario(experiment)) {
      ways_of_.emplace(*scenario, experiment.scenario_parameters, test_case);
      grid_.emplace(CellsOf(experiment));
    }
  }

  // Error: the run does not read back.
  Status Add(const StoredRun& run) {
    TRY(const auto outcome, OutcomeOf(run, /*with_metrics=*/true));
    const int failures = tally_.failures;
    tally_.Add(outcome, failing_);
    if (message_.empty()) message_ = run.message;
    if (tally_.failures == failures || !ways_of_) return Ok{};
    ways_.push_back(ways_of_->Of(outcome.metrics));
    failed_.push_back(run.id);
    if (std::optional<Descriptor> failure = grid_->Describe(outcome))
      failures_.push_back(*std::move(failure));
    return Ok{};
  }

  Confirmation Conclude(const Experiment& experiment, const sim::TestCase& test_case,
                        const std::string& campaign) const {
    Confirmation one{.name = test_case.name,
                     .run = RunOfName(test_case.name),
                     .key = ConfirmationKey(experiment, test_case),
                     .tally = tally_,
                     .verdict = VerdictOf(tally_, ConfirmationReplicates(experiment)),
                     .interval = FailureInterval(tally_),
                     .middle = failures_.empty() ? std::nullopt : std::optional(MiddleOf(failures_)),
                     .message = message_,
                     .example = {}};
    if (!ways_.empty()) {
      const std::size_t typical = TypicalWay(ways_);
      one.example = {experiment.scenario, ways_[typical], campaign, failed_[typical],
                     experiment.scenario_plugin};
    }
    return one;
  }

 private:
  const std::string_view failing_;
  std::optional<FailureWays> ways_of_;
  std::optional<DescriptorGrid> grid_;  // where ways_of_ is
  FailureTally tally_;
  std::string message_;
  std::vector<FailureWay> ways_;  // of the failed runs
  std::vector<RunId> failed_;
  std::vector<Descriptor> failures_;  // of those that could be described
};

// The confirmations of one search. Error: what is stored does not read back.
Status AddConfirmations(const Experiment& experiment, SearchId search, const std::string& campaign,
                        ResultStore& store, std::map<std::uint64_t, Confirmation>& known) {
  TRY(const auto cases, store.LoadIndividuals(search));
  std::vector<CaseRuns> runs_of;
  for (const Individual& one : cases) runs_of.emplace_back(experiment, one.test_case);
  TRY(store.ForEachRun(search, 0, [&](const StoredRun& run) -> Status {
    if (run.individual < 1 || run.individual > runs_of.size()) return Ok{};
    return runs_of[run.individual - 1].Add(run);
  }));
  for (std::size_t i = 0; i < runs_of.size(); ++i) {
    Confirmation one = runs_of[i].Conclude(experiment, cases[i].test_case, campaign);
    if (one.verdict == FailureVerdict::kOpen) continue;
    Confirmation& best = known[one.key];
    if (best.key == 0 || one.tally.runs() > best.tally.runs()) best = std::move(one);
  }
  return Ok{};
}

double ShareOfFailures(const Confirmation& one) {
  return static_cast<double>(one.tally.failures) / static_cast<double>(one.tally.runs());
}

// Of what is left of the case; null when it was not minimised.
const SmallestLayout* LayoutOf(const Confirmation& one, const std::vector<SmallestLayout>& layouts) {
  const auto layout = std::ranges::find(layouts, one.run, &SmallestLayout::run);
  return one.run == 0 || layout == layouts.end() ? nullptr : &*layout;
}

const SmallestLayout* Smaller(const SmallestLayout* one, const SmallestLayout* other) {
  if (one == nullptr || other == nullptr) return one == nullptr ? other : one;
  const auto obstacles = [](const SmallestLayout* layout) {
    return layout->document.test_case.obstacles.size();
  };
  return obstacles(other) < obstacles(one) ? other : one;
}

Status AddConfirmationsOf(const std::string& dir, std::map<std::uint64_t, Confirmation>& known) {
  const Result<CampaignView> campaign = ViewCampaign(dir, Checked::kRows);
  if (!campaign) return HasNothingYet(campaign.error()) ? Status(Ok{}) : campaign.error();
  TRY(const auto plans, ReadSearchPlans(campaign->directory));
  TRY(CheckStored(plans, *campaign->store, Checked::kRows));
  for (const SearchPlan& plan : plans) {
    TRY(AddConfirmations(plan.experiment, plan.id, dir, *campaign->store, known));
  }
  return Ok{};
}

}  // namespace

std::uint64_t ConfirmationKey(const Experiment& experiment, const sim::TestCase& test_case) {
  return KeyOfCase(ConfirmationOf(experiment, 0), test_case);
}

Result<std::vector<Confirmation>> ReadConfirmations(const std::string& dir) {
  std::map<std::uint64_t, Confirmation> known;
  for (const std::string& call : CallsIn(dir + kFolder)) {
    TRY(AddConfirmationsOf(call, known));
  }
  std::vector<Confirmation> confirmations;
  for (auto& [key, one] : known) confirmations.push_back(std::move(one));
  std::ranges::sort(confirmations, [](const Confirmation& a, const Confirmation& b) {
    return std::pair(a.run, a.name) < std::pair(b.run, b.name);
  });
  return confirmations;
}

std::vector<DistinctFailure> DistinctFailures(const std::vector<Confirmation>& confirmations,
                                              const std::vector<SmallestLayout>& layouts) {
  using NameAndPlugin = std::pair<std::string, std::string>;
  std::map<NameAndPlugin, std::vector<const Confirmation*>> failed;  // by scenario
  for (const Confirmation& one : confirmations) {
    if (one.example) failed[{one.example->scenario, one.example->scenario_plugin}].push_back(&one);
  }
  std::vector<DistinctFailure> distinct;
  for (auto& [name, cases] : failed) {
    const controllers::ScenarioInfo* scenario = controllers::FindScenario(name.first, name.second);
    if (scenario == nullptr) continue;
    std::ranges::stable_sort(cases, std::greater(), [](const auto* one) { return ShareOfFailures(*one); });
    std::vector<FailureWay> ways;
    for (const Confirmation* one : cases) ways.push_back(one->example->way);
    const std::vector<std::size_t> groups = GroupWays(*scenario, ways);
    const std::size_t first = distinct.size();
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (first + groups[i] == distinct.size()) distinct.push_back({{}, DescribeWay(*scenario, ways[i])});
      DistinctFailure& failure = distinct[first + groups[i]];
      failure.cases.push_back(cases[i]);
      failure.confirmed = failure.confirmed || cases[i]->verdict == FailureVerdict::kFail;
      failure.smallest = Smaller(failure.smallest, LayoutOf(*cases[i], layouts));
    }
  }
  std::ranges::stable_sort(distinct, std::greater(), [](const DistinctFailure& one) {
    return std::pair(ShareOfFailures(*one.cases.front()), one.cases.size());
  });
  return distinct;
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

}  // namespace gauntlet
