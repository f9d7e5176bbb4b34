#include "master/session/snapshot_publisher.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

namespace gauntlet {
namespace {

// The disk must hold so many more copies, or none is made: the results come first.
constexpr std::uintmax_t kCopiesOfRoom = 3;

bool HasRoomBeside(const std::string& database) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(database, error);
  const std::filesystem::space_info space = std::filesystem::space(database, error);
  return !error && space.available / kCopiesOfRoom > size;
}

}  // namespace

SnapshotPublisher::SnapshotPublisher(SnapshotOptions options)
    : options_(std::move(options)), thread_([this] { Loop(); }) {}

SnapshotPublisher::~SnapshotPublisher() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  ends_.notify_all();
  copy_.Cancel();
  thread_.join();
}

void SnapshotPublisher::Loop() {
  std::chrono::nanoseconds pause = options_.first_after;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      if (ends_.wait_for(lock, pause, [this] { return ending_; })) return;
    }
    const auto begin = std::chrono::steady_clock::now();
    Publish();
    const std::chrono::nanoseconds took = std::chrono::steady_clock::now() - begin;
    pause = std::max<std::chrono::nanoseconds>(options_.at_least_every, took * options_.pause_per_copy);
  }
}

void SnapshotPublisher::Publish() {
  const std::uint64_t commits = options_.commits();
  if (commits == published_ || !HasRoomBeside(options_.database)) return;
  const Status copied = copy_.Make(options_.database, options_.snapshot);
  if (copied) {
    published_ = commits;
  } else {
    spdlog::debug("no snapshot: {}", copied.error().message);
  }
}

}  // namespace gauntlet
