#include "master/dispatch/remote_backend.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "base/check.h"
#include "base/printable.h"
#include "proto/message_codec.h"
#include "proto/run_codec.h"
#include "proto/run_failure.h"

namespace gauntlet::master {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kBatch = 512;        // messages taken from the socket at once
constexpr int kBatchesPerStep = 8;         // then leases and heartbeats get their turn
constexpr milliseconds kLongestWait{100};  // so that silence and pool deaths are noticed
// Deaths and connections that ask to be admitted are heard of while waiting; with results without pause, so
// often too.
constexpr milliseconds kLookEvery{50};
constexpr std::uint32_t kMaxSlots = 4096;
constexpr std::size_t kMaxEvents = 1000;         // kept until somebody takes them
constexpr std::size_t kLongestHello = 1U << 20;  // bytes; what is longer is not even parsed for a stranger
constexpr int kUnreachableBeats = 2;             // a connection gets this long to come back
// What a process said just before its end, its goodbye above all, is heard first.
constexpr milliseconds kLastWords{200};
constexpr std::size_t kShownBytes = 300;  // of a text that came from a worker
// Workers turned away of which events are made, for each of these times; the others are counted.
constexpr int kRefusalsTold = 10;
constexpr std::chrono::minutes kRefusalsToldFor{1};

// The end of a text, fit for a line of a log or a terminal.
std::string Shorten(std::string_view text) {
  if (text.size() <= kShownBytes) return Printable(text);
  text.remove_prefix(text.size() - kShownBytes);
  const auto in_character = [&text] { return (static_cast<unsigned char>(text.front()) & 0xC0U) == 0x80U; };
  while (!text.empty() && in_character()) text.remove_prefix(1);
  return "..." + Printable(text);
}

// " (run 3, 4, 5, ...)"; "" for none.
std::string ListRuns(const std::vector<RunId>& runs) {
  constexpr std::size_t kShownRuns = 10;
  if (runs.empty()) return "";
  const std::size_t shown = std::min(kShownRuns, runs.size());
  return fmt::format(" (run {}{})",
                     fmt::join(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     shown < runs.size() ? ", ..." : "");
}

Fence FirstFence(std::uint64_t epoch) {
  GAUNTLET_CHECK(epoch >= 1 && epoch < (1ULL << 32), fmt::format("epoch {} does not fit 32 bits", epoch));
  return epoch << 32;
}

std::string EncodedFarewell() {
  return proto::EncodeMasterMessage(proto::Drain{.reason = "the master is leaving", .finish_current = false});
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
      scheduler_(options, FirstFence(identity_.epoch)) {}

void RemoteBackend::Submit(std::vector<RunRequest> runs) {
  scheduler_.BeginBatch();
  for (RunRequest& run : runs) {
    scheduler_.Submit(run.id, run.length);
    specs_.emplace(run.id, std::move(run.spec));
  }
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
    const bool news = watched_fd_ >= 0 && std::find(ready.begin(), ready.end(), watched_fd_) != ready.end();
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
  next_supervision_ = now + kLongestWait;
  pool_->Observe(ViewForPool(), now);
  Result<std::vector<pid_t>> ended = pool_->Supervise(now);
  for (DispatchEvent& event : pool_->TakeEvents()) Report(std::move(event.kind), event.text);
  if (!ended) return ended.error();
  for (const pid_t pid : *ended) {
    // Should a worker elsewhere have the same pid, it is taken back at its next heartbeat.
    for (const auto& [worker, connection] : connections_) {
      if (connection.pid == pid) scheduler_.WorkerDied(worker);
    }
  }
  return Ok{};
}

// On a machine with far more to do than it can, a worker may get no turn for seconds.
void RemoteBackend::ExcuseStarving(TimePoint now) {
  for (const InstanceId worker : scheduler_.Silent(now)) {
    if (processes_.WaitsForProcessor(worker)) scheduler_.Excuse(worker);
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
  for (const auto& [worker, described] : scheduler_.DescribeWorkers()) {
    if (described.lost) continue;
    const auto connection = connections_.find(worker);
    if (connection == connections_.end()) continue;
    view.workers.push_back({connection->second.allocation, !described.leases.empty()});
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
  if (message.bytes.size() > kLongestHello && !instances_.contains(message.peer)) {
    Reject("long-stranger",
           fmt::format("a peer that has not said hello sent {} bytes", message.bytes.size()));
    return;
  }
  Result<proto::WorkerMessage> decoded = proto::DecodeWorkerMessage(message.bytes);
  if (!decoded) {
    Reject("unreadable",
           fmt::format("a message of {} bytes {}", message.bytes.size(), decoded.error().message));
    return;
  }
  if (const auto* hello = std::get_if<proto::Hello>(&*decoded)) {
    OnHello(message.peer, *hello, now);
    return;
  }
  const auto instance = instances_.find(message.peer);
  if (instance == instances_.end()) {
    Reject("stranger", "a peer that has not said hello sent a message");
    return;
  }
  const InstanceId worker = instance->second;
  scheduler_.WorkerHeard(worker, now);
  if (const auto* heartbeat = std::get_if<proto::Heartbeat>(&*decoded)) {
    scheduler_.WorkerHeartbeat(worker, heartbeat->held_leases, now);
  } else if (auto* result = std::get_if<proto::LeaseResult>(&*decoded)) {
    OnResult(worker, std::move(*result));
  } else if (const auto* drain = std::get_if<proto::Drain>(&*decoded)) {
    scheduler_.WorkerDraining(worker);
    Report("worker-left",
           fmt::format("worker {} wants no more runs: {}", LabelOf(worker), Shorten(drain->reason)));
  } else if (const auto* goodbye = std::get_if<proto::Goodbye>(&*decoded)) {
    Report("worker-left", fmt::format("worker {} left: {}", LabelOf(worker), Shorten(goodbye->reason)));
    scheduler_.WorkerLeft(worker);
    Disconnect(worker);
  }
}

std::string RemoteBackend::ReasonToRefuse(const proto::Hello& hello) const {
  if (hello.protocol_version != proto::kProtocolVersion) {
    return fmt::format(
        "this worker speaks protocol version {}, this master speaks {}: use gauntlet-worker {}",
        hello.protocol_version, proto::kProtocolVersion, identity_.software_version);
  }
  if (hello.campaign_id != identity_.campaign_id) {
    return fmt::format("this worker belongs to campaign '{}', this master serves campaign '{}'",
                       Shorten(hello.campaign_id), identity_.campaign_id);
  }
  if (hello.software_version != identity_.software_version) {
    return fmt::format("this worker has software version {}, this master has {}",
                       Shorten(hello.software_version), identity_.software_version);
  }
  if (const auto difference = proto::FirstDifference(identity_.golden_hashes, hello.golden_hashes)) {
    if (!difference->offered) {
      return fmt::format("this worker was built without the controller '{}', which the campaign uses",
                         difference->controller);
    }
    return fmt::format(
        "this worker's golden hash of controller '{}' is {:016x}, the campaign's is {:016x}: the same runs "
        "end differently on its machine, so its results cannot be mixed with the others",
        difference->controller, *difference->offered, difference->needed);
  }
  if (hello.instance_id == 0) return "this worker has instance id 0; it must be a random number";
  if (hello.slots < 1 || hello.slots > kMaxSlots) {
    return fmt::format("this worker has {} slots; 1 to {} are possible", hello.slots, kMaxSlots);
  }
  return "";
}

void RemoteBackend::OnHello(const PeerId& peer, const proto::Hello& hello, TimePoint now) {
  const std::string label = fmt::format("{:016x}@{}", hello.instance_id, Shorten(hello.process.host));
  if (const std::string reason = ReasonToRefuse(hello); !reason.empty()) {
    transport_.Send(peer, proto::EncodeMasterMessage(proto::Refused{reason}));
    ReportRefusal(label, reason, now);
    return;
  }
  const auto other = instances_.find(peer);
  if (other != instances_.end() && other->second != hello.instance_id) {
    // One connection cannot speak for two workers; the former instance cannot be answered any more.
    const InstanceId former = other->second;
    scheduler_.WorkerLeft(former);
    Disconnect(former);
  }
  const bool known = connections_.contains(hello.instance_id);
  Connection& connection = connections_[hello.instance_id];
  // Said again before our welcome arrived: what was leased meanwhile is on its way, not lost.
  const bool repeated = known && connection.peer == peer;
  if (known && !repeated) instances_.erase(connection.peer);
  connection.peer = peer;
  connection.label = label;
  connection.pid = hello.process.pid;
  connection.allocation = Shorten(hello.allocation);
  connection.unreachable = 0;
  instances_[peer] = hello.instance_id;
  processes_.Watch(hello.instance_id, hello.process);
  transport_.Send(peer, proto::EncodeMasterMessage(proto::Welcome{options_.heartbeat, identity_.epoch,
                                                                  options_.cpu_limit_seconds,
                                                                  options_.memory_limit_bytes}));
  if (!repeated || !scheduler_.WorkerHeartbeat(hello.instance_id, hello.held_leases, now)) {
    scheduler_.WorkerJoined(hello.instance_id, hello.slots, hello.held_leases, now);
  }
  if (shutting_down_) transport_.Send(peer, EncodedFarewell());
  if (repeated) return;
  Report("worker-joined", fmt::format("worker {} (pid {}, slots {}) {}", label, hello.process.pid,
                                      hello.slots, known ? "is back" : "joined"));
}

void RemoteBackend::OnResult(InstanceId worker, proto::LeaseResult message) {
  if (shutting_down_) {
    // Nobody will store it any more, and the worker waits for an answer before it leaves.
    SendTo(worker, proto::EncodeMasterMessage(proto::Acknowledge{{message.fence}}));
    return;
  }
  std::optional<sim::RunResult> result;
  if (!message.failure) {
    Result<sim::RunResult> decoded = proto::DecodeRunResult(message.result);
    if (decoded) {
      result = std::move(*decoded);
    } else {
      message.failure = proto::RunnerFailure{proto::FailureKind::kUnreadable, 0, 0, decoded.error().message};
    }
  }

  if (!result) {
    const Answer answer = scheduler_.Failed(worker, message.fence, message.run_id, *message.failure);
    if (answer == Answer::kUnwanted) ForgetSpec(message.run_id);
    if (answer == Answer::kRejected) {
      Reject("lease", fmt::format("worker {} reported on a lease that is not its own", LabelOf(worker)));
    } else if (answer == Answer::kAccepted) {
      const proto::RunnerFailure& failure = *message.failure;
      const bool own = failure.kind != proto::FailureKind::kExternal;
      Report(own ? "runner-failure" : "run-returned",
             fmt::format("run {} {} on worker {} (lease {:x}){}{}", message.run_id, proto::Describe(failure),
                         LabelOf(worker), message.fence, failure.stderr_tail.empty() ? "" : ": ",
                         Shorten(failure.stderr_tail)));
    }
    return;
  }

  switch (scheduler_.Completed(worker, message.fence, message.run_id, result->hash)) {
    case Answer::kAccepted: {
      scheduler_.RunTook(message.cpu_seconds);
      const std::uint32_t attempt = std::max(1U, scheduler_.LeasesOf(message.run_id));
      // What arrived is stored as it came: decoding has checked it against its hash.
      const bool as_it_came = result->trajectory.empty() && result->cpu_seconds > 0.0;
      result->trajectory.clear();
      if (result->cpu_seconds == 0.0) result->cpu_seconds = message.cpu_seconds;
      finished_.push_back({message.run_id, std::move(*result), {}, LabelOf(worker), attempt, {}});
      FinishedRun& finished = finished_.back();
      finished.encoded = as_it_came ? std::move(message.result) : proto::EncodeRunResult(finished.result);
      ForgetSpec(message.run_id);
      break;
    }
    case Answer::kRejected:
      Reject("lease", fmt::format("worker {} answered a lease that is not its own", LabelOf(worker)));
      break;
    default:
      ForgetSpec(message.run_id);
      break;  // counted by the scheduler
  }
}

// Unless somebody may have to simulate it yet.
void RemoteBackend::ForgetSpec(RunId run) {
  if (scheduler_.Wanted(run)) return;
  specs_.erase(run);
}

void RemoteBackend::GiveLeases(TimePoint now) {
  // Ends: a worker that cannot be reached gets no second lease before it is heard of again.
  while (!Perform(scheduler_.Decide(now))) continue;
}

bool RemoteBackend::Perform(const SchedulerOrders& orders) {
  for (const WorkerLost& lost : orders.lost) {
    Report("worker-lost", fmt::format("worker {} is lost; {} of its runs wait for another worker{}",
                                      LabelOf(lost.worker), lost.released.size(), ListRuns(lost.released)));
  }
  for (const InstanceId worker : orders.back)
    Report("worker-back", fmt::format("worker {} was lost and is heard again", LabelOf(worker)));
  for (const ResultMismatch& mismatch : orders.mismatches) {
    Report("nondeterministic",
           fmt::format("run {} ended differently on two workers: {} gave {:016x}, {} gave {:016x}",
                       mismatch.run, LabelOf(mismatch.first_worker), mismatch.first_hash,
                       LabelOf(mismatch.second_worker), mismatch.second_hash));
  }
  for (const RunGivenUp& order : orders.given_up) GiveUp(order);
  for (const FenceOrder& cancel : orders.cancels)
    SendTo(cancel.worker, proto::EncodeMasterMessage(proto::Cancel{cancel.fence}));

  for (const FenceOrder& order : orders.acknowledgements) {
    const auto connection = connections_.find(order.worker);
    if (connection != connections_.end()) connection->second.acknowledged.push_back(order.fence);
  }

  bool delivered = true;
  for (const LeaseOrder& lease : orders.leases) {
    const proto::Lease message{lease.fence, lease.run, specs_.at(lease.run), lease.attempt};
    if (SendTo(lease.worker, proto::EncodeMasterMessage(message)) == SendOutcome::kSent) continue;
    scheduler_.Undelivered(lease.fence);
    delivered = false;
  }
  for (const FenceOrder& order : orders.acknowledgements) {
    const auto connection = connections_.find(order.worker);
    if (connection != connections_.end() && !scheduler_.Works(order.worker)) {
      SendAcknowledgements(connection->second);
    }
  }
  for (const InstanceId worker : orders.forgotten) Disconnect(worker);
  return delivered;
}

void RemoteBackend::GiveUp(const RunGivenUp& order) {
  FinishedRun run;
  run.id = order.run;
  run.result = ResultOf(order.last);
  run.encoded = proto::EncodeRunResult(run.result);
  run.worker = LabelOf(order.worker);
  run.attempt = order.leases;
  run.stderr_tail = order.last.stderr_tail;
  Report("run-given-up", fmt::format("run {} {} in {} of {} attempts", order.run, run.result.message,
                                     order.of_last_kind, order.attempts));
  finished_.push_back(std::move(run));
  ForgetSpec(order.run);
}

void RemoteBackend::SendHeartbeats(TimePoint now) {
  if (now < next_heartbeat_) return;
  next_heartbeat_ = now + options_.heartbeat;
  const std::string heartbeat = proto::EncodeMasterMessage(proto::Heartbeat{++heartbeats_, {}});
  for (auto& [worker, connection] : connections_) {
    SendAcknowledgements(connection);
    const bool reached = transport_.Send(connection.peer, heartbeat) != SendOutcome::kUnreachable;
    connection.unreachable = reached ? 0 : connection.unreachable + 1;
    if (connection.unreachable >= kUnreachableBeats) scheduler_.WorkerDied(worker);
  }
}

SendOutcome RemoteBackend::SendTo(InstanceId worker, std::string_view bytes) {
  const auto connection = connections_.find(worker);
  if (connection == connections_.end()) return SendOutcome::kUnreachable;
  SendAcknowledgements(connection->second);
  return transport_.Send(connection->second.peer, bytes);
}

void RemoteBackend::SendAcknowledgements(Connection& connection) {
  if (connection.acknowledged.empty()) return;
  transport_.Send(connection.peer, proto::EncodeMasterMessage(proto::Acknowledge{connection.acknowledged}));
  connection.acknowledged.clear();
}

WaitOutcome RemoteBackend::WaitForSomething(milliseconds timeout, bool watch) {
  wait_fds_.clear();
  if (watch && watched_fd_ >= 0) wait_fds_.push_back(watched_fd_);
  if (processes_.fd() >= 0) wait_fds_.push_back(processes_.fd());
  const std::size_t others = wait_fds_.size();
  if (pool_ != nullptr) pool_->AppendWaitFds(wait_fds_);
  WaitOutcome outcome = transport_.Wait(timeout, wait_fds_);
  next_look_ = clock_.Now() + kLookEvery;
  for (const int fd : outcome.ready_fds) {
    if (fd == processes_.fd()) {
      const TimePoint heard_until = clock_.Now() + kLastWords;
      for (const InstanceId worker : processes_.TakeEnded()) ended_.emplace_back(heard_until, worker);
    }
    const auto pool_fds = wait_fds_.begin() + static_cast<std::ptrdiff_t>(others);
    if (std::find(pool_fds, wait_fds_.end(), fd) != wait_fds_.end()) next_supervision_ = TimePoint{};
  }
  const TransportRejections rejections = transport_.Rejections();
  const auto count = [this](std::uint64_t now, std::uint64_t& before, const char* kind, const char* text) {
    for (; before < now; ++before) Reject(kind, text);
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
  return outcome;
}

void RemoteBackend::Shutdown(milliseconds deadline) {
  const TimePoint start = clock_.Now();
  scheduler_.StopLeasing();
  if (pool_ != nullptr) pool_->StopReplacing();
  GiveLeases(start);  // none are given, but what was acknowledged last is sent
  shutting_down_ = true;
  const std::string farewell = EncodedFarewell();
  for (const auto& [worker, connection] : connections_) SendTo(worker, farewell);

  // Goodbye, then SIGTERM, then SIGKILL; each stage ends early when there is nobody left.
  const auto pool_runs = [this] { return pool_ != nullptr && pool_->running() > 0; };
  const auto wait_until = [this](TimePoint until, const auto& somebody) {
    while (true) {
      next_supervision_ = TimePoint{};
      if (Status stepped = Step(); !stepped) Report("worker-died", stepped.error().message);
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

void RemoteBackend::Disconnect(InstanceId worker) {
  const auto connection = connections_.find(worker);
  if (connection == connections_.end()) return;
  const auto instance = instances_.find(connection->second.peer);
  if (instance != instances_.end() && instance->second == worker) instances_.erase(instance);
  processes_.Forget(worker);
  connections_.erase(connection);
}

std::string RemoteBackend::LabelOf(InstanceId worker) const {
  const auto connection = connections_.find(worker);
  return connection == connections_.end() ? fmt::format("{:016x}", worker) : connection->second.label;
}

WorkerStatistics RemoteBackend::Statistics() const {
  WorkerStatistics statistics = scheduler_.Statistics();
  statistics.rejected_messages = rejected_;
  return statistics;
}

BackendView RemoteBackend::Describe() const {
  BackendView view;
  view.queued = scheduler_.queued();
  view.refused_workers = refused_;
  view.last_refusal = last_refusal_;
  view.unknown_keys = reported_rejections_.keys;
  view.failed_handshakes = reported_rejections_.handshakes;
  for (auto& [worker, described] : scheduler_.DescribeWorkers()) {
    const auto connection = connections_.find(worker);
    described.label = LabelOf(worker);
    if (connection != connections_.end()) {
      described.pid = connection->second.pid;
      described.allocation = connection->second.allocation;
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

std::vector<DispatchEvent> RemoteBackend::TakeEvents() {
  return std::exchange(events_, {});
}

void RemoteBackend::Report(std::string kind, const std::string& text) {
  if (events_.size() >= kMaxEvents) events_.erase(events_.begin(), events_.begin() + kMaxEvents / 2);
  events_.push_back({std::move(kind), Printable(text)});
}

void RemoteBackend::ReportRefusal(const std::string& label, const std::string& reason, TimePoint now) {
  ++refused_;
  last_refusal_ = reason;
  if (refusals_told_ == 0 || now >= refusals_told_since_ + kRefusalsToldFor) {
    refusals_told_ = 0;
    refusals_told_since_ = now;
  }
  if (refusals_told_ == kRefusalsTold) {
    ++refusals_untold_;
    return;
  }
  ++refusals_told_;
  const std::uint64_t untold = std::exchange(refusals_untold_, 0);
  Report(
      "worker-refused",
      fmt::format("worker {} was refused: {}{}", label, reason,
                  untold == 0 ? "" : fmt::format(" (and {} others since the last that was told)", untold)));
}

void RemoteBackend::Reject(const std::string& kind, const std::string& text) {
  ++rejected_;
  if (rejected_kinds_.insert(kind).second) {
    Report("rejected-message", text + "; it was dropped, and so will others of its kind without a word");
  }
}

}  // namespace gauntlet::master
