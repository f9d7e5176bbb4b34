#include "worker/connection.h"

#include <fmt/format.h>

#include <utility>

#include "base/thread_sanitizer.h"
#include "proto/messages.h"

namespace gauntlet::worker {
namespace {

constexpr int kLingerMs = 1000;
constexpr int kReconnectMs = 100;
constexpr int kReconnectMaxMs = 2000;

}  // namespace

Status Connection::Open(const std::string& endpoint, const std::optional<proto::CurveKeys>& curve) {
  outbox_.clear();
  try {
    if (dealer_) {
      dealer_.set(zmq::sockopt::linger, 0);
      dealer_.close();
    }
    zmq::socket_t dealer(context_, zmq::socket_type::dealer);
    dealer.set(zmq::sockopt::linger, kLingerMs);
    // Only a connection that stands takes messages: nothing piles up in front of a master that is away.
    dealer.set(zmq::sockopt::immediate, true);
    dealer.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(proto::kMaxMessageBytes));
    dealer.set(zmq::sockopt::reconnect_ivl, kReconnectMs);
    dealer.set(zmq::sockopt::reconnect_ivl_max, kReconnectMaxMs);
    if (curve) {
      dealer.set(zmq::sockopt::curve_serverkey, curve->server_public);
      dealer.set(zmq::sockopt::curve_publickey, curve->worker_public);
      dealer.set(zmq::sockopt::curve_secretkey, curve->worker_secret);
    }
    const std::string events = fmt::format("inproc://connection-{}", ++opened_);
    if (zmq_socket_monitor(dealer.handle(), events.c_str(), ZMQ_EVENT_HANDSHAKE_SUCCEEDED) != 0) {
      throw zmq::error_t();
    }
    zmq::socket_t monitor(context_, zmq::socket_type::pair);
    monitor.set(zmq::sockopt::linger, 0);
    monitor.connect(events);
    dealer.connect(endpoint);
    fd_ = dealer.get(zmq::sockopt::fd);
    monitor_fd_ = monitor.get(zmq::sockopt::fd);
    stood_ = false;
    dealer_ = std::move(dealer);
    monitor_ = std::move(monitor);
  } catch (const zmq::error_t& error) {
    return InvalidInput(fmt::format("cannot connect to {}: {}", endpoint, error.what()));
  }
  return Ok{};
}

void Connection::Flush() {
  if (!dealer_) return;
  while (!outbox_.empty()) {
    try {
      if (!dealer_.send(zmq::buffer(outbox_.front()), zmq::send_flags::dontwait)) return;
    } catch (const zmq::error_t&) {
      return;  // as if it did not go through yet: after a reconnect the state machine sends again
    }
    outbox_.pop_front();
  }
}

std::optional<std::string> Connection::Receive() {
  if (!dealer_) return std::nullopt;
  try {
    zmq::message_t first;
    if (!dealer_.recv(first, zmq::recv_flags::dontwait)) return std::nullopt;
    // A message of several frames is not ours: its parts arrive as messages of their own and do not decode.
    return first.to_string();
  } catch (const zmq::error_t&) {
    return std::nullopt;
  }
}

bool Connection::TakeRestored() {
  bool restored = false;
  try {
    zmq::message_t event;
    while (monitor_ && monitor_.recv(event, zmq::recv_flags::dontwait)) {
      // An event has two frames, of which the second, the address, is the last.
      if (!event.more()) restored = std::exchange(stood_, true) || restored;
    }
  } catch (const zmq::error_t&) {
    // Interrupted by a signal: the next call reads on.
  }
  if (restored) outbox_.clear();
  return restored;
}

bool Connection::Readable() {
  try {
    return dealer_ && (dealer_.get(zmq::sockopt::events) & ZMQ_POLLIN) != 0;
  } catch (const zmq::error_t&) {
    return true;  // interrupted by a signal: Receive will tell
  }
}

}  // namespace gauntlet::worker
