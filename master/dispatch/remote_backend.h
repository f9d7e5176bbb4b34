// EvaluationBackend over worker processes: joins the pure Scheduler with a Transport, a Clock and, when the
// master keeps its own workers, a WorkerPool.
#pragma once

#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/dispatch_log.h"
#include "master/dispatch/dispatch_options.h"
#include "master/dispatch/evaluation_backend.h"
#include "master/dispatch/leases/scheduler.h"
#include "master/dispatch/pool/worker_pool.h"
#include "master/dispatch/wire/transport.h"
#include "master/dispatch/wire/worker_connections.h"
#include "proto/messages.h"

namespace gauntlet {

// Single-threaded: all input and output happens inside Poll and Shutdown.
class RemoteBackend final : public EvaluationBackend {
 public:
  // `pool` may be null: then workers come from elsewhere. All parts must outlive the backend.
  RemoteBackend(CampaignIdentity identity, const DispatchOptions& options, Transport& transport,
                const Clock& clock, WorkerPool* pool = nullptr);

  // Poll returns early while `fd` is readable; -1 watches nothing.
  void WatchFd(int fd) { watched_fds_[0] = fd; }
  void WatchInput(int fd) override { watched_fds_[1] = fd; }

  void Submit(std::vector<RunRequest> runs) override;
  Result<std::vector<FinishedRun>> Poll(std::chrono::milliseconds timeout) override;
  void Acknowledge(const std::vector<RunId>& runs) override;
  // Gives no more leases, asks all workers to drop what they do and leave; after half of the deadline
  // SIGTERM, after three quarters SIGKILL to the pool. What finished meanwhile comes with the next Poll.
  void Shutdown(std::chrono::milliseconds deadline) override;
  WorkerStatistics Statistics() const override;
  BackendView Describe() const override;
  void StopLeasing() override { scheduler_.StopLeasing(); }
  std::vector<DispatchEvent> TakeEvents() override { return log_.TakeEvents(); }

 private:
  Status Step();
  Status SupervisePool(TimePoint now);
  Status CheckPoolIsOfUse() const;
  void BuryEnded(TimePoint now);
  void ExcuseStarving(TimePoint now);
  PoolView ViewForPool() const;
  bool ReceiveMessages(TimePoint now);
  void Handle(const PeerMessage& message, TimePoint now);
  void OnHello(const PeerId& peer, const proto::Hello& hello, TimePoint now);
  void OnResult(InstanceId worker, proto::LeaseResult message);
  void OnUnreadable(InstanceId worker, const proto::LeaseResult& message, const std::string& why);
  void OnFailure(InstanceId worker, const proto::LeaseResult& message, const proto::RunnerFailure& failure);
  void GiveLeases(TimePoint now);
  // False when a lease could not be delivered: others may take it.
  bool Perform(SchedulerOrders orders);
  void Tell(const SchedulerOrders& orders);
  void GiveUp(const RunGivenUp& order);
  void SendHeartbeats(TimePoint now);
  // Tells the worker how often it is to be heard.
  void Welcome(InstanceId worker, TimePoint now);
  WaitOutcome WaitForSomething(std::chrono::milliseconds timeout, bool watch);
  void CountRejections();

  CampaignIdentity identity_;
  DispatchOptions options_;
  Transport& transport_;
  const Clock& clock_;
  WorkerPool* pool_;
  std::array<int, 2> watched_fds_ = {-1, -1};

  Scheduler scheduler_;
  WorkerConnections workers_;
  DispatchLog log_;
  std::vector<std::pair<TimePoint, InstanceId>> ended_;  // with the time until which they may be heard
  std::vector<FinishedRun> finished_;

  TimePoint next_supervision_{};
  TimePoint next_look_{};
  bool shutting_down_ = false;
  TransportRejections reported_rejections_;
  // Kept to reuse their memory.
  std::vector<PeerMessage> inbox_;
  std::vector<int> wait_fds_;
};

}  // namespace gauntlet
