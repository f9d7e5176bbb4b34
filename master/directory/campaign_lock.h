// One master per campaign: a lock file that names its owner, held with flock(2) where the file system has it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "base/result.h"
#include "base/system/clock.h"
#include "base/system/process_identity.h"
#include "base/system/unique_fd.h"

namespace gauntlet {

struct LockOptions {
  std::function<std::int64_t()> unix_time = [] { return UnixMilliseconds() / 1000; };  // s
  std::chrono::milliseconds heartbeat_every{5000};  // 0 = only when Heartbeat is called
  // How long to wait for an owner that has not said its name yet, or for readers.
  std::chrono::milliseconds patience{2000};
  // The last heartbeat of an owner on another machine may lie in our future, because its clock is ahead. A
  // master then waits this long for the next heartbeat; when none comes, the owner counts as dead.
  std::chrono::milliseconds beat_patience{15000};
  // Asked again and again while it waits: true ends the wait with kInUse.
  std::function<bool()> give_up = [] { return false; };
  // Whether the campaign's directory was copied, and its lock file with it. The lock file then names the
  // master of the original, which is no reason to keep away from the copy. It is asked only when that master
  // lives on this machine: had it locked this very file and not the original's, flock(2) would say so.
  std::function<bool()> is_copy = [] { return false; };
};

// Whoever holds it is the campaign's master. It is taken from an owner that is dead (a process of this
// machine's present boot that is gone) or, on another host or boot, has given no sign of life for
// kStaleAfter; never from a living one. The file stays when the lock is released, empty: deleting it would
// let two masters lock two files. Thread-safety: Check and Heartbeat may be called from any thread, the rest
// from one.
class CampaignLock {
 public:
  static constexpr std::chrono::seconds kStaleAfter{60};

  // `path`: the lock file, made when it is missing. `campaign`: what messages call it. kInUse names host and
  // pid of the owner.
  static Result<std::unique_ptr<CampaignLock>> Acquire(const std::string& path, const std::string& campaign,
                                                       const LockOptions& options = {});

  // Keeps masters away while a campaign without one is looked at; several readers may hold it at once. kInUse
  // names the owner when a master lives. Changes nothing; a missing or unreadable lock file locks nothing.
  // Both: kInvalidInput when it is no regular file.
  static Result<std::unique_ptr<CampaignLock>> AcquireForReading(const std::string& path,
                                                                 const std::string& campaign,
                                                                 const LockOptions& options = {});

  // Whom a lock file names, living or not; empty when it is free or does not read back.
  static std::optional<ProcessIdentity> OwnerOf(const std::string& path);

  CampaignLock(const CampaignLock&) = delete;
  CampaignLock& operator=(const CampaignLock&) = delete;
  // Releases it.
  ~CampaignLock();

  // Writes a sign of life. kInUse when another master has taken the lock meanwhile (this one was frozen for
  // longer than kStaleAfter); from then on nothing is written any more.
  Status Heartbeat();
  // What the last heartbeat met: an error when the lock is lost. Costs no system call.
  Status Check() const;

 private:
  CampaignLock(std::string path, std::string campaign, LockOptions options, UniqueFd fd);
  static Result<std::unique_ptr<CampaignLock>> Wait(const std::string& path, const std::string& campaign,
                                                    const LockOptions& options, bool exclusive);
  Status WriteOwner(const std::string& content) const;
  void HeartbeatLoop();

  const std::string path_;
  const std::string campaign_;
  const LockOptions options_;
  const UniqueFd fd_;
  std::optional<ProcessIdentity> identity_;  // none: held for reading

  std::mutex heartbeat_mutex_;  // one heartbeat at a time
  mutable std::mutex mutex_;    // guards the two below
  std::optional<Error> lost_;
  bool closing_ = false;
  std::condition_variable closing_changed_;
  std::thread heartbeat_;
};

}  // namespace gauntlet
