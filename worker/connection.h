// The worker's connection to its master: a DEALER socket and what waits to be sent.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "proto/access_file.h"

namespace gauntlet::worker {

// Sends and receives never wait. Messages that cannot be sent yet (not connected, or the master does not keep
// up) are kept in order. Thread-safety: one calling thread.
class Connection {
 public:
  Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  // Gives messages under way a second to leave.
  ~Connection();

  // Drops the old connection with everything that waits, and begins a new one.
  Status Open(const std::string& endpoint, const std::optional<proto::CurveKeys>& curve);
  // With the next Flush.
  void Send(std::string frame);
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
  struct Socket;
  std::unique_ptr<Socket> socket_;
  std::deque<std::string> outbox_;
  int fd_ = -1;
  int monitor_fd_ = -1;
  bool stood_ = false;  // since Open
};

}  // namespace gauntlet::worker
