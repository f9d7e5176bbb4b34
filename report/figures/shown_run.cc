#include "report/figures/shown_run.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "master/directory/campaign_ownership.h"
#include "report/figures/replayed_figure.h"
#include "report/tables/summary_tables.h"

namespace gauntlet {
namespace {

Result<ShownRun> ShowRun(const std::string& experiment_name, StoredRun stored) {
  const RunId id = stored.id;
  Result<ReplayReport> report = ReplayRun(std::move(stored));
  if (!report) {
    // What contradicts itself is told beside the run; that nothing can be simulated concerns all.
    if (report.error().kind != ErrorKind::kCorrupt) return report.error();
    ShownRun shown;
    shown.report.stored.id = id;
    shown.trouble = report.error().message;
    return shown;
  }
  ShownRun shown{*std::move(report), "", {}};
  if (!shown.report.damage.empty()) {
    shown.trouble = shown.report.damage;
    return shown;
  }
  if (!shown.report.differences.empty()) {
    shown.trouble = fmt::format("this version does not end the run as it was stored: {}",
                                shown.report.differences.front());
  }
  shown.figure = FigureOf(experiment_name, shown.report);
  return shown;
}

Result<std::vector<ShownRun>> ShowAll(std::vector<StoredRun> runs,
                                      const std::function<std::string(const StoredRun&)>& experiment_of) {
  std::vector<std::optional<Result<ShownRun>>> shown(runs.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < runs.size(); i = next++) {
      const std::string name = experiment_of(runs[i]);
      shown[i] = ShowRun(name, std::move(runs[i]));
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    while (threads.size() + 1 < std::min(cores, runs.size())) threads.emplace_back(work);
    work();
  }
  std::vector<ShownRun> all;
  for (std::optional<Result<ShownRun>>& one : shown) {
    if (!*one) return one->error();
    all.push_back(**std::move(one));
  }
  return all;
}

// Of the runs with these obstacles that with the lowest fitness, the first of equal ones; 0 = there is none.
Result<RunId> ToughestRunOf(const std::string& campaign, const sim::Genome& obstacles) {
  TRY(const CampaignView view, ViewCampaign(campaign, Checked::kRows));
  TRY(const auto searches, view.store->LoadSearches());
  RunId toughest = 0;
  double fitness = std::numeric_limits<double>::infinity();
  for (const StoredSearch& search : searches) {
    TRY(const auto individuals, view.store->LoadIndividuals(search.id));
    TRY(view.store->ForEachRow(search.id, 0, [&](const StoredRun& run) -> Status {
      if (!run.completed() || run.fitness >= fitness || run.individual < 1 ||
          run.individual > individuals.size() ||
          individuals[run.individual - 1].test_case.obstacles != obstacles)
        return Ok{};
      toughest = run.id;
      fitness = run.fitness;
      return Ok{};
    }));
  }
  return toughest;
}

}  // namespace

std::vector<RunId> RunsToShow(const CampaignFacts& facts, const std::vector<RunMap>& maps, std::size_t most) {
  std::vector<RunId> ids;
  std::set<RunId> known;
  const auto add = [&](RunId id) {
    if (id != 0 && ids.size() < most && known.insert(id).second) ids.push_back(id);
  };
  const DistinctFailures distinct = DistinctFailuresOf(facts.answers.confirmations, {});
  for (const DistinctFailure* failure : distinct.All()) add(failure->cases.front()->run);
  if (const Confirmation* toughest = ToughestOf(facts.answers.confirmations)) add(toughest->run);
  for (const SmallestLayout& one : facts.answers.smallest_layouts) add(one.run);
  if (const SearchSummary* only = facts.summary.OnlySearch()) {
    for (const PopulationMember* one : SmallestFirst(*only)) add(one->runs.empty() ? 0 : one->runs.front());
  }
  if (const auto toughest_case = ToughestCaseOf(facts.summary)) add(toughest_case->run);
  for (const RunMap& map : maps) {
    for (const std::vector<RunId>& row : map.toughest) {
      for (const RunId run : row) add(run);
    }
  }
  for (const CaseFacts& one : facts.cases) add(one.toughest);
  return ids;
}

Result<std::vector<ShownRun>> ShowRuns(const CampaignFacts& facts, const std::vector<RunId>& ids) {
  if (ids.empty()) return std::vector<ShownRun>{};
  TRY(auto runs, ReadRuns(facts.directory, ids));
  return ShowAll(std::move(runs),
                 [&](const StoredRun& run) { return facts.plans.at(run.search - 1).experiment.name; });
}

Result<std::vector<ShownRun>> ShowTypicalRuns(const CampaignFacts& facts,
                                              const std::vector<const DistinctFailure*>& failures) {
  std::vector<StoredRun> all;
  for (const DistinctFailure* one : failures) {
    TRY(auto runs, ReadRuns(one->cases.front()->campaign, {one->typical->id}));
    all.push_back(std::move(runs.front()));
  }
  return ShowAll(std::move(all), [&](const StoredRun&) { return facts.plans.front().experiment.name; });
}

Result<std::map<RunId, ShownRun>> ShowSmallest(const CampaignFacts& facts,
                                               const std::vector<const SmallestLayout*>& layouts) {
  std::map<RunId, ShownRun> shown;
  for (const SmallestLayout* one : layouts) {
    const std::string campaign = std::filesystem::path(one->file).parent_path().string();
    TRY(const RunId run, ToughestRunOf(campaign, one->document.test_case.obstacles));
    if (run == 0) continue;
    TRY(auto runs, ReadRuns(campaign, {run}));
    TRY(shown[one->run], ShowRun(facts.plans.front().experiment.name, std::move(runs.front())));
  }
  return shown;
}

}  // namespace gauntlet
