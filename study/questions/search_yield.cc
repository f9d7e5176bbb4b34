#include "study/questions/search_yield.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "base/shell_quoted.h"
#include "controllers/registry.h"
#include "master/campaign/stored_campaign.h"
#include "master/store/run_numbers.h"
#include "search/experiment/failure_cells.h"
#include "search/given/repeated_case.h"
#include "search/search_table.h"
#include "study/questions/confirmations.h"
#include "study/sets/subset.h"

namespace gauntlet {
namespace {

// What is looked at of a campaign.
struct Candidates {
  bool elites = false;  // else all cases that failed
  QuestionedCampaign cases;
};

Result<Candidates> CandidatesOf(const std::string& dir, const std::vector<SearchPlan>& plans) {
  const bool elites = RowOf(plans.front().experiment).individuals == Individuals::kElites;
  TRY(auto cases, elites ? PopulationCases(dir) : FailingCases(dir));
  return Candidates{elites, std::move(cases)};
}

// What both experiments test, or how they search, as lines; "" when they are alike, else the first line of
// either that differs.
std::string FirstDifference(const std::string& first, const std::string& second) {
  std::istringstream lines1(first);
  std::istringstream lines2(second);
  std::string line1;
  std::string line2;
  do {
    line1.clear();
    line2.clear();
    std::getline(lines1, line1);
    std::getline(lines2, line2);
    if (line1 != line2) return fmt::format("'{}' and '{}'", line1, line2);
  } while (lines1 || lines2);
  return {};
}

std::string IdentityBesideSeed(Experiment experiment) {
  experiment.seed = 0;
  return SearchIdentity(SetupOf(experiment));
}

std::string WhatIsTested(const Experiment& experiment) {
  return IdentityBesideSeed(ConfirmationOf(experiment, 0));
}

Status AddCampaign(const std::string& dir, YieldSet& set) {
  TRY(const auto campaign, OpenStoredCampaign(dir));
  const std::vector<SearchPlan>& plans = campaign.plans;
  TRY(CheckOneSetting(plans, dir));
  TRY(const auto candidates, CandidatesOf(dir, plans));
  TRY(const auto confirmations, ReadConfirmations(dir));
  std::map<std::uint64_t, const Confirmation*> known;
  for (const Confirmation& one : confirmations) known[one.key] = &one;

  TRY(const auto totals, campaign.view.store->LoadTotals());
  const std::size_t first = set.searches.size();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const SearchId id = plans[i].id;
    const auto known_runs = std::ranges::find(totals, id, &SearchTotals::search);
    set.searches.push_back({.place = plans.size() > 1 ? fmt::format("{}:search:{}", dir, id) : dir,
                            .experiment = plans[i].experiment,
                            .runs = known_runs == totals.end() ? 0 : known_runs->runs,
                            .confirmed = {}});
  }
  std::size_t unconfirmed = 0;
  for (const CaseInQuestion& one : candidates.cases.cases) {
    SearchYield& yield = set.searches[first + one.search];
    ++yield.cases;
    const auto found = known.find(ConfirmationKey(yield.experiment, one.test_case));
    if (found == known.end()) {
      ++unconfirmed;
      continue;
    }
    const Confirmation& confirmation = *found->second;
    if (confirmation.verdict != FailureVerdict::kFail || !confirmation.middle) continue;
    const DescriptorGrid grid(CellsOf(yield.experiment));
    yield.confirmed.push_back(
        {grid.CellOf(*confirmation.middle), one.test_case.obstacles.size(), SequenceOf(RunOfName(one.name))});
  }
  if (unconfirmed == 0) return Ok{};
  return InvalidInput(fmt::format(
      "{}: {} of its {} {} have not been simulated again with fresh seeds: `gauntlet confirm {} {}`", dir,
      unconfirmed, candidates.cases.cases.size(), candidates.elites ? "elites" : "failing cases",
      PastedPath(dir), candidates.elites ? "--elites" : "--all-failing"));
}

Status CheckAxes(const SearchYield& yield) {
  if (!CellsOf(yield.experiment).empty()) return Ok{};
  return InvalidInput(fmt::format("{}: scenario {} does not say along which metrics its failures differ",
                                  yield.place, yield.experiment.scenario));
}

}  // namespace

std::size_t CellsWith(const SearchYield& yield, std::size_t most_obstacles) {
  std::set<std::size_t> cells;
  for (const ConfirmedCase& one : yield.confirmed) {
    if (one.obstacles <= most_obstacles) cells.insert(one.cell);
  }
  return cells.size();
}

std::optional<std::uint64_t> RunsUntil(const SearchYield& yield, std::size_t cells,
                                       std::size_t most_obstacles) {
  std::map<std::size_t, std::uint64_t> first;  // by cell
  for (const ConfirmedCase& one : yield.confirmed) {
    if (one.obstacles > most_obstacles) continue;
    const auto [found, added] = first.emplace(one.cell, one.found);
    if (!added) found->second = std::min(found->second, one.found);
  }
  if (cells == 0 || first.size() < cells) return std::nullopt;
  std::vector<std::uint64_t> runs;
  for (const auto& [cell, found] : first) runs.push_back(found);
  std::ranges::sort(runs);
  return runs[cells - 1];
}

Result<YieldSet> ReadYields(const std::string& text) {
  TRY(const auto parts, SplitSet(text));
  YieldSet set{.name = text, .title = {}, .searches = {}};
  for (const SetPart& part : parts) {
    if (!part.rest.empty())
      return InvalidInput(
          fmt::format("{}:{}: whole campaigns are compared, without ':{}'", part.path, part.rest, part.rest));
    TRY(AddCampaign(part.path, set));
  }
  const SearchYield& first = set.searches.front();
  TRY(CheckAxes(first));
  for (const SearchYield& one : set.searches) {
    const std::string difference =
        FirstDifference(IdentityBesideSeed(first.experiment), IdentityBesideSeed(one.experiment));
    if (difference.empty()) continue;
    return InvalidInput(
        fmt::format("{} and {} differ in more than their seeds: {}", first.place, one.place, difference));
  }
  set.title = RowOf(first.experiment).title;
  return set;
}

Status CheckSameBudget(const std::vector<YieldSet>& sets) {
  const SearchYield& first = sets.front().searches.front();
  for (const YieldSet& set : sets) {
    for (const SearchYield& one : set.searches) {
      const std::string difference =
          FirstDifference(WhatIsTested(first.experiment), WhatIsTested(one.experiment));
      if (!difference.empty()) {
        return InvalidInput(
            fmt::format("{} and {} do not test the same: {}", first.place, one.place, difference));
      }
      if (one.runs == first.runs) continue;
      return InvalidInput(fmt::format("{} has {} runs and {} has {}: searches are compared at equal runs",
                                      first.place, first.runs, one.place, one.runs));
    }
  }
  return Ok{};
}

}  // namespace gauntlet
