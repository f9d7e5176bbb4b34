// EvaluationBackend over worker processes: joins the pure Scheduler with a Transport, a Clock and, when the
// master keeps its own workers, a WorkerPool.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/dispatch_options.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/dispatch/process_watch.h"
#include "master/dispatch/scheduler.h"
#include "master/dispatch/transport.h"
#include "master/dispatch/worker_pool.h"
#include "proto/messages.h"

namespace gauntlet::master {

// Single-threaded: all input and output happens inside Poll and Shutdown.
class RemoteBackend final : public EvaluationBackend {
 public:
  // `pool` may be null: then workers come from elsewhere. All parts must outlive the backend.
  RemoteBackend(CampaignIdentity identity, const DispatchOptions& options, Transport& transport,
                const Clock& clock, WorkerPool* pool = nullptr);

  // Poll returns early while `fd` is readable; -1 watches nothing.
  void WatchFd(int fd) { watched_fd_ = fd; }

  void Submit(std::vector<RunRequest> runs) override;
  Result<std::vector<FinishedRun>> Poll(std::chrono::milliseconds timeout) override;
  void Acknowledge(const std::vector<RunId>& runs) override;
  // Gives no more leases, asks all workers to drop what they do and leave; after half of the deadline
  // SIGTERM, after three quarters SIGKILL to the pool. What finished meanwhile comes with the next Poll.
  void Shutdown(std::chrono::milliseconds deadline) override;
  WorkerStatistics Statistics() const override;
  BackendView Describe() const override;
  void StopLeasing() override { scheduler_.StopLeasing(); }
  std::vector<DispatchEvent> TakeEvents() override;

 private:
  struct Connection {
    PeerId peer;
    std::string label;  // instance id and host
    pid_t pid = 0;
    std::string allocation;
    int unreachable = 0;  // heartbeats in a row that found no connection
    // Leases whose acknowledgement goes along with the next message, a heartbeat later at most: woken for
    // each, workers and master took another half percent of runs of 50 ms.
    std::vector<Fence> acknowledged;
  };

  Status Step();
  Status SupervisePool(TimePoint now);
  void BuryEnded(TimePoint now);
  void ExcuseStarving(TimePoint now);
  PoolView ViewForPool() const;
  bool ReceiveMessages(TimePoint now);
  void Handle(const PeerMessage& message, TimePoint now);
  void OnHello(const PeerId& peer, const proto::Hello& hello, TimePoint now);
  void OnResult(InstanceId worker, proto::LeaseResult message);
  // Why this worker may not work here; "" when it may.
  std::string ReasonToRefuse(const proto::Hello& hello) const;
  void GiveLeases(TimePoint now);
  void ForgetSpec(RunId run);
  // False when a lease could not be delivered: others may take it.
  bool Perform(const SchedulerOrders& orders);
  void GiveUp(const RunGivenUp& order);
  void SendHeartbeats(TimePoint now);
  SendOutcome SendTo(InstanceId worker, std::string_view bytes);
  void SendAcknowledgements(Connection& connection);
  WaitOutcome WaitForSomething(std::chrono::milliseconds timeout, bool watch);
  void Disconnect(InstanceId worker);
  std::string LabelOf(InstanceId worker) const;
  // An event, its text made fit for one line.
  void Report(std::string kind, const std::string& text);
  void ReportRefusal(const std::string& label, const std::string& reason, TimePoint now);
  void Reject(const std::string& kind, const std::string& text);

  CampaignIdentity identity_;
  DispatchOptions options_;
  Transport& transport_;
  const Clock& clock_;
  WorkerPool* pool_;
  int watched_fd_ = -1;

  Scheduler scheduler_;
  std::unordered_map<RunId, std::string> specs_;  // of runs that somebody may have to simulate
  std::map<InstanceId, Connection> connections_;
  std::unordered_map<PeerId, InstanceId> instances_;
  ProcessWatch processes_;                               // of the workers on this machine
  std::vector<std::pair<TimePoint, InstanceId>> ended_;  // with the time until which they may be heard
  std::vector<FinishedRun> finished_;
  std::vector<DispatchEvent> events_;
  std::optional<Error> pool_error_;

  TimePoint next_heartbeat_{};
  TimePoint next_supervision_{};
  TimePoint next_look_{};
  std::uint64_t heartbeats_ = 0;
  bool shutting_down_ = false;
  std::uint64_t rejected_ = 0;
  std::uint64_t refused_ = 0;
  std::string last_refusal_;
  int refusals_told_ = 0;
  TimePoint refusals_told_since_{};
  std::uint64_t refusals_untold_ = 0;
  std::set<std::string> rejected_kinds_;  // already reported
  TransportRejections reported_rejections_;
  // Kept to reuse their memory.
  std::vector<PeerMessage> inbox_;
  std::vector<int> wait_fds_;
};

}  // namespace gauntlet::master
