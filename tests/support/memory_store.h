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

class MemoryStore final : public ResultStore {
 public:
  // Records wait until CommitAll when this is false.
  bool commits_by_itself = true;
  // What every commit from now on meets.
  std::optional<Error> failure;

  // What is durable; tests may change it.
  std::vector<StoredSearch> searches;
  std::map<SearchId, std::vector<Individual>> individuals;
  std::vector<StoredLine> lines;
  std::map<RunId, StoredRun> runs;
  std::map<SearchId, std::vector<SavedState>> states;  // the newest last
  std::vector<StoredEvent> events;
  std::vector<std::chrono::milliseconds> commits_wanted_within;

  void CommitAll() {
    for (const auto& record : std::exchange(waiting_, {})) record();
  }
  // The process dies: what is not durable is gone.
  void Crash() {
    waiting_.clear();
    committed_.clear();
  }

  void AddSearch(const StoredSearch& search) override {
    waiting_.push_back([this, search] { searches.push_back(search); });
  }
  void AddIndividuals(SearchId search, const std::vector<Individual>& born) override {
    waiting_.push_back([this, search, born] {
      std::vector<Individual>& all = individuals[search];
      all.insert(all.end(), born.begin(), born.end());
    });
  }
  void AddLine(const StoredLine& line) override {
    waiting_.push_back([this, line] { lines.push_back(line); });
  }
  void AddRun(StoredRun run) override {
    waiting_.push_back([this, run] {
      committed_.push_back(run.id);
      runs[run.id] = run;
    });
  }
  void SaveState(const SavedState& state) override {
    waiting_.push_back([this, state] { states[state.search].push_back(state); });
  }
  void MarkFinished(SearchId search, RunId last_run) override {
    waiting_.push_back([this, search, last_run] {
      for (StoredSearch& one : searches)
        if (one.id == search) one.finished_with = std::max(one.finished_with, last_run);
    });
  }
  void AddEvent(const StoredEvent& event) override {
    waiting_.push_back([this, event] { events.push_back(event); });
  }

  Result<std::vector<RunId>> Committed() override {
    if (commits_by_itself && !failure) CommitAll();
    if (!committed_.empty()) return std::exchange(committed_, {});
    if (failure) return *failure;
    return std::vector<RunId>();
  }
  Status Flush() override {
    if (failure) return *failure;
    CommitAll();
    return Ok{};
  }
  void CommitWithin(std::chrono::milliseconds time) override { commits_wanted_within.push_back(time); }
  int CommitNotifier() const override { return -1; }

  Result<std::vector<StoredSearch>> LoadSearches() override {
    std::vector<StoredSearch> all = searches;
    for (StoredSearch& search : all) {
      for (const auto& [id, run] : runs) {
        if (run.search == search.id) search.last_run = id;
      }
    }
    return all;
  }
  Result<std::vector<SearchTotals>> LoadTotals() override {
    std::vector<SearchTotals> all;
    for (const StoredSearch& search : searches) {
      SearchTotals& totals = all.emplace_back();
      totals.search = search.id;
      totals.finished = search.finished_with > 0 ? 1 : 0;
      totals.individuals = individuals[search.id].size();
      for (const auto& [id, run] : runs) {
        if (run.search == search.id) totals.Count(run);
      }
    }
    return all;
  }
  Result<std::vector<Individual>> LoadIndividuals(SearchId search, IndividualId after = 0) override {
    std::vector<Individual> found = individuals[search];
    std::erase_if(found, [after](const Individual& one) { return one.id <= after; });
    return found;
  }
  Result<std::vector<StoredLine>> LoadLines(SearchId search, IndividualId after) override {
    std::vector<StoredLine> found = lines;
    std::erase_if(found,
                  [&](const StoredLine& one) { return one.search != search || one.individual <= after; });
    return found;
  }
  Result<std::optional<StoredLine>> FindLine(SearchId search, const std::string& name) override {
    const auto found = std::ranges::find_if(
        lines, [&](const StoredLine& one) { return one.search == search && one.name == name; });
    return found == lines.end() ? std::optional<StoredLine>() : *found;
  }
  Result<std::optional<SavedState>> LoadNewestState(SearchId search) override {
    const std::vector<SavedState>& all = states[search];
    return all.empty() ? std::optional<SavedState>() : all.back();
  }
  Status ForEachRun(SearchId search, RunId after, const RunVisitor& visit) override {
    for (auto run = runs.upper_bound(after); run != runs.end(); ++run) {
      if (run->second.search != search) continue;
      TRY(visit(run->second));
    }
    return Ok{};
  }
  Status ForEachRow(SearchId search, RunId after, const RunVisitor& visit) override {
    return ForEachRun(search, after, [&visit](StoredRun run) {
      run.spec.clear();
      run.result.clear();
      return visit(run);
    });
  }
  Result<std::optional<StoredRun>> LoadRun(RunId run) override {
    const auto found = runs.find(run);
    return found == runs.end() ? std::optional<StoredRun>() : found->second;
  }
  Result<std::vector<StoredEvent>> LoadEvents() override { return events; }

 private:
  std::vector<std::function<void()>> waiting_;
  std::vector<RunId> committed_;  // not reported yet
};

}  // namespace gauntlet::testing_support
