// A master for tests: a ROUTER on loopback, an access.json, and waiting with deadlines.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/protocol.pb.h"

namespace gauntlet::worker {

struct Incoming {
  std::string peer;  // the connection's identity
  v1::Envelope envelope;
};

class FakeMaster {
 public:
  // Listens on a free port and writes `access_path`.
  FakeMaster(const std::string& access_path, std::uint64_t epoch, const std::string& campaign = "c0ffee");
  ~FakeMaster();
  std::string endpoint() const;
  // Breaks all connections and listens again at the same endpoint. False when that was not free any more.
  bool BreakConnections();

  // The next message of any worker; nullopt at the deadline. Garbage fails the test.
  std::optional<Incoming> Next(std::chrono::milliseconds deadline);
  // Skips messages until one is of the wanted kind; nullopt at the deadline.
  std::optional<Incoming> Await(v1::Envelope::MessageCase kind,
                                std::chrono::milliseconds deadline = kPatience);
  // Waits for a hello and welcomes its sender; the sender, "" at the deadline.
  std::string WelcomeOne(double cpu_limit_seconds = 0.0, std::uint64_t memory_limit_bytes = 0,
                         std::uint32_t heartbeat_ms = 500);

  void Send(const std::string& peer, const v1::Envelope& envelope);
  void SendRaw(const std::string& peer, const std::string& bytes);
  // A lease of a run that does `what` (faulty_runs.h).
  void Lease(const std::string& peer, std::uint64_t fence, std::uint64_t what,
             const std::string& scenario = "", bool record_trajectory = false);
  void Acknowledge(const std::string& peer, std::uint64_t fence);
  void Drain(const std::string& peer, bool finish_current);
  // The result of a lease, acknowledged. Heartbeats are answered meanwhile. nullopt at the deadline.
  std::optional<v1::LeaseResult> AwaitResult(const std::string& peer, std::uint64_t fence);

  static constexpr std::chrono::milliseconds kPatience{60'000};

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
  std::uint64_t epoch_;
};

// In one step, as a master does.
void WriteAccess(const std::string& path, std::uint64_t epoch, const std::vector<std::string>& endpoints,
                 const std::string& campaign = "c0ffee");

std::string SpecBytes(std::uint64_t what, const std::string& scenario = "", bool record_trajectory = false);

}  // namespace gauntlet::worker
