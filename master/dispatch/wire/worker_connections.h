// The workers that have said hello: who they are, which connection each speaks through, and what is sent to
// them.
#pragma once

#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/pool/process_watch.h"
#include "master/dispatch/wire/transport.h"
#include "proto/messages.h"

namespace gauntlet {

// Thread-safety: one thread.
class WorkerConnections {
 public:
  struct Worker {
    PeerId peer;
    std::string label;  // instance id and host
    pid_t pid = 0;
    std::string allocation;                            // as the worker said it, "" for none
    int unreachable = 0;                               // heartbeats in a row that found no connection
    std::array<std::chrono::milliseconds, 3> paces{};  // that it was told, the newest first
    TimePoint next_beat = {};
    // Leases whose acknowledgement goes along with the next message, a heartbeat later at most: woken for
    // each, workers and master took another half percent of runs of 50 ms.
    std::vector<proto::Fence> acknowledged;
  };
  enum class Arrival {
    kNew,
    kBack,      // known, from another connection
    kRepeated,  // known, from the same: said again before our welcome arrived
  };

  // `transport` must outlive the object. `heartbeat`: the time between two of a worker, both ways, as long as
  // no more than kWorkersPerBeat are there; of more, so many times longer.
  static constexpr int kWorkersPerBeat = 1000;
  WorkerConnections(Transport& transport, std::chrono::milliseconds heartbeat)
      : transport_(transport), heartbeat_(heartbeat) {}

  // The worker that last said hello through this connection.
  std::optional<proto::InstanceId> SpeakerOf(const PeerId& peer) const;
  // From now on the worker speaks through this connection, and its process is watched if it is one of this
  // machine.
  Arrival Accept(const PeerId& peer, const proto::Hello& hello);
  void Disconnect(proto::InstanceId worker);

  // Null when the worker is not known.
  const Worker* Find(proto::InstanceId worker) const;
  const std::map<proto::InstanceId, Worker>& all() const { return workers_; }
  // Instance id and host; of an unknown worker the id alone.
  std::string LabelOf(proto::InstanceId worker) const;

  // Acknowledgements that wait go first.
  SendOutcome Send(proto::InstanceId worker, const proto::MasterMessage& message);
  // Goes along with the next message to the worker.
  void Acknowledge(proto::InstanceId worker, proto::Fence fence);
  void SendAcknowledgements(proto::InstanceId worker);
  struct Beats {
    std::vector<proto::InstanceId> out_of_reach;  // too often in a row
    // Are to be told another pace, since the time between heartbeats has changed by a fifth: at most
    // kMostRepaced at once.
    std::vector<proto::InstanceId> out_of_pace;
  };
  static constexpr std::size_t kMostRepaced = 100;
  // To those whose turn it is.
  Beats SendHeartbeats(TimePoint now);
  // The worker is told the time between heartbeats in this moment.
  std::chrono::milliseconds Pace(proto::InstanceId worker, TimePoint now);
  // The longest of the last three that it was told: by which its silence is judged.
  std::chrono::milliseconds LongestPace(proto::InstanceId worker) const;

  // Processes of workers on this machine, under their instance ids.
  ProcessWatch& processes() { return processes_; }

 private:
  void SendAcknowledgements(Worker& worker);
  std::chrono::milliseconds PaceNow() const;

  Transport& transport_;
  const std::chrono::milliseconds heartbeat_;
  std::set<std::pair<TimePoint, proto::InstanceId>> beats_;  // when each is next
  std::map<proto::InstanceId, Worker> workers_;
  std::unordered_map<PeerId, proto::InstanceId> speakers_;
  ProcessWatch processes_;
  std::uint64_t heartbeats_ = 0;
};

// How a worker is called in logs: "00000000000000a1@host".
std::string LabelOf(const proto::Hello& hello);

}  // namespace gauntlet
