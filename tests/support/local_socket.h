// One conversation with a port of this machine, in plain bytes.
#pragma once

#include <chrono>
#include <string>

namespace gauntlet::testing_support {

// Connects, sends `request`, and returns all that comes until the other side closes; "" when nobody listens.
// Waits at most ten seconds.
std::string Converse(int port, const std::string& request);

// Connects, sends `bytes` and stays, without reading.
class OpenConnection {
 public:
  OpenConnection(int port, const std::string& bytes);
  OpenConnection(OpenConnection&& other) noexcept;
  OpenConnection(const OpenConnection&) = delete;
  OpenConnection& operator=(const OpenConnection&) = delete;
  ~OpenConnection();
  // Whether it was made, and all was sent.
  bool ok() const { return ok_; }
  // Sends `byte` every 10 ms, until the other side closes or these are over. Whether it closed.
  bool IsClosedWhileSaying(char byte, std::chrono::milliseconds patience);

 private:
  int fd_ = -1;
  bool ok_ = false;
};

// Listens on a free port of 127.0.0.1 and answers nobody.
class ListeningSocket {
 public:
  ListeningSocket();
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;
  ~ListeningSocket();
  int port() const { return port_; }

 private:
  int fd_ = -1;
  int port_ = 0;
};

}  // namespace gauntlet::testing_support
