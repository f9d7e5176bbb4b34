// Closes TCP connections whose message does not end, and the oldest of too many that never say anything.
#pragma once

#include <dirent.h>
#include <netinet/in.h>

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace gauntlet {

// ZeroMQ limits each part of a message, not their sum, and hands over none of them before the last has come:
// one peer could fill the memory of the process that listens. This compares the bytes that ZeroMQ has read
// from each connection to a port (TCP_INFO and FIONREAD, tcp(7)) with those at its last whole message, and
// shuts down a connection that is too far ahead; ZeroMQ then forgets what it had of the message.
//
// Every connection takes a descriptor, and half a greeting keeps it for half a minute: a stranger who
// connects by the thousand could take all there are, and no worker would get in. So of the connections from
// which no whole message has ever come only as many are left as `most_silent`, and the oldest go first: a
// worker speaks as soon as it is connected.
//
// The descriptors are ZeroMQ's, and its thread closes them when it likes. Each is looked at and shut down in
// one go; should another connection to the port get the number in that moment, it has to be made anew.
// Thread-safety: one thread. Linux only (/proc/self/fd).
class ConnectionWatch {
 public:
  struct Closed {
    int endless = 0;  // their message did not end
    int silent = 0;   // there were too many that had said nothing
  };

  // Of IPv4 connections to this port of ours. `most_bytes`: without a whole message; `most_silent`:
  // connections without any. Takes a descriptor, so that it can still look when there are no more.
  ConnectionWatch(std::uint16_t port, std::uint64_t most_bytes, std::size_t most_silent);

  // A whole message was received from the connection with this descriptor.
  void Completed(int fd);
  // Call when no whole message waits to be received, for those count as unfinished. Returns how many
  // connections it shut down. Costs four system calls for each connection.
  Closed Check();

 private:
  struct Connection {
    in_addr_t address = 0;
    in_port_t port = 0;
    std::uint64_t whole = 0;  // bytes read at its last whole message, or later
    std::uint64_t age = 0;    // number of the check that saw it first
    bool spoke = false;       // a whole message came
  };
  struct CloseDirectory {
    void operator()(DIR* directory) const { closedir(directory); }
  };

  int CloseSilent();  // how many

  std::uint16_t port_;
  std::uint64_t most_bytes_;
  std::size_t most_silent_;
  std::unique_ptr<DIR, CloseDirectory> descriptors_;  // /proc/self/fd
  std::uint64_t checks_ = 0;
  std::unordered_map<int, Connection> connections_;  // by descriptor, as of the last check
  std::vector<bool> completed_;                      // since then, by descriptor
};

}  // namespace gauntlet
