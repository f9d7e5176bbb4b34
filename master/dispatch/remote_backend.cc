#include "master/dispatch/remote_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <limits>

#include "base/check.h"
#include "master/dispatch/wire/admission.h"
#include "proto/message_codec.h"
#include "proto/run_codec.h"
#include "proto/run_failure.h"
#include "proto/run_text.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kBatch = 512;           // messages taken from the socket at once
constexpr int kBatchesPerStep = 8;            // then leases and heartbeats get their turn
constexpr milliseconds kLongestWait{200};     // so that silence is noticed
constexpr milliseconds kSuperviseEvery{100};  // at most; deaths in the pool are heard of at once
// Deaths and connections that ask to be admitted are heard of while waiting; with results without pause, so
// often too.
constexpr milliseconds kLookEvery{50};
constexpr int kBeatsPerSignOfLife = 30;  // that could have come of a connection before it is asked
constexpr int kManyGreetings = 32;
constexpr std::size_t kLongestHello = 1U << 20;  // bytes; what is longer is not even parsed for a stranger
// What a process said just before its end, its goodbye above all, is heard first.
constexpr milliseconds kLastWords{200};

// " (run 3 to 5)"; "" for none.
std::string ListRuns(const std::vector<RunId>& runs) {
  return runs.empty() ? "" : fmt::format(" (run {})", proto::RunRanges(runs));
}

Fence FirstFence(std::uint64_t epoch) {
  GAUNTLET_CHECK(epoch >= 1 && epoch < (1ULL << 32), fmt::format("epoch {} does not fit 32 bits", epoch));
  return epoch << 32;
}

proto::Drain Farewell() {
  return {.reason = "the master is leaving", .finish_current = false};
}

milliseconds RoundUp(Duration duration) {
  return std::chrono::ceil<milliseconds>(std::max(duration, Duration::zero()));
}

}  // namespace

RemoteBackend::RemoteBackend(CampaignIdentity identity, const DispatchOptions& options, Transport& transport,
                             const Clock& clock, WorkerPool* pool)
    : identity_(std::move(identity)),
      options_(options),
      transport_(transport),
      clock_(clock),
      pool_(pool),
      scheduler_(options, FirstFence(identity_.epoch)),
      workers_(transport, options.heartbeat) {}

void RemoteBackend::Submit(std::vector<RunRequest> runs) {
  scheduler_.BeginBatch();
  for (RunRequest& run : runs) scheduler_.Submit(std::move(run));
}

void RemoteBackend::Acknowledge(const std::vector<RunId>& runs) {
  for (const RunId run : runs) scheduler_.Acknowledge(run);
}

Result<std::vector<FinishedRun>> RemoteBackend::Poll(milliseconds timeout) {
  const TimePoint deadline = clock_.Now() + timeout;
  while (true) {
    Status stepped = Step();
    if (!finished_.empty()) {
      if (clock_.Now() >= next_look_) WaitForSomething(milliseconds(0), false);
      break;
    }
    if (!stepped) return stepped.error();
    const TimePoint now = clock_.Now();
    if (now >= deadline) break;
    const WaitOutcome outcome = WaitForSomething(std::min(RoundUp(deadline - now), kLongestWait), true);
    const std::vector<int>& ready = outcome.ready_fds;
    const bool news = std::ranges::any_of(
        watched_fds_, [&ready](int fd) { return fd >= 0 && std::ranges::find(ready, fd) != ready.end(); });
    if (outcome.woken || news) break;
  }
  return std::exchange(finished_, {});
}

Status RemoteBackend::Step() {
  const TimePoint now = clock_.Now();
  Status supervised = SupervisePool(now);
  for (int batch = 0; batch < kBatchesPerStep && ReceiveMessages(now); ++batch) continue;
  BuryEnded(now);
  ExcuseStarving(now);
  SendHeartbeats(now);
  GiveLeases(now);
  return supervised;
}

Status RemoteBackend::SupervisePool(TimePoint now) {
  if (pool_ == nullptr || now < next_supervision_) return Ok{};
  next_supervision_ = now + kSuperviseEvery;
  pool_->Observe(ViewForPool(), now);
  Result<std::vector<pid_t>> ended = pool_->Supervise(now);
  for (DispatchEvent& event : pool_->TakeEvents()) log_.Report(std::move(event.kind), event.text);
  if (!ended) return ended.error();
  for (const pid_t pid : *ended) {
    // Should a worker elsewhere have the same pid, it is taken back at its next heartbeat.
    for (const auto& [id, worker] : workers_.all()) {
      if (worker.pid == pid) ended_.emplace_back(now + kLastWords, id);
    }
  }
  return CheckPoolIsOfUse();
}

// Workers that this master keeps running itself, all of them quarantined, will do nothing for ever.
Status RemoteBackend::CheckPoolIsOfUse() const {
  if (shutting_down_ || !pool_->OnThisMachine() || scheduler_.unfinished() == 0) return Ok{};
  const int own = pool_->running();
  if (own == 0 || !scheduler_.AllQuarantined() || scheduler_.Statistics().quarantined < own) return Ok{};
  std::string reasons;
  for (const auto& [worker, described] : scheduler_.DescribeWorkers()) {
    if (!described.record.quarantined || described.lost || !reasons.empty()) continue;
    reasons = fmt::format("of worker {}, {}", workers_.LabelOf(worker), InWords(described.record));
  }
  return Error{
      ErrorKind::kIo,
      fmt::format("all {} workers on this machine are quarantined, and nobody is left to do {} runs: {}", own,
                  scheduler_.unfinished(), reasons)};
}

// On a machine with far more to do than it can, a worker may get no turn for seconds; and where a crowd
// connects at once, what is said waits behind thousands of handshakes.
void RemoteBackend::ExcuseStarving(TimePoint now) {
  for (const InstanceId worker : scheduler_.Silent(now)) {
    if (transport_.Greeting() > kManyGreetings || workers_.processes().WaitsForProcessor(worker))
      scheduler_.Excuse(worker);
  }
}

void RemoteBackend::BuryEnded(TimePoint now) {
  while (!ended_.empty() && ended_.front().first <= now) {
    scheduler_.WorkerDied(ended_.front().second);
    ended_.erase(ended_.begin());
  }
}

PoolView RemoteBackend::ViewForPool() const {
  PoolView view;
  view.unfinished_runs = shutting_down_ ? 0 : static_cast<int>(scheduler_.unfinished());
  // What is simulated once more to learn about a program is not behind other runs, and is waited for.
  if (!shutting_down_ && options_.reproducible != Reproducible::kPromised)
    view.unfinished_runs += static_cast<int>(scheduler_.Statistics().audits_open);
  for (const auto& [id, worker] : workers_.all()) {
    if (scheduler_.Connected(id)) view.workers.push_back({worker.allocation, scheduler_.Works(id)});
  }
  return view;
}

bool RemoteBackend::ReceiveMessages(TimePoint now) {
  inbox_.clear();
  transport_.Receive(kBatch, inbox_);
  for (const PeerMessage& message : inbox_) Handle(message, now);
  return inbox_.size() == kBatch;
}

void RemoteBackend::Handle(const PeerMessage& message, TimePoint now) {
  const std::optional<InstanceId> speaker = workers_.SpeakerOf(message.peer);
  if (message.bytes.size() > kLongestHello && !speaker) {
    log_.Reject("long-stranger",
                fmt::format("a peer that has not said hello sent {} bytes", message.bytes.size()));
    return;
  }
  Result<proto::WorkerMessage> decoded = proto::DecodeWorkerMessage(message.bytes);
  if (!decoded) {
    log_.Reject("unreadable",
                fmt::format("a message of {} bytes {}", message.bytes.size(), decoded.error().message));
    return;
  }
  if (const auto* hello = std::get_if<proto::Hello>(&*decoded)) {
    OnHello(message.peer, *hello, now);
    return;
  }
  if (!speaker) {
    log_.Reject("stranger", "a peer that has not said hello sent a message");
    return;
  }
  const InstanceId worker = *speaker;
  scheduler_.WorkerHeard(worker, now);
  if (const auto* heartbeat = std::get_if<proto::Heartbeat>(&*decoded)) {
    scheduler_.WorkerHeartbeat(worker, heartbeat->held_leases, now);
  } else if (auto* result = std::get_if<proto::LeaseResult>(&*decoded)) {
    OnResult(worker, std::move(*result));
  } else if (const auto* drain = std::get_if<proto::Drain>(&*decoded)) {
    scheduler_.WorkerDraining(worker);
    log_.Report(event::kWorkerLeft, fmt::format("worker {} wants no more runs: {}", workers_.LabelOf(worker),
                                                Shorten(drain->reason)));
  } else if (const auto* goodbye = std::get_if<proto::Goodbye>(&*decoded)) {
    log_.Report(event::kWorkerLeft,
                fmt::format("worker {} left: {}", workers_.LabelOf(worker), Shorten(goodbye->reason)));
    scheduler_.WorkerLeft(worker);
    workers_.Disconnect(worker);
  }
}

void RemoteBackend::OnHello(const PeerId& peer, const proto::Hello& hello, TimePoint now) {
  if (const std::optional<Refusal> refusal = ReasonToRefuse(hello, identity_)) {
    const std::string& told = transport_.KnowsItsPeers() ? refusal->reason : refusal->for_strangers;
    transport_.Send(peer, proto::EncodeMasterMessage(proto::Refused{told}));
    log_.Refuse(LabelOf(hello), refusal->reason, now);
    return;
  }
  if (const auto former = workers_.SpeakerOf(peer); former && *former != hello.instance_id) {
    // One connection cannot speak for two workers; the former instance cannot be answered any more.
    scheduler_.WorkerLeft(*former);
    workers_.Disconnect(*former);
  }
  const WorkerConnections::Arrival arrival = workers_.Accept(peer, hello);
  // What was leased since a repeated hello is on its way, not lost.
  const bool repeated = arrival == WorkerConnections::Arrival::kRepeated;
  Welcome(hello.instance_id, now);
  if (!repeated || !scheduler_.WorkerHeartbeat(hello.instance_id, hello.held_leases, now)) {
    scheduler_.WorkerJoined(hello.instance_id, hello.slots, hello.held_leases, now, hello.process.host);
  }
  scheduler_.WorkerPaced(hello.instance_id, workers_.LongestPace(hello.instance_id));
  if (shutting_down_) transport_.Send(peer, proto::EncodeMasterMessage(Farewell()));
  if (repeated) return;
  log_.Report(event::kWorkerJoined,
              fmt::format("worker {} (pid {}, slots {}) {}", LabelOf(hello), hello.process.pid, hello.slots,
                          arrival == WorkerConnections::Arrival::kBack ? "is back" : "joined"));
}

void RemoteBackend::OnResult(InstanceId worker, proto::LeaseResult message) {
  if (shutting_down_) {
    // Nobody will store it any more, and the worker waits for an answer before it leaves.
    workers_.Send(worker, proto::Acknowledge{{message.fence}});
    return;
  }
  if (message.failure) {
    OnFailure(worker, message, *message.failure);
    return;
  }
  Result<sim::RunResult> result = proto::DecodeRunResult(message.result);
  if (!result) {
    OnUnreadable(worker, message, result.error().message);
    return;
  }
  if (result->without_ways && !options_.without_ways) {
    OnUnreadable(worker, message, "its waypoints and annotations are left out");
    return;
  }
  // The kernel would have ended it before.
  constexpr double kMargin = 60.0;  // s
  const double most = options_.cpu_limit_seconds > 0.0 ? options_.cpu_limit_seconds + kMargin
                                                       : std::numeric_limits<double>::max();
  for (const double seconds : {message.cpu_seconds, result->cpu_seconds}) {
    if (seconds >= 0.0 && seconds <= most) continue;
    OnUnreadable(worker, message, fmt::format("{} s of CPU time, 0 to {} can be", seconds, most));
    return;
  }
  const Answer answer = scheduler_.Completed(worker, message.fence, message.run_id, result->hash,
                                             result->verdict == sim::Verdict::kCompleted);
  if (answer == Answer::kRejected) {
    const std::string& label = workers_.LabelOf(worker);
    log_.Reject("lease " + label, fmt::format("worker {} answered a lease that is not its own", label));
  }
  if (answer != Answer::kAccepted) return;  // the scheduler counts what was not needed
  scheduler_.RunTook(message.cpu_seconds);
  result->trajectory.clear();
  if (result->cpu_seconds == 0.0) result->cpu_seconds = message.cpu_seconds;
  log_.Ended(message.run_id);
  FinishedRun& finished = finished_.emplace_back();
  finished.id = message.run_id;
  finished.result = std::move(*result);
  finished.worker = workers_.LabelOf(worker);
  finished.attempt = std::max(1U, scheduler_.LeasesOf(message.run_id));
}

void RemoteBackend::OnUnreadable(InstanceId worker, const proto::LeaseResult& message,
                                 const std::string& why) {
  scheduler_.Unreadable(worker, message.fence, message.run_id);
  const std::string& label = workers_.LabelOf(worker);
  log_.Reject("result " + label,
              fmt::format("worker {} gave a result of run {} (lease {:x}) that cannot be read ({})", label,
                          proto::RunText(message.run_id), message.fence, Shorten(why)));
}

void RemoteBackend::OnFailure(InstanceId worker, const proto::LeaseResult& message,
                              const proto::RunnerFailure& failure) {
  const Answer answer = scheduler_.Failed(worker, message.fence, message.run_id, failure);
  if (answer == Answer::kRejected) {
    const std::string& label = workers_.LabelOf(worker);
    log_.Reject("lease " + label, fmt::format("worker {} reported on a lease that is not its own", label));
  } else if (answer == Answer::kAccepted) {
    const bool own = failure.kind != proto::FailureKind::kExternal;
    log_.Failed(message.run_id, own ? event::kRunnerFailure : event::kRunReturned, proto::Describe(failure),
                fmt::format(" on worker {} (lease {:x}){}{}", workers_.LabelOf(worker), message.fence,
                            failure.stderr_tail.empty() ? "" : ": ", Shorten(failure.stderr_tail)));
  }
}

void RemoteBackend::GiveLeases(TimePoint now) {
  // Ends: a worker that cannot be reached gets no second lease before it is heard of again.
  while (!Perform(scheduler_.Decide(now))) continue;
}

bool RemoteBackend::Perform(SchedulerOrders orders) {
  Tell(orders);
  for (const RunGivenUp& order : orders.given_up) GiveUp(order);
  for (const FenceOrder& cancel : orders.cancels) workers_.Send(cancel.worker, proto::Cancel{cancel.fence});
  for (const FenceOrder& order : orders.acknowledgements) workers_.Acknowledge(order.worker, order.fence);

  bool delivered = true;
  for (LeaseOrder& order : orders.leases) {
    const Fence fence = order.lease.fence;
    if (workers_.Send(order.worker, std::move(order.lease)) == SendOutcome::kSent) continue;
    scheduler_.Undelivered(fence);
    delivered = false;
  }
  for (const FenceOrder& order : orders.acknowledgements) {
    if (!scheduler_.Works(order.worker)) workers_.SendAcknowledgements(order.worker);
  }
  for (const InstanceId worker : orders.forgotten) workers_.Disconnect(worker);
  return delivered;
}

void RemoteBackend::Tell(const SchedulerOrders& orders) {
  for (const WorkerLost& lost : orders.lost) {
    log_.Report(event::kWorkerLost,
                fmt::format("worker {} is lost; {} of its runs wait for another worker{}",
                            workers_.LabelOf(lost.worker), lost.released.size(), ListRuns(lost.released)));
  }
  for (const InstanceId worker : orders.back) {
    log_.Report(event::kWorkerBack,
                fmt::format("worker {} was lost and is heard again", workers_.LabelOf(worker)));
  }
  for (const WorkerQuarantined& order : orders.quarantined) {
    log_.Report(event::kWorkerQuarantined,
                fmt::format("worker {} is quarantined and gets no more runs: {}",
                            workers_.LabelOf(order.worker), InWords(order.record)));
  }
  for (const ResultMismatch& mismatch : orders.mismatches) {
    log_.Report(
        event::kNondeterministic,
        fmt::format("run {} ended differently on two workers: {} gave {:016x}, {} gave {:016x}",
                    proto::RunText(mismatch.run), workers_.LabelOf(mismatch.first_worker),
                    mismatch.first_hash, workers_.LabelOf(mismatch.second_worker), mismatch.second_hash));
  }
  if (const auto& news = orders.reproducibility) {
    log_.Report(news->state == Reproducible::kYes ? event::kReproducible : event::kNotReproducible,
                news->text);
  }
}

void RemoteBackend::GiveUp(const RunGivenUp& order) {
  log_.Ended(order.run);
  FinishedRun& run = finished_.emplace_back();
  run.id = order.run;
  run.result = ResultOf(order.failure);
  run.worker = workers_.LabelOf(order.worker);
  run.attempt = order.leases;
  run.stderr_tail = order.failure.stderr_tail;
  if (order.first_ending) {
    log_.Report(event::kRunGivenUp,
                fmt::format("run {} {} on worker {}: its first ending counts, because it is not known to be "
                            "reproducible",
                            proto::RunText(order.run), run.result.message, run.worker));
    return;
  }
  const bool alone = order.alone();
  log_.Report(alone ? event::kRunGivenUpAlone : event::kRunGivenUp,
              fmt::format("run {} {} in {} of {} attempts, {}", proto::RunText(order.run), run.result.message,
                          order.alike, order.attempts,
                          alone ? fmt::format("all on worker {}: there was no other to ask", run.worker)
                                : fmt::format("on {} workers", order.workers)));
}

void RemoteBackend::SendHeartbeats(TimePoint now) {
  const WorkerConnections::Beats beats = workers_.SendHeartbeats(now);
  for (const InstanceId worker : beats.out_of_reach) scheduler_.WorkerDied(worker);
  for (const InstanceId worker : beats.out_of_pace) {
    Welcome(worker, now);
    scheduler_.WorkerPaced(worker, workers_.LongestPace(worker));
  }
}

void RemoteBackend::Welcome(InstanceId worker, TimePoint now) {
  const milliseconds pace = workers_.Pace(worker, now);
  transport_.Send(workers_.Find(worker)->peer, proto::EncodeMasterMessage(proto::Welcome{
                                                   pace, identity_.epoch, options_.cpu_limit_seconds,
                                                   options_.memory_limit_bytes, options_.without_ways}));
  transport_.SetSignOfLife(pace * kBeatsPerSignOfLife);
}

WaitOutcome RemoteBackend::WaitForSomething(milliseconds timeout, bool watch) {
  ProcessWatch& processes = workers_.processes();
  wait_fds_.clear();
  for (const int fd : watched_fds_) {
    if (watch && fd >= 0) wait_fds_.push_back(fd);
  }
  if (processes.fd() >= 0) wait_fds_.push_back(processes.fd());
  const std::size_t others = wait_fds_.size();
  if (pool_ != nullptr) pool_->AppendWaitFds(wait_fds_);
  WaitOutcome outcome = transport_.Wait(timeout, wait_fds_);
  next_look_ = clock_.Now() + kLookEvery;
  for (const int fd : outcome.ready_fds) {
    if (fd == processes.fd()) {
      const TimePoint heard_until = clock_.Now() + kLastWords;
      for (const InstanceId worker : processes.TakeEnded()) ended_.emplace_back(heard_until, worker);
    }
    const auto pool_fds = wait_fds_.begin() + static_cast<std::ptrdiff_t>(others);
    if (std::find(pool_fds, wait_fds_.end(), fd) != wait_fds_.end()) next_supervision_ = TimePoint{};
  }
  CountRejections();
  return outcome;
}

void RemoteBackend::CountRejections() {
  const TransportRejections rejections = transport_.Rejections();
  const auto count = [this](std::uint64_t now, std::uint64_t& before, const char* kind, const char* text) {
    for (; before < now; ++before) log_.Reject(kind, text);
  };
  count(rejections.malformed, reported_rejections_.malformed, "malformed",
        "a message was not exactly one frame");
  count(rejections.oversized, reported_rejections_.oversized, "oversized",
        "a message was longer than allowed");
  count(rejections.handshakes, reported_rejections_.handshakes, "handshake",
        "a connection did not get through ZeroMQ's greeting: it has no keys or those of another master, or "
        "speaks something else");
  count(rejections.keys, reported_rejections_.keys, "keys",
        "a connection's keys are not the campaign's: its access.json is another campaign's, or older than a "
        "change of keys");
  count(rejections.silent, reported_rejections_.silent, "silent",
        "a connection said nothing, and there were so many of its kind that workers could not have got in");
}

void RemoteBackend::Shutdown(milliseconds deadline) {
  const TimePoint start = clock_.Now();
  scheduler_.StopLeasing();
  if (pool_ != nullptr) pool_->StopReplacing();
  GiveLeases(start);  // none are given, but what was acknowledged last is sent
  shutting_down_ = true;
  for (const auto& [id, worker] : workers_.all()) workers_.Send(id, Farewell());

  // Goodbye, then SIGTERM, then SIGKILL; each stage ends early when there is nobody left.
  const auto pool_runs = [this] { return pool_ != nullptr && pool_->running() > 0; };
  const auto wait_until = [this](TimePoint until, const auto& somebody) {
    while (true) {
      next_supervision_ = TimePoint{};
      if (Status stepped = Step(); !stepped) log_.Report(event::kWorkerDied, stepped.error().message);
      const TimePoint now = clock_.Now();
      if (!somebody() || now >= until) return;
      WaitForSomething(std::min(RoundUp(until - now), kLongestWait), false);
    }
  };
  wait_until(start + deadline / 2, [this] { return scheduler_.Statistics().connected > 0; });
  if (pool_runs()) {
    pool_->SignalAll(SIGTERM);
    wait_until(start + deadline * 3 / 4, pool_runs);
  }
  if (pool_runs()) {
    pool_->SignalAll(SIGKILL);
    wait_until(start + deadline, pool_runs);
  }
}

WorkerStatistics RemoteBackend::Statistics() const {
  WorkerStatistics statistics = scheduler_.Statistics();
  statistics.rejected_messages = log_.rejected();
  return statistics;
}

BackendView RemoteBackend::Describe() const {
  BackendView view;
  view.queued = scheduler_.queued();
  view.refused_workers = log_.refused();
  view.last_refusal = log_.last_refusal();
  view.unknown_keys = reported_rejections_.keys;
  view.failed_handshakes = reported_rejections_.handshakes;
  for (auto& [worker, described] : scheduler_.DescribeWorkers()) {
    described.label = workers_.LabelOf(worker);
    if (const WorkerConnections::Worker* known = workers_.Find(worker)) {
      described.pid = known->pid;
      described.allocation = known->allocation;
    }
    view.workers.push_back(std::move(described));
  }
  if (pool_ != nullptr) {
    view.allocations = pool_->Allocations();
    view.pool_trouble = pool_->Trouble(clock_.Now());
    view.own_workers = pool_->running();
  }
  return view;
}

}  // namespace gauntlet
