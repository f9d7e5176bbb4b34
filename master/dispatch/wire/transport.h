// Messages to and from peers. The one implementation with sockets is zmq_transport.h, its in-memory twin is
// tests/support/fake_transport.h.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gauntlet {

// One connection of a worker; a worker that reconnects comes back as another peer.
using PeerId = std::string;

struct PeerMessage {
  PeerId peer;
  std::string bytes;
};

enum class SendOutcome {
  kSent,         // queued; delivery is not promised
  kFull,         // the peer does not read: its queue is full
  kUnreachable,  // the peer is gone
};

struct WaitOutcome {
  bool messages = false;       // Receive has something
  bool woken = false;          // WakeUp was called, or a signal came
  std::vector<int> ready_fds;  // those of the given descriptors that are readable
};

// Frames that were dropped before anybody saw them, since the start.
struct TransportRejections {
  std::uint64_t malformed = 0;   // not exactly one frame, or without end
  std::uint64_t oversized = 0;   // longer than the limit of a message
  std::uint64_t handshakes = 0;  // connections that did not get through ZeroMQ's greeting
  std::uint64_t keys = 0;        // connections whose keys are not admitted
  std::uint64_t silent = 0;      // connections closed because too many had said nothing
};

// Thread-safety: one thread, but WakeUp may be called from any thread and from a signal handler.
class Transport {
 public:
  virtual ~Transport() = default;
  // Never blocks.
  virtual SendOutcome Send(const PeerId& peer, std::string_view bytes) = 0;
  // Appends at most `limit` messages that have arrived, fewer when they are very long; never blocks.
  virtual void Receive(std::size_t limit, std::vector<PeerMessage>& messages) = 0;
  // Waits until messages arrive, one of `fds` becomes readable, WakeUp is called or `timeout` has passed.
  virtual WaitOutcome Wait(std::chrono::milliseconds timeout, std::span<const int> fds) = 0;
  virtual void WakeUp() = 0;
  // Of connections that are made from now on (ZmqTransportOptions::sign_of_life).
  virtual void SetSignOfLife(std::chrono::milliseconds /*time*/) {}
  virtual TransportRejections Rejections() const = 0;
  // Connections whose handshake has begun and not ended: each takes milliseconds, and messages wait behind
  // them.
  virtual int Greeting() const { return 0; }
  // Whether every peer that is heard has proven to know the campaign's key. Otherwise anybody may be
  // speaking.
  virtual bool KnowsItsPeers() const = 0;
};

}  // namespace gauntlet
