// Runs go in, finished runs come out; where and how often they are simulated is the backend's business.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "master/dispatch/trust/worker_record.h"
#include "master/store/event_kinds.h"
#include "proto/messages.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"

namespace gauntlet {

using proto::RunId;

struct RunRequest {
  RunId id = 0;
  proto::EncodedSpec spec;
  // How long it will probably take, compared with the others that are submitted with it, in any unit; the
  // longest go first, equals in the order of their ids.
  double length = 0.0;
};

struct FinishedRun {
  RunId id = 0;
  sim::RunResult result;      // without a trajectory
  std::string worker;         // instance id and host, for the log
  std::uint32_t attempt = 1;  // how many leases it took
  std::string stderr_tail;    // of a run that failed in all attempts, what the last one printed
};

struct WorkerStatistics {
  int connected = 0;
  int slots = 0;  // of those connected: runs that they take at once
  int busy = 0;
  int quarantined = 0;              // of those connected: get no runs any more
  int lost = 0;                     // since the start
  std::uint64_t lone_verdicts = 0;  // runs given up on the word of one worker: there was no other
  std::uint64_t releases = 0;       // runs leased again because their worker was lost
  std::uint64_t duplicates = 0;
  std::uint64_t rejected_messages = 0;
  std::uint64_t nondeterministic = 0;  // duplicates whose result differed from the first one
  std::uint64_t differences = 0;       // the same, where nobody promises that there is none
  std::uint64_t copies = 0;            // runs that an idle worker got although another had them
  std::uint64_t audits = 0;            // runs simulated twice on purpose, and compared
  std::uint64_t audits_alone = 0;      // of these, by the same worker: there was no other
  std::uint64_t audits_open = 0;       // and those that wait for it
  double slot_seconds = 0.0;           // of connected workers, since the first lease
  double idle_seconds = 0.0;           // of these, without a run
  double barrier_seconds = 0.0;        // of these, because no run waited: the search needed a result first
};

// One worker, for people.
struct WorkerView {
  struct Lease {
    RunId run = 0;
    proto::Fence fence = 0;
    std::uint32_t attempt = 1;  // 1 = the run's first lease
    double seconds = 0.0;       // since it was given
    bool waits = false;         // there, behind as many others as the worker has slots
  };
  std::string label;  // instance id and host
  std::int64_t pid = 0;
  std::string allocation;  // as the worker said it, "" for none
  std::uint32_t slots = 1;
  bool lost = false;            // silent: its runs wait for others, late results are taken
  bool leaving = false;         // finishes what it has, wants nothing new
  WorkerRecord record;          // what it has done so far; says whether it is quarantined
  double silent_seconds = 0.0;  // since it was heard
  std::vector<Lease> leases;    // in the order in which they were given
};

// What it does, one of these words.
inline constexpr std::array<std::string_view, 5> kWorkerStates = {"running", "idle", "leaving", "quarantined",
                                                                  "lost"};
inline std::string_view StateOf(const WorkerView& worker) {
  if (worker.lost) return "lost";
  if (worker.record.quarantined) return "quarantined";
  if (worker.leaving) return "leaving";
  return worker.leases.empty() ? "idle" : "running";
}

// One batch job of an elastic pool, for people; words are the batch system's.
struct AllocationView {
  std::string job;
  std::string state;   // "RUNNING"
  std::string reason;  // why it waits, "Resources"; "" for none
  std::string nodes;   // "" while it waits
  int workers = 0;     // connected now
  bool cancelled = false;
};

// What a backend does right now, for people.
struct BackendView {
  std::vector<WorkerView> workers;
  std::uint64_t queued = 0;  // runs that wait for a worker
  std::vector<AllocationView> allocations;
  std::string pool_trouble;  // why there are fewer workers than could be used; "" when all is well
  int own_workers = 0;       // processes that the master keeps running itself
  // Since the master's start:
  std::uint64_t refused_workers = 0;
  std::string last_refusal;             // why the last of them may not work here
  std::uint64_t unknown_keys = 0;       // connections whose keys the campaign does not know
  std::uint64_t failed_handshakes = 0;  // connections that did not get through the greeting otherwise
};

// Something a person or the store's event table should know of.
struct DispatchEvent {
  std::string kind;  // one of master/store/event_kinds.h
  std::string text;  // one sentence
};

class EvaluationBackend {
 public:
  virtual ~EvaluationBackend() = default;
  virtual void Submit(std::vector<RunRequest> runs) = 0;
  // Waits up to `timeout` for something to happen; returns what has finished since the last call. Error: no
  // worker can be had.
  virtual Result<std::vector<FinishedRun>> Poll(std::chrono::milliseconds timeout) = 0;
  // Poll also returns while `fd` is readable; -1: no more.
  virtual void WatchInput(int /*fd*/) {}
  // These runs are stored durably: workers may forget them.
  virtual void Acknowledge(const std::vector<RunId>& runs) = 0;
  // Lets workers go; returns when they are gone or the deadline has passed.
  virtual void Shutdown(std::chrono::milliseconds deadline) = 0;
  virtual WorkerStatistics Statistics() const = 0;
  virtual BackendView Describe() const { return {}; }
  // From now on no run begins; those that run end as usual.
  virtual void StopLeasing() = 0;
  // What happened since the last call, oldest first.
  virtual std::vector<DispatchEvent> TakeEvents() { return {}; }
};

}  // namespace gauntlet
