// Closes TCP connections whose message does not end.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace gauntlet::master {

// ZeroMQ limits each part of a message, not their sum, and hands over none of them before the last has come:
// one peer could fill the memory of the process that listens. This compares the bytes that ZeroMQ has read
// from each connection to a port (TCP_INFO and FIONREAD, tcp(7)) with those at its last whole message, and
// shuts down a connection that is too far ahead; ZeroMQ then forgets what it had of the message.
//
// The descriptors are ZeroMQ's, and its thread closes them when it likes. Each is looked at and shut down in
// one go; should another connection to the port get the number in that moment, it has to be made anew.
// Thread-safety: one thread. Linux only (/proc/self/fd).
class ConnectionWatch {
 public:
  // Of IPv4 connections to this port of ours. `most_bytes`: without a whole message.
  ConnectionWatch(std::uint16_t port, std::uint64_t most_bytes) : port_(port), most_bytes_(most_bytes) {}

  // A whole message was received from the connection with this descriptor.
  void Completed(int fd);
  // Call when no whole message waits to be received, for those count as unfinished. Returns how many
  // connections it shut down. Costs four system calls for each connection.
  int Check();

 private:
  struct Connection {
    in_addr_t address = 0;
    in_port_t port = 0;
    std::uint64_t whole = 0;  // bytes read at its last whole message, or later
  };

  std::uint16_t port_;
  std::uint64_t most_bytes_;
  std::unordered_map<int, Connection> connections_;  // by descriptor, as of the last check
  std::vector<bool> completed_;                      // since then, by descriptor
};

}  // namespace gauntlet::master
