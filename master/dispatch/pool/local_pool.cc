#include "master/dispatch/pool/local_pool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "base/system/atomic_file.h"
#include "base/system/process_call.h"
#include "base/system/regular_file.h"
#include "base/system/resource_limits.h"
#include "master/dispatch/pool/process_watch.h"

namespace gauntlet {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstDelay{50};
constexpr milliseconds kLongestDelay{2000};
constexpr int kGraceMilliseconds = 1000;  // between SIGTERM and SIGKILL when the pool is destroyed
constexpr std::size_t kTailBytes = 2000;
constexpr std::size_t kTailLines = 5;

std::string EndingOf(int status) {
  if (WIFSIGNALED(status))
    return fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return fmt::format("exit status {}", WEXITSTATUS(status));
}

// The last lines of a file, in one.
std::string TailOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return "";
  const std::streamoff size = file.tellg();
  file.seekg(std::max<std::streamoff>(0, size - static_cast<std::streamoff>(kTailBytes)));
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty()) lines.push_back(std::move(line));
  }
  if (lines.size() > kTailLines) lines.erase(lines.begin(), lines.end() - kTailLines);
  return fmt::format("{}", fmt::join(lines, " | "));
}

// What gauntlet-worker says by its exit status (its --help): another attempt would end in the same way.
constexpr int kRefusesToStart = 2;

ErrorKind KindOfEnd(int exit_status) {
  if (exit_status == kRefusesToStart) return ErrorKind::kInvalidInput;
  return exit_status == kExitWithoutResources ? ErrorKind::kNoSpace : ErrorKind::kInternal;
}

// The first failure in a row costs no time.
milliseconds DelayAfter(int failed_starts) {
  if (failed_starts <= 1) return milliseconds(0);
  return std::min(kLongestDelay, kFirstDelay * (1 << std::min(failed_starts - 2, 10)));
}

}  // namespace

Result<std::unique_ptr<LocalPool>> LocalPool::Start(const LocalPoolOptions& options, TimePoint now) {
  if (options.workers < 1) {
    return InvalidInput(fmt::format("a pool needs at least one worker, not {}", options.workers));
  }
  if (access(options.program.c_str(), X_OK) != 0) {
    return Error{ErrorKind::kNotFound,
                 fmt::format("cannot start workers: {}: {} (GAUNTLET_WORKER may name another program)",
                             options.program, std::strerror(errno))};
  }
  std::unique_ptr<LocalPool> pool(new LocalPool(options));
  for (Slot& slot : pool->slots_) {
    TRY(pool->StartWorker(slot, now));
  }
  return pool;
}

LocalPool::LocalPool(const LocalPoolOptions& options) : options_(options) {
  slots_.resize(static_cast<std::size_t>(options.workers));
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i].log_file = fmt::format("{}/worker-{}.log", options.log_directory, i + 1);
  }
}

LocalPool::~LocalPool() {
  SignalAll(SIGTERM);
  SignalAll(SIGCONT);  // a stopped process does not see SIGTERM
  const TimePoint deadline = std::chrono::steady_clock::now() + milliseconds(kGraceMilliseconds);
  for (Slot& slot : slots_) {
    if (slot.pid < 0) continue;
    if (slot.pidfd.valid()) {
      const auto left =
          std::chrono::duration_cast<milliseconds>(deadline - std::chrono::steady_clock::now()).count();
      pollfd wait{slot.pidfd.get(), POLLIN, 0};
      poll(&wait, 1, static_cast<int>(std::max<std::int64_t>(0, left)));
    }
    kill(-slot.pid, SIGKILL);  // it is not reaped yet, so the process group is still its own
    while (waitpid(slot.pid, nullptr, 0) < 0 && errno == EINTR) continue;
  }
}

Status LocalPool::StartWorker(Slot& slot, TimePoint now) {
  const UniqueFd nothing(open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (!nothing.valid()) return SystemError("cannot open /dev/null", errno);
  TRY(const UniqueFd log, OpenRegularFile(slot.log_file, O_WRONLY | O_CREAT | O_APPEND, kReadableByAll));
  const int failed =
      Spawn({options_.program, "--access", options_.access_file, "--die-with-parent",
             std::to_string(getpid()), "--quiet", "--log", slot.log_file},
            {.streams = {nothing.get(), log.get(), log.get()}, .flags = POSIX_SPAWN_SETSID}, slot.pid);
  if (failed != 0) {
    slot.pid = -1;
    return SystemError(fmt::format("cannot start {}", options_.program), failed);
  }
  slot.pidfd = OpenProcess(slot.pid);  // without one, Supervise finds out
  slot.started = now;
  return Ok{};
}

void LocalPool::Bury(Slot& slot, int status, TimePoint now) {
  const pid_t pid = std::exchange(slot.pid, -1);
  slot.pidfd.Reset();
  if (!replacing_) return;

  // An end from outside says nothing about whether the program can start.
  const bool from_outside =
      WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM);
  const bool failed_start = !from_outside && now - slot.started < options_.start_time;
  slot.failed_starts = failed_start ? slot.failed_starts + 1 : 0;
  const int exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (slot.failed_starts > options_.start_attempts || (failed_start && exit_status == kRefusesToStart)) {
    const std::string tail = TailOf(slot.log_file);
    error_ =
        Error{KindOfEnd(exit_status),
              fmt::format("workers do not stay alive: {} ended {} in a row within {:.3g} s of its start, the "
                          "last time with {}; {} {}",
                          options_.program,
                          slot.failed_starts == 1 ? "once" : fmt::format("{} times", slot.failed_starts),
                          std::chrono::duration<double>(options_.start_time).count(), EndingOf(status),
                          slot.log_file, tail.empty() ? "is empty" : "ends: " + tail)};
    return;
  }
  slot.start_again = now + DelayAfter(slot.failed_starts);
  events_.push_back(
      {event::kWorkerDied,
       fmt::format("worker process {} ended with {}; another one takes its place", pid, EndingOf(status))});
}

void LocalPool::Postpone(Slot& slot, const Status& failure, TimePoint now) {
  if (++slot.failed_starts > options_.start_attempts && running() == 0) {
    error_ = failure;
    return;
  }
  slot.start_again = now + DelayAfter(slot.failed_starts + 1);
  if (slot.failed_starts == 1) {
    events_.push_back({event::kWorkerNotStarted, fmt::format("{}; trying again", failure.error().message)});
  }
}

Result<std::vector<pid_t>> LocalPool::Supervise(TimePoint now) {
  if (!error_) return error_.error();
  std::vector<pid_t> ended;
  for (Slot& slot : slots_) {
    if (slot.pid < 0) continue;
    siginfo_t info{};
    if (waitid(P_PID, static_cast<id_t>(slot.pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
        info.si_pid == 0) {
      continue;
    }
    // What the worker started goes with it. Before it is reaped: the group is certainly its own.
    kill(-slot.pid, SIGKILL);
    int status = 0;
    while (waitpid(slot.pid, &status, 0) < 0 && errno == EINTR) continue;
    ended.push_back(slot.pid);
    Bury(slot, status, now);
  }
  for (Slot& slot : slots_) {
    if (slot.pid >= 0 || !replacing_ || !error_ || slot.start_again > now) continue;
    if (Status started = StartWorker(slot, now); !started) Postpone(slot, started, now);
  }
  return ended;
}

void LocalPool::AppendWaitFds(std::vector<int>& fds) const {
  for (const Slot& slot : slots_) {
    if (slot.pidfd.valid()) fds.push_back(slot.pidfd.get());
  }
}

int LocalPool::running() const {
  return static_cast<int>(
      std::count_if(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.pid >= 0; }));
}

std::vector<pid_t> LocalPool::pids() const {
  std::vector<pid_t> pids;
  for (const Slot& slot : slots_) {
    if (slot.pid >= 0) pids.push_back(slot.pid);
  }
  return pids;
}

void LocalPool::SignalAll(int signal) {
  for (const Slot& slot : slots_) {
    // Workers pass on what their runners should know; against SIGKILL they can do nothing.
    if (slot.pid >= 0) kill(signal == SIGKILL ? -slot.pid : slot.pid, signal);
  }
}

}  // namespace gauntlet
