// A worker in the test's own hands: it speaks the workers' protocol, simulates in this process, and says what
// the test wants when the test wants it. Nothing happens by itself, heartbeats included.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/access_file.h"
#include "proto/messages.h"
#include "tests/support/process.h"
#include "worker/connection.h"

namespace gauntlet::testing_support {

class ScriptedWorker {
 public:
  // For the campaign in `dir`; with the version and golden hash of this build, one slot.
  ScriptedWorker(const std::string& dir, std::uint64_t instance_id);

  // What it says of itself; may be changed before Join.
  proto::Hello& hello() { return hello_; }
  const proto::Access& access() const { return access_; }

  // Waits for an access.json of an epoch of at least `epoch`, and connects; a former connection is dropped.
  bool Connect(std::uint64_t epoch = 1);
  // Connect, Hello, and the Welcome that answers it.
  bool Join(std::uint64_t epoch = 1);

  void Say(const proto::WorkerMessage& message);
  void SayBytes(std::string bytes);
  void Beat(const std::vector<proto::Fence>& held);
  // The next message; none within the time. Heartbeats are skipped.
  std::optional<proto::MasterMessage> Hear(std::chrono::milliseconds patience = kPatience);
  // The next message of a kind; others are lost.
  template <typename Message>
  std::optional<Message> HearA(std::chrono::milliseconds patience = kPatience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
      std::optional<proto::MasterMessage> message = Hear(std::chrono::milliseconds(100));
      if (!message) continue;
      if (auto* wanted = std::get_if<Message>(&*message)) return std::move(*wanted);
    }
    return std::nullopt;
  }

  // Simulates a lease, and the answer to it.
  static proto::LeaseResult Answer(const proto::Lease& lease);
  // The same with another fitness: what a broken machine would say.
  static proto::LeaseResult WrongAnswer(const proto::Lease& lease);

 private:
  std::string dir_;
  proto::Hello hello_;
  proto::Access access_;
  worker::Connection connection_;
};

}  // namespace gauntlet::testing_support
