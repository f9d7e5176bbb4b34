// Workers that are admitted to a campaign, have its keys, and lie. They speak the real protocol over real
// sockets, each in a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

#include "tests/integration/scripted_worker.h"

namespace gauntlet::testing_support {

enum class Lie {
  kNone,          // an honest worker of the same make
  kCrash,         // every run crashed
  kHang,          // every run took too much CPU time
  kWrongHash,     // every result has a hash that is not its content's
  kUnreadable,    // every result is noise
  kForeignLease,  // it answers for leases of others
  kSlow,          // every result is right, and late
};
std::string_view NameOf(Lie lie);

class Liar {
 public:
  // Joins the campaign in `dir` at once; does not return before it is welcomed, or has failed to be.
  Liar(const std::string& dir, Lie lie, std::uint64_t instance_id);
  Liar(const Liar&) = delete;
  Liar& operator=(const Liar&) = delete;
  ~Liar();
  bool joined() const { return joined_; }
  int leases() const { return leases_; }  // so far

 private:
  void Work(const std::stop_token& stop);
  void Answer(const proto::Lease& lease);

  Lie lie_;
  ScriptedWorker worker_;
  bool joined_ = false;
  std::atomic<int> leases_{0};
  std::jthread thread_;
};

}  // namespace gauntlet::testing_support
