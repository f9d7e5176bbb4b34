#include "master/dispatch/wire/worker_connections.h"

#include <fmt/format.h>

#include <algorithm>

#include "master/dispatch/dispatch_log.h"
#include "proto/message_codec.h"

namespace gauntlet {
namespace {

constexpr int kUnreachableBeats = 2;  // a connection gets this long to come back
constexpr int kPartThatMatters = 5;   // of a pace: a worker is told when it has changed by a fifth

}  // namespace

std::string LabelOf(const proto::Hello& hello) {
  return fmt::format("{:016x}@{}", hello.instance_id, Shorten(hello.process.host));
}

std::optional<proto::InstanceId> WorkerConnections::SpeakerOf(const PeerId& peer) const {
  const auto found = speakers_.find(peer);
  return found == speakers_.end() ? std::nullopt : std::optional(found->second);
}

WorkerConnections::Arrival WorkerConnections::Accept(const PeerId& peer, const proto::Hello& hello) {
  const auto [found, added] = workers_.try_emplace(hello.instance_id);
  Worker& worker = found->second;
  const bool repeated = !added && worker.peer == peer;
  if (!added && !repeated) speakers_.erase(worker.peer);
  worker.peer = peer;
  worker.label = gauntlet::LabelOf(hello);
  worker.pid = hello.process.pid;
  worker.allocation = Shorten(hello.allocation);
  worker.unreachable = 0;
  speakers_[peer] = hello.instance_id;
  processes_.Watch(hello.instance_id, hello.process);
  if (added) return Arrival::kNew;
  return repeated ? Arrival::kRepeated : Arrival::kBack;
}

void WorkerConnections::Disconnect(proto::InstanceId worker) {
  const auto found = workers_.find(worker);
  if (found == workers_.end()) return;
  const auto speaker = speakers_.find(found->second.peer);
  if (speaker != speakers_.end() && speaker->second == worker) speakers_.erase(speaker);
  processes_.Forget(worker);
  beats_.erase({found->second.next_beat, worker});
  workers_.erase(found);
}

const WorkerConnections::Worker* WorkerConnections::Find(proto::InstanceId worker) const {
  const auto found = workers_.find(worker);
  return found == workers_.end() ? nullptr : &found->second;
}

std::string WorkerConnections::LabelOf(proto::InstanceId worker) const {
  const Worker* known = Find(worker);
  return known == nullptr ? fmt::format("{:016x}", worker) : known->label;
}

SendOutcome WorkerConnections::Send(proto::InstanceId worker, const proto::MasterMessage& message) {
  const auto found = workers_.find(worker);
  if (found == workers_.end()) return SendOutcome::kUnreachable;
  SendAcknowledgements(found->second);
  return transport_.Send(found->second.peer, proto::EncodeMasterMessage(message));
}

void WorkerConnections::Acknowledge(proto::InstanceId worker, proto::Fence fence) {
  const auto found = workers_.find(worker);
  if (found != workers_.end()) found->second.acknowledged.push_back(fence);
}

void WorkerConnections::SendAcknowledgements(proto::InstanceId worker) {
  const auto found = workers_.find(worker);
  if (found != workers_.end()) SendAcknowledgements(found->second);
}

void WorkerConnections::SendAcknowledgements(Worker& worker) {
  if (worker.acknowledged.empty()) return;
  transport_.Send(worker.peer, proto::EncodeMasterMessage(proto::Acknowledge{worker.acknowledged}));
  worker.acknowledged.clear();
}

std::chrono::milliseconds WorkerConnections::PaceNow() const {
  const auto workers = static_cast<std::int64_t>(workers_.size());
  return std::max(heartbeat_, heartbeat_ * workers / kWorkersPerBeat);
}

std::chrono::milliseconds WorkerConnections::Pace(proto::InstanceId worker, TimePoint now) {
  Worker& one = workers_.at(worker);
  std::shift_right(one.paces.begin(), one.paces.end(), 1);
  one.paces[0] = PaceNow();
  beats_.erase({one.next_beat, worker});
  one.next_beat = now + one.paces[0];
  beats_.insert({one.next_beat, worker});
  return one.paces[0];
}

std::chrono::milliseconds WorkerConnections::LongestPace(proto::InstanceId worker) const {
  return std::ranges::max(workers_.at(worker).paces);
}

WorkerConnections::Beats WorkerConnections::SendHeartbeats(TimePoint now) {
  Beats beats;
  if (beats_.empty() || beats_.begin()->first > now) return beats;
  const std::string heartbeat = proto::EncodeMasterMessage(proto::Heartbeat{++heartbeats_, {}});
  const std::chrono::milliseconds pace = PaceNow();
  while (!beats_.empty() && beats_.begin()->first <= now) {
    const auto [due, id] = *beats_.begin();
    Worker& worker = workers_.at(id);
    beats_.erase(beats_.begin());
    worker.next_beat = now + worker.paces[0];
    beats_.insert({worker.next_beat, id});
    SendAcknowledgements(worker);
    const bool reached = transport_.Send(worker.peer, heartbeat) != SendOutcome::kUnreachable;
    worker.unreachable = reached ? 0 : worker.unreachable + 1;
    if (worker.unreachable >= kUnreachableBeats) beats.out_of_reach.push_back(id);
    const auto change = std::chrono::abs(pace - worker.paces[0]);
    if (kPartThatMatters * change >= worker.paces[0] && beats.out_of_pace.size() < kMostRepaced)
      beats.out_of_pace.push_back(id);
  }
  return beats;
}

}  // namespace gauntlet
