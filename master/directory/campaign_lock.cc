#include "master/directory/campaign_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/regular_file.h"
#include "base/system/unique_fd.h"
#include "proto/json_text.h"

namespace gauntlet {
namespace {

constexpr int kLockFormat = 1;
// An owner is always written in one piece of this size, so that nobody reads half of one.
constexpr std::size_t kContentSize = 1024;
constexpr std::chrono::milliseconds kRetryAfter{20};

struct LockOwner {
  ProcessIdentity process;
  std::int64_t heartbeat = 0;  // Unix time, s, of its last sign of life
};

std::string WriteContent(const ProcessIdentity& process, std::int64_t heartbeat) {
  const nlohmann::ordered_json json = {{"format", kLockFormat},      {"host", process.host},
                                       {"boot_id", process.boot_id}, {"pid_namespace", process.pid_namespace},
                                       {"pid", process.pid},         {"start_time", process.start_time},
                                       {"heartbeat", heartbeat}};
  std::string content = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  GAUNTLET_CHECK(content.size() < kContentSize, "a lock's owner is too long: " + content);
  content.resize(kContentSize - 1, ' ');
  content += '\n';
  return content;
}

// The owner that a lock file names; empty when it is free or does not read back.
std::optional<LockOwner> ReadOwner(int fd) {
  std::array<char, kContentSize> content{};
  const ssize_t size = pread(fd, content.data(), content.size(), 0);
  if (size <= 0) return std::nullopt;
  const nlohmann::json json =
      nlohmann::json::parse(content.data(), content.data() + size, nullptr, /*allow_exceptions=*/false);
  const auto number = [&json](const char* key) -> std::int64_t {
    return json.is_object() && json.contains(key) && json[key].is_number_integer()
               ? json[key].get<std::int64_t>()
               : 0;
  };
  LockOwner owner{{TextAt(json, "host"), TextAt(json, "boot_id"), TextAt(json, "pid_namespace"),
                   static_cast<pid_t>(number("pid")), static_cast<std::uint64_t>(number("start_time"))},
                  number("heartbeat")};
  if (owner.process.host.empty() || owner.process.pid <= 0) return std::nullopt;
  return owner;
}

// The error that a named owner gives rise to, if it lives.
std::optional<Error> Objection(const LockOwner& owner, const std::string& campaign, std::int64_t now) {
  const ProcessIdentity& process = owner.process;
  const Liveness liveness = LivenessOf(process, IdentifyThisProcess());
  if (liveness == Liveness::kAlive) {
    return Error{ErrorKind::kInUse,
                 fmt::format("campaign {0} is in use by a living master (host {1}, pid {2}): "
                             "`gauntlet status {0}` says how it goes, `gauntlet stop {0}` ends it",
                             campaign, process.host, process.pid)};
  }
  if (liveness == Liveness::kDead || now - owner.heartbeat >= CampaignLock::kStaleAfter.count())
    return std::nullopt;
  return Error{
      ErrorKind::kInUse,
      fmt::format(
          "campaign {} is in use by a master elsewhere (host {}, pid {}, last sign of life {} s ago; it "
          "counts as dead after {} s without one); stop it there with Ctrl-C or `kill {}`",
          campaign, process.host, process.pid, std::max<std::int64_t>(0, now - owner.heartbeat),
          CampaignLock::kStaleAfter.count(), process.pid)};
}

// An owner elsewhere whose last sign of life, of a clock ahead of ours, will not be old for a long time.
bool IsAhead(const LockOwner& owner, std::int64_t now) {
  return owner.heartbeat - now >= CampaignLock::kStaleAfter.count() &&
         LivenessOf(owner.process, IdentifyThisProcess()) == Liveness::kUnknown;
}

// The owner lives here, and is the master of another directory, of which this one is a copy.
bool BelongsToOriginal(const LockOwner& owner, const LockOptions& options) {
  return LivenessOf(owner.process, IdentifyThisProcess()) == Liveness::kAlive && options.is_copy();
}

enum class FlockAnswer { kLocked, kHeldByOther, kUnsupported };

FlockAnswer TryFlock(int fd, bool exclusive) {
  while (flock(fd, (exclusive ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    return errno == EWOULDBLOCK ? FlockAnswer::kHeldByOther : FlockAnswer::kUnsupported;
  }
  return FlockAnswer::kLocked;
}

}  // namespace

CampaignLock::CampaignLock(std::string path, std::string campaign, LockOptions options, UniqueFd fd)
    : path_(std::move(path)),
      campaign_(std::move(campaign)),
      options_(std::move(options)),
      fd_(std::move(fd)) {}

Result<std::unique_ptr<CampaignLock>> CampaignLock::Acquire(const std::string& path,
                                                            const std::string& campaign,
                                                            const LockOptions& options) {
  TRY(std::unique_ptr<CampaignLock> lock, Wait(path, campaign, options, /*exclusive=*/true));
  CampaignLock& taken = *lock;
  taken.identity_ = IdentifyThisProcess();
  TRY(taken.WriteOwner(WriteContent(*taken.identity_, taken.options_.unix_time())));
  if (options.heartbeat_every.count() > 0)
    taken.heartbeat_ = std::thread([&taken] { taken.HeartbeatLoop(); });
  return lock;
}

Result<std::unique_ptr<CampaignLock>> CampaignLock::AcquireForReading(const std::string& path,
                                                                      const std::string& campaign,
                                                                      const LockOptions& options) {
  return Wait(path, campaign, options, /*exclusive=*/false);
}

Result<std::unique_ptr<CampaignLock>> CampaignLock::Wait(const std::string& path, const std::string& campaign,
                                                         const LockOptions& options, bool exclusive) {
  Result<UniqueFd> file = OpenRegularFile(path, exclusive ? O_RDWR | O_CREAT : O_RDONLY, kReadableByAll);
  if (!file && (exclusive || file.error().kind == ErrorKind::kInvalidInput)) return file.error();
  std::unique_ptr<CampaignLock> lock(
      new CampaignLock(path, campaign, options, file ? *std::move(file) : UniqueFd()));
  const int fd = lock->fd_.get();
  if (fd < 0) return lock;

  const auto started = std::chrono::steady_clock::now();
  std::optional<LockOwner> ahead;  // an owner whose clock is ahead, as it was seen last
  while (true) {
    const auto waited = std::chrono::steady_clock::now() - started;
    const FlockAnswer answer = TryFlock(fd, exclusive);
    // A name that is read while somebody else holds the file may be the former owner's; a living one counts
    // anyway.
    const std::optional<LockOwner> owner = ReadOwner(fd);
    bool undecided = false;
    if (owner) {
      const std::int64_t now = options.unix_time();
      const std::optional<Error> objection = Objection(*owner, campaign, now);
      if (objection && !(answer != FlockAnswer::kUnsupported && BelongsToOriginal(*owner, options))) {
        const bool beats = ahead && ahead->heartbeat != owner->heartbeat;
        if (!exclusive || beats || !(ahead || IsAhead(*owner, now))) return *objection;
        ahead = owner;
        undecided = waited < options.beat_patience;
      }
    }
    if (answer != FlockAnswer::kHeldByOther && !undecided) return lock;
    if (options.give_up()) {
      return Error{ErrorKind::kInUse,
                   fmt::format("campaign {} is held by another process, and this one was told to stop while "
                               "it waited for it; nothing was changed",
                               campaign)};
    }
    if (waited >= options.patience && !undecided) {
      const std::string last =
          owner ? fmt::format(" (its last master: host {}, pid {})", owner->process.host, owner->process.pid)
                : "";
      return Error{
          ErrorKind::kInUse,
          fmt::format(
              "campaign {} is held by another process, which reads it, or starts or ends just now{}; try "
              "again in a moment",
              campaign, last)};
    }
    std::this_thread::sleep_for(kRetryAfter);
  }
}

std::optional<ProcessIdentity> CampaignLock::OwnerOf(const std::string& path) {
  const UniqueFd file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  const std::optional<LockOwner> owner = file.valid() ? ReadOwner(file.get()) : std::nullopt;
  return owner ? std::optional(owner->process) : std::nullopt;
}

CampaignLock::~CampaignLock() {
  if (heartbeat_.joinable()) {
    {
      const std::lock_guard guard(mutex_);
      closing_ = true;
    }
    closing_changed_.notify_all();
    heartbeat_.join();
  }
  if (!fd_.valid() || !identity_ || !Check()) return;
  const std::optional<LockOwner> owner = ReadOwner(fd_.get());
  // A failed truncation leaves the name of a process that will be dead in a moment.
  if (owner && owner->process == *identity_ && ftruncate(fd_.get(), 0) != 0) fsync(fd_.get());
}

Status CampaignLock::WriteOwner(const std::string& content) const {
  for (std::size_t written = 0; written < content.size();) {
    const ssize_t size =
        pwrite(fd_.get(), content.data() + written, content.size() - written, static_cast<off_t>(written));
    if (size < 0) return SystemError(fmt::format("cannot write {}", path_), errno);
    written += static_cast<std::size_t>(size);
  }
  if (fsync(fd_.get()) != 0) return SystemError(fmt::format("cannot synchronise {}", path_), errno);
  return Ok{};
}

Status CampaignLock::Heartbeat() {
  const std::lock_guard beating(heartbeat_mutex_);
  if (Status checked = Check(); !checked || !identity_) return checked;
  const std::optional<LockOwner> owner = ReadOwner(fd_.get());
  if (owner && owner->process == *identity_)
    return WriteOwner(WriteContent(*identity_, options_.unix_time()));

  const std::string successor = owner
                                    ? fmt::format("host {}, pid {}", owner->process.host, owner->process.pid)
                                    : "which has ended since";
  Error error{ErrorKind::kInUse,
              fmt::format("campaign {} was taken over by another master ({}) while this one gave no "
                          "sign of life; this one stops",
                          campaign_, successor)};
  const std::lock_guard guard(mutex_);
  lost_ = error;
  return error;
}

Status CampaignLock::Check() const {
  const std::lock_guard guard(mutex_);
  if (lost_) return *lost_;
  return Ok{};
}

void CampaignLock::HeartbeatLoop() {
  while (true) {
    {
      std::unique_lock guard(mutex_);
      if (closing_changed_.wait_for(guard, options_.heartbeat_every, [this] { return closing_; })) return;
    }
    // A heartbeat that cannot be written (a full disk) is tried again; Check() reports a lost lock.
    (void)Heartbeat();
  }
}

}  // namespace gauntlet
