// Publishes what a living master has stored, for readers on other machines: they cannot share its log.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "master/store/database_copy.h"

namespace gauntlet {

struct SnapshotOptions {
  std::string database;  // campaign.db, which this process writes
  std::string snapshot;  // snapshot.db, replaced by every copy
  // Counts what has been committed: nothing is copied when nothing is new.
  std::function<std::uint64_t()> commits;
  std::chrono::milliseconds first_after{1000};
  std::chrono::milliseconds at_least_every{10'000};  // between two copies
  int pause_per_copy = 100;  // as many times as long as the copy took: 1 % of the time
};

// Copies on a thread of its own from construction to destruction, which ends a copy that is under way. A copy
// that fails is left out: a full disk is the store's business, and a disk that two more copies would fill is
// left alone. Thread-safety: none is needed but for `commits`, which is called on the publisher's thread.
class SnapshotPublisher {
 public:
  explicit SnapshotPublisher(SnapshotOptions options);
  SnapshotPublisher(const SnapshotPublisher&) = delete;
  SnapshotPublisher& operator=(const SnapshotPublisher&) = delete;
  ~SnapshotPublisher();

 private:
  void Loop();
  void Publish();

  const SnapshotOptions options_;
  DatabaseCopy copy_;
  std::uint64_t published_ = 0;  // commits in the newest copy
  std::mutex mutex_;
  std::condition_variable ends_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace gauntlet
