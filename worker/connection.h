// The worker's connection to its master: a DEALER socket and what waits to be sent.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <zmq.hpp>

#include "base/result.h"
#include "proto/access_file.h"

namespace gauntlet::worker {

// Sends and receives never wait. Messages that cannot be sent yet (not connected, or the master does not keep
// up) are kept in order; the destructor gives those under way a second to leave. Thread-safety: one calling
// thread.
class Connection {
 public:
  // Drops the old connection with everything that waits, and begins a new one.
  Status Open(const std::string& endpoint, const std::optional<proto::CurveKeys>& curve);
  // With the next Flush.
  void Send(std::string frame) { outbox_.push_back(std::move(frame)); }
  // True when something waits to be sent.
  bool congested() const { return !outbox_.empty(); }
  // Sends what waits, as far as possible.
  void Flush();
  std::optional<std::string> Receive();
  // Whether Receive has something.
  bool Readable();
  // True once after the connection broke and stands again, which ZeroMQ does by itself: for the other side it
  // is a new one, of a stranger. Nothing waits to be sent then, for it was meant for the former connection.
  bool TakeRestored();
  // Readable when the state of the connection may have changed: ask Readable() and Flush() before sleeping on
  // it, for a change is announced once. -1 before Open.
  int fd() const { return fd_; }
  // The same for TakeRestored.
  int monitor_fd() const { return monitor_fd_; }

 private:
  zmq::context_t context_{1};
  zmq::socket_t dealer_;
  zmq::socket_t monitor_;  // tells of every handshake of `dealer_`
  int opened_ = 0;
  std::deque<std::string> outbox_;
  int fd_ = -1;
  int monitor_fd_ = -1;
  bool stood_ = false;  // since Open
};

}  // namespace gauntlet::worker
