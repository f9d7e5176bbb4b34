// Where a campaign's searches, individuals, runs and search states survive. Writes are handed over at once
// and committed in groups on the store's own thread; a caller learns of the commit by Committed().
// Thread-safety: one calling thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "proto/messages.h"
#include "search/search_algorithm.h"

namespace gauntlet {

using proto::RunId;
using SearchId = std::uint32_t;  // 1, 2, ... within a campaign

struct StoredSearch {
  SearchId id = 0;
  std::string name;
  std::string algorithm;
  std::uint64_t seed = 0;
  // The last run that it had when it came to its end; 0 = it has not. A search that was made longer since
  // comes to its end once more, with a later run.
  RunId finished_with = 0;
  RunId last_run = 0;  // that is stored; known to those who load it
};

// A run with what came of it. The outcome is a copy of a few fields of the result, so that rows can be
// queried without decoding any: of its metrics and robots the store knows nothing.
struct StoredRun : RunOutcome {
  RunId id = 0;
  SearchId search = 0;
  IndividualId individual = 0;
  std::uint32_t evaluation = 0;
  std::uint32_t replicate = 0;
  std::uint32_t generation = 0;
  std::uint64_t seed = 0;
  proto::EncodedSpec spec;      // as it was sent
  std::uint64_t spec_hash = 0;  // FNV-1a of `spec`: finds a changed byte that would not change the result
  proto::EncodedResult result;  // without poses, mostly without waypoints (proto::DecodeStoredResult)
  std::uint64_t hash = 0;       // of the whole result
  std::string worker;
  std::uint32_t attempt = 1;
  std::string message;  // of a verdict other than completed
};

// How much of a search is stored.
struct SearchTotals {
  SearchId search = 0;
  std::uint64_t runs = 0;
  std::uint64_t runs_failed = 0;  // verdict other than completed
  std::uint64_t total_failures = 0;
  std::uint64_t individuals = 0;
  std::uint64_t finished = 0;  // how often it came to its end, each time longer than before

  void Count(const RunOutcome& run) {
    ++runs;
    if (!run.completed()) ++runs_failed;
    if (run.total_failure) ++total_failures;
  }
};

// A line that a stream of cases was asked by (study/streams/evaluation_line.h).
struct StoredLine {
  SearchId search = 0;
  IndividualId individual = 0;  // the case's
  std::string name;             // by which it can be asked for again; "" = it cannot
  std::string content;          // what it asks for, but for the case itself
  RunId first_run = 0;
  std::uint32_t runs = 1;

  bool HasSettings() const { return content.find("\"set\":") != std::string::npos; }
};

struct SavedState {
  SearchId search = 0;
  std::uint32_t generation = 0;
  RunId last_run = 0;  // the state has seen the results 1..last_run of the campaign that belong to the search
  std::string state;   // SearchAlgorithm::Save
  std::string results_digest;  // running digest of the applied results (state_hash's first ingredient)
};

struct StoredEvent {
  std::int64_t unix_ms = 0;
  std::string kind;  // one of master/store/event_kinds.h
  std::string text;
};

// What of a store somebody is going to rely on.
enum class Checked {
  kTotals,      // searches, which of them have finished, and how much is stored: O(1) in the number of runs
  kRows,        // everything but specs and results in full
  kEverything,  // every byte
};

using RunVisitor = std::function<Status(const StoredRun& run)>;

class ResultStore {
 public:
  virtual ~ResultStore() = default;

  // Appending; durable once Committed() has reported the run, or Flush() has returned without error.
  virtual void AddSearch(const StoredSearch& search) = 0;
  virtual void AddIndividuals(SearchId search, const std::vector<Individual>& individuals) = 0;
  virtual void AddLine(const StoredLine& line) = 0;
  virtual void AddRun(StoredRun run) = 0;
  virtual void SaveState(const SavedState& state) = 0;
  // The search has come to its end with this run.
  virtual void MarkFinished(SearchId search, RunId last_run) = 0;
  virtual void AddEvent(const StoredEvent& event) = 0;

  // Runs that became durable since the last call. Error: writing failed (kNoSpace when the disk is full,
  // kInUse when a newer master has taken over); nothing uncommitted is lost silently: it was never
  // acknowledged.
  virtual Result<std::vector<RunId>> Committed() = 0;
  virtual Status Flush() = 0;
  // Commit what waits, and wait no longer than this for more: somebody needs it to go on. Does not block.
  virtual void CommitWithin(std::chrono::milliseconds time) = 0;
  // A file descriptor that becomes readable when Committed() has news; -1 when there is none to wait for.
  virtual int CommitNotifier() const = 0;

  // Reading what is durable (call Flush first to see all).
  virtual Result<std::vector<StoredSearch>> LoadSearches() = 0;
  // Of every search, in the order of their numbers; does not look at a single run.
  virtual Result<std::vector<SearchTotals>> LoadTotals() = 0;
  // What is known from birth: id, parents, birth_generation, test_case; in id order. The rest follows from
  // the runs.
  virtual Result<std::vector<Individual>> LoadIndividuals(SearchId search, IndividualId after = 0) = 0;
  // Those of the individuals behind `after`, in their order.
  virtual Result<std::vector<StoredLine>> LoadLines(SearchId search, IndividualId after) = 0;
  virtual Result<std::optional<StoredLine>> FindLine(SearchId search, const std::string& name) = 0;
  virtual Result<std::optional<SavedState>> LoadNewestState(SearchId search) = 0;
  // Runs of a search with id > after, in id order. Error: that of a visit, which is the last one then, or
  // kCorrupt, naming the first run that was changed.
  virtual Status ForEachRun(SearchId search, RunId after, const RunVisitor& visit) = 0;
  // The same without specs and results, which is ten times as fast.
  virtual Status ForEachRow(SearchId search, RunId after, const RunVisitor& visit) = 0;
  virtual Result<std::optional<StoredRun>> LoadRun(RunId run) = 0;
  virtual Result<std::vector<StoredEvent>> LoadEvents() = 0;
};

}  // namespace gauntlet
