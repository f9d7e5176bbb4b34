// The worker's connection to its master: a DEALER socket and what waits to be sent.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "sim/base/result.h"

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
  Status Open(const std::string& endpoint);
  void Send(std::string frame);
  // True when Send would have to keep a message back.
  bool congested() const { return !outbox_.empty(); }
  // Sends what waits, as far as possible.
  void Flush();
  std::optional<std::string> Receive();
  // The socket for zmq_poll, nullptr before Open.
  void* handle();

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
  std::deque<std::string> outbox_;
};

}  // namespace gauntlet::worker
