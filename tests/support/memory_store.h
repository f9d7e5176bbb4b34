// ResultStore in memory: durable are records that a commit has taken up; the rest is lost in a crash.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "master/store/result_store.h"
#include "sim/run_result.h"

namespace gauntlet::testing_support {

class MemoryStore final : public master::ResultStore {
 public:
  // Records wait until CommitAll when this is false.
  bool commits_by_itself = true;
  // What every commit from now on meets.
  std::optional<Error> failure;

  // What is durable; tests may change it.
  std::vector<master::StoredSearch> searches;
  std::map<master::SearchId, std::vector<master::Individual>> individuals;
  std::map<master::RunId, master::StoredRun> runs;
  std::map<master::SearchId, std::vector<master::SavedState>> states;  // the newest last
  std::vector<master::StoredEvent> events;
  std::vector<std::chrono::milliseconds> commits_wanted_within;

  void CommitAll() {
    for (const auto& record : std::exchange(waiting_, {})) record();
  }
  // The process dies: what is not durable is gone.
  void Crash() {
    waiting_.clear();
    committed_.clear();
  }

  void AddSearch(const master::StoredSearch& search) override {
    waiting_.push_back([this, search] { searches.push_back(search); });
  }
  void AddIndividuals(master::SearchId search, const std::vector<master::Individual>& born) override {
    waiting_.push_back([this, search, born] {
      std::vector<master::Individual>& all = individuals[search];
      all.insert(all.end(), born.begin(), born.end());
    });
  }
  void AddRun(master::StoredRun run) override {
    waiting_.push_back([this, run] {
      committed_.push_back(run.id);
      runs[run.id] = run;
    });
  }
  void SaveState(const master::SavedState& state) override {
    waiting_.push_back([this, state] { states[state.search].push_back(state); });
  }
  void MarkFinished(master::SearchId search, master::RunId last_run) override {
    waiting_.push_back([this, search, last_run] {
      for (master::StoredSearch& one : searches)
        if (one.id == search) one.finished_with = std::max(one.finished_with, last_run);
    });
  }
  void AddEvent(const master::StoredEvent& event) override {
    waiting_.push_back([this, event] { events.push_back(event); });
  }

  Result<std::vector<master::RunId>> Committed() override {
    if (commits_by_itself && !failure) CommitAll();
    if (!committed_.empty()) return std::exchange(committed_, {});
    if (failure) return *failure;
    return std::vector<master::RunId>();
  }
  Status Flush() override {
    if (failure) return *failure;
    CommitAll();
    return Ok{};
  }
  void CommitWithin(std::chrono::milliseconds time) override { commits_wanted_within.push_back(time); }
  int CommitNotifier() const override { return -1; }

  Result<std::vector<master::StoredSearch>> LoadSearches() override { return searches; }
  Result<std::vector<master::SearchTotals>> LoadTotals() override {
    std::vector<master::SearchTotals> all;
    for (const master::StoredSearch& search : searches) {
      master::SearchTotals& totals = all.emplace_back();
      totals.search = search.id;
      totals.finished = search.finished_with > 0 ? 1 : 0;
      totals.individuals = individuals[search.id].size();
      for (const auto& [id, run] : runs) {
        if (run.search != search.id) continue;
        ++totals.runs;
        totals.runs_failed += run.verdict != static_cast<int>(sim::Verdict::kCompleted) ? 1 : 0;
        totals.total_failures += run.total_failure ? 1 : 0;
      }
    }
    return all;
  }
  Result<std::vector<master::Individual>> LoadIndividuals(master::SearchId search) override {
    return individuals[search];
  }
  Result<std::optional<master::SavedState>> LoadNewestState(master::SearchId search) override {
    const std::vector<master::SavedState>& all = states[search];
    return all.empty() ? std::optional<master::SavedState>() : all.back();
  }
  Status ForEachRun(master::SearchId search, master::RunId after,
                    const std::function<void(const master::StoredRun&)>& visit) override {
    for (auto run = runs.upper_bound(after); run != runs.end(); ++run) {
      if (run->second.search == search) visit(run->second);
    }
    return Ok{};
  }
  Status ForEachRow(master::SearchId search, master::RunId after,
                    const std::function<void(const master::StoredRun&)>& visit) override {
    return ForEachRun(search, after, [&visit](master::StoredRun run) {
      run.spec.clear();
      run.result.clear();
      visit(run);
    });
  }
  Result<std::optional<master::StoredRun>> LoadRun(master::RunId run) override {
    const auto found = runs.find(run);
    return found == runs.end() ? std::optional<master::StoredRun>() : found->second;
  }
  Result<std::vector<master::StoredEvent>> LoadEvents() override { return events; }

 private:
  std::vector<std::function<void()>> waiting_;
  std::vector<master::RunId> committed_;  // not reported yet
};

}  // namespace gauntlet::testing_support
