// The workers that have said hello: who they are, which connection each speaks through, and what is sent to
// them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

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
    std::string allocation;  // as the worker said it, "" for none
    int unreachable = 0;     // heartbeats in a row that found no connection
    // Leases whose acknowledgement goes along with the next message, a heartbeat later at most: woken for
    // each, workers and master took another half percent of runs of 50 ms.
    std::vector<proto::Fence> acknowledged;
  };
  enum class Arrival {
    kNew,
    kBack,      // known, from another connection
    kRepeated,  // known, from the same: said again before our welcome arrived
  };

  // `transport` must outlive the object.
  explicit WorkerConnections(Transport& transport) : transport_(transport) {}

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
  // To everybody. Returns those who were out of reach too often in a row.
  std::vector<proto::InstanceId> SendHeartbeats();

  // Processes of workers on this machine, under their instance ids.
  ProcessWatch& processes() { return processes_; }

 private:
  void SendAcknowledgements(Worker& worker);

  Transport& transport_;
  std::map<proto::InstanceId, Worker> workers_;
  std::unordered_map<PeerId, proto::InstanceId> speakers_;
  ProcessWatch processes_;
  std::uint64_t heartbeats_ = 0;
};

// How a worker is called in logs: "00000000000000a1@host".
std::string LabelOf(const proto::Hello& hello);

}  // namespace gauntlet
