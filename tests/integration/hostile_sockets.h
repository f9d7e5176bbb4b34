// Plain sockets that speak as much of ZeroMQ's protocol as an attacker likes.
#pragma once

#include <string>

namespace gauntlet::testing_support {

// A connection to a port of this machine; closed with the object.
class HostileSocket {
 public:
  explicit HostileSocket(int port);
  HostileSocket(HostileSocket&& other) noexcept;
  HostileSocket& operator=(HostileSocket&&) = delete;
  ~HostileSocket();
  bool connected() const { return connected_; }
  // What can be sent without waiting; the rest is dropped.
  void Send(const std::string& bytes);
  // Says that nothing more will come, and hears what the other side says until it closes too, or says nothing
  // for a twentieth of a second.
  std::string HearOut();

 private:
  int fd_ = -1;
  bool connected_ = false;
};

// A ZMTP 3.0 greeting (64 bytes) with the NULL mechanism, and a READY command: what follows is taken as
// messages (https://rfc.zeromq.org/spec/23/).
std::string ZmtpHandshake();
// A message of one part, as it follows the handshake.
std::string ZmtpMessage(const std::string& body);

}  // namespace gauntlet::testing_support
