#include "worker/runner/fork_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <set>
#include <span>
#include <vector>

#include "base/system/atomic_file.h"
#include "base/system/process_identity.h"
#include "base/system/process_tree.h"
#include "base/system/resource_limits.h"
#include "worker/runner/confinement.h"
#include "worker/runner/control_group.h"
#include "worker/runner/scratch_folder.h"

namespace gauntlet::worker {
namespace {

// One packet on the control socket; both ends are the same program.
struct ForkServerMessage {
  enum Type : std::int32_t {
    kStart = 1,   // supervisor: fork a runner
    kKill,        // supervisor: send signal `value` to runner `pid`
    kStarted,     // server: runner `pid` lives; two descriptors come along: pipe, output
    kNotStarted,  // server: it could not be forked, `value` = errno
    kExited,      // server: runner `pid` is reaped, `value` = its status, `cpu_seconds` = its whole CPU time
  };
  Type type = kStart;
  pid_t pid = 0;
  std::int32_t value = 0;
  double cpu_seconds = 0.0;
};

// Runners are so much nicer than the supervisor, whose heartbeats must leave in time on the fullest machine.
constexpr int kRunnerNiceness = 5;

bool SendMessage(int control, const ForkServerMessage& message, std::span<const int> descriptors = {}) {
  return SendPacket(control, {reinterpret_cast<const char*>(&message), sizeof message}, descriptors);
}

enum class ReceiveState { kNothing, kEnded, kMessage };
struct ReceivedMessage {
  ForkServerMessage message;
  std::vector<UniqueFd> descriptors;
};

// Does not wait. kEnded also when the packet is damaged.
ReceiveState ReceiveMessage(int control, ReceivedMessage& received) {
  std::optional<Packet> packet = ReceivePacket(control, sizeof received.message, MSG_DONTWAIT);
  if (!packet && errno == EAGAIN) return ReceiveState::kNothing;
  if (!packet || packet->bytes.size() != sizeof received.message) return ReceiveState::kEnded;
  std::memcpy(&received.message, packet->bytes.data(), sizeof received.message);
  received.descriptors = std::move(packet->descriptors);
  return ReceiveState::kMessage;
}

sigset_t ChildSignals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  return set;
}

class Server {
 public:
  Server(UniqueFd control, const RunFunction& run, const PluginSettings& plugins)
      : control_(std::move(control)), run_(run), plugins_(plugins) {
    const sigset_t children = ChildSignals();
    sigprocmask(SIG_BLOCK, &children, nullptr);
    child_signals_.Reset(signalfd(-1, &children, SFD_CLOEXEC | SFD_NONBLOCK));
  }

  [[noreturn]] void Serve() {
    while (true) {
      std::array<pollfd, 2> polled{{{.fd = control_.get(), .events = POLLIN, .revents = 0},
                                    {.fd = child_signals_.get(), .events = POLLIN, .revents = 0}}};
      if (poll(polled.data(), polled.size(), -1) < 0 && errno != EINTR) End();
      if (polled[1].revents != 0) Reap();
      if (polled[0].revents != 0) Obey();
    }
  }

 private:
  void Obey() {
    ReceivedMessage received;
    const ReceiveState state = ReceiveMessage(control_.get(), received);
    if (state == ReceiveState::kNothing) return;
    if (state == ReceiveState::kEnded) End();
    const ForkServerMessage& message = received.message;
    if (message.type == ForkServerMessage::kStart) {
      StartRunner();
    } else if (message.type == ForkServerMessage::kKill && runners_.contains(message.pid)) {
      kill(message.pid, message.value);
    }
  }

  void StartRunner() {
    Result<SocketPair> pipe = MakeSocketPair(SOCK_STREAM);
    std::array<int, 2> output{-1, -1};
    if (!pipe.ok() || pipe2(output.data(), O_CLOEXEC) != 0) {
      return Report({.type = ForkServerMessage::kNotStarted, .value = errno});
    }
    UniqueFd output_reader(output[0]);
    UniqueFd output_writer(output[1]);
    const pid_t server = getpid();
    const pid_t pid = fork();
    if (pid < 0) {
      return Report({.type = ForkServerMessage::kNotStarted, .value = errno});
    }
    if (pid == 0) {
      if (!DieWithParent(server)) _exit(0);
      pipe->first.Reset();
      output_reader.Reset();
      control_.Reset();
      child_signals_.Reset();
      BecomeRunner(std::move(pipe->second), std::move(output_writer));
    }
    runners_.insert(pid);
    const std::array descriptors{pipe->first.get(), output_reader.get()};
    if (!SendMessage(control_.get(), {.type = ForkServerMessage::kStarted, .pid = pid}, descriptors)) End();
  }

  [[noreturn]] void BecomeRunner(UniqueFd pipe, UniqueFd output) {
    // Ctrl-C goes to the whole process group; what it means is the supervisor's decision (SIGINT stays
    // ignored). SIGTERM to a runner alone ends its run as "external".
    signal(SIGTERM, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    const sigset_t children = ChildSignals();
    sigprocmask(SIG_UNBLOCK, &children, nullptr);
    dup2(output.get(), STDOUT_FILENO);
    dup2(output.get(), STDERR_FILENO);
    output.Reset();
    setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + kRunnerNiceness);
    const UniqueFd null(open("/dev/null", O_RDONLY | O_CLOEXEC));
    if (null.valid()) dup2(null.get(), STDIN_FILENO);
    RunnerMain(pipe.get(), run_, plugins_);
  }

  void Reap() {
    signalfd_siginfo info{};
    while (read(child_signals_.get(), &info, sizeof info) > 0) {
    }
    while (true) {
      int status = 0;
      rusage usage{};
      const pid_t pid = wait4(-1, &status, WNOHANG, &usage);
      if (pid <= 0) break;
      if (runners_.erase(pid) == 0) continue;  // left by a runner
      Report({.type = ForkServerMessage::kExited,
              .pid = pid,
              .value = status,
              .cpu_seconds = CpuSecondsOf(usage)});
    }
    EndOrphans();
    ControlGroup::RemoveAbandoned();
  }

  // What the processes of a runner that has ended have started is now a child of this process.
  void EndOrphans() {
    const pid_t self = getpid();
    for (const pid_t process : ProcessesBelow(self)) {
      if (ParentOf(process) == self && !runners_.contains(process)) kill(process, SIGKILL);
    }
  }

  void Report(const ForkServerMessage& message) {
    if (!SendMessage(control_.get(), message)) End();
  }

  [[noreturn]] void End() {
    EndProcessesBelow();
    ScratchFolder::RemoveAbandoned();
    ControlGroup::RemoveAbandoned();
    _exit(0);
  }

  UniqueFd control_;
  UniqueFd child_signals_;
  const RunFunction& run_;
  const PluginSettings& plugins_;
  std::set<pid_t> runners_;
};

// The process' life. Ends when `control` does, as it does with the supervisor, and with it whatever was
// started here. A stopped one would not see that: the supervisor's death continues it.
[[noreturn]] void ForkServerMain(UniqueFd control, const RunFunction& run, const PluginSettings& plugins) {
  TakeOrphans();
  prctl(PR_SET_PDEATHSIG, SIGCONT);
  setpgid(0, 0);  // or a signal that kills the supervisor's group would leave what runs have started
  for (const int ignored : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) signal(ignored, SIG_IGN);
  prctl(PR_SET_NAME, "gauntlet-fork");
  Server(std::move(control), run, plugins).Serve();
}

constexpr std::chrono::milliseconds kEndDeadline{2000};

void CheckSingleThreaded() {
  // ThreadSanitizer runs a thread of its own and copes with forks.
  if (!kMemoryLimitWorks) return;
  std::error_code error;
  const std::filesystem::directory_iterator tasks("/proc/self/task", error);
  if (error) return;
  GAUNTLET_CHECK(std::distance(begin(tasks), end(tasks)) == 1, "the fork server starts before any thread");
}

// Waits up to `deadline` for a child; false when it still runs.
bool ReapWithin(pid_t pid, std::chrono::milliseconds deadline) {
  const auto end = std::chrono::steady_clock::now() + deadline;
  while (true) {
    const pid_t reaped = waitpid(pid, nullptr, WNOHANG);
    if (reaped == pid || (reaped < 0 && errno != EINTR)) return true;
    if (std::chrono::steady_clock::now() >= end) return false;
    const timespec pause{.tv_sec = 0, .tv_nsec = 1'000'000};
    nanosleep(&pause, nullptr);
  }
}

}  // namespace

bool DieWithParent(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  return getppid() == parent;
}

Result<std::unique_ptr<ForkServer>> ForkServer::Start(const RunFunction& run, const PluginSettings& plugins) {
  CheckSingleThreaded();
  TRY(SocketPair control, MakeSocketPair(SOCK_SEQPACKET));
  HideFromOthers();
  const pid_t pid = fork();
  if (pid < 0) return SystemError("cannot start a process", errno);
  if (pid == 0) {
    control.first.Reset();
    ForkServerMain(std::move(control.second), run, plugins);
  }
  return std::unique_ptr<ForkServer>(new ForkServer(pid, std::move(control.first)));
}

ForkServer::~ForkServer() {
  control_.Reset();
  if (ReapWithin(pid_, kEndDeadline)) return;
  kill(pid_, SIGKILL);
  ReapWithin(pid_, kEndDeadline);
}

// The server waits until its answers are read. If we waited likewise until it has read our requests, both
// would for ever, once there are more of them than the two sockets hold (about 280 each way).
void ForkServer::Send(Request request) {
  unsent_.push_back(request);
  Flush();
}

void ForkServer::Flush() {
  while (!unsent_.empty()) {
    const Request& request = unsent_.front();
    const ForkServerMessage message{
        .type = request.runner == 0 ? ForkServerMessage::kStart : ForkServerMessage::kKill,
        .pid = request.runner,
        .value = request.signal};
    const ssize_t sent = send(control_.get(), &message, sizeof message, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (sent < 0) return unsent_.clear();  // it is gone, as Receive will tell
    unsent_.pop_front();
  }
}

std::optional<ForkServerEvent> ForkServer::Receive() {
  if (gone_) return std::nullopt;
  ReceivedMessage received;
  const ReceiveState state = ReceiveMessage(control_.get(), received);
  if (state == ReceiveState::kNothing) return std::nullopt;
  gone_ = state == ReceiveState::kEnded;
  if (gone_) return ForkServerGone{};
  const ForkServerMessage& message = received.message;
  switch (message.type) {
    case ForkServerMessage::kStarted:
      if (received.descriptors.size() < 2) {
        // This process has no room for them (RLIMIT_NOFILE), so nobody could talk to that runner.
        Kill(message.pid, SIGKILL);
        return RunnerNotStarted{EMFILE};
      }
      return RunnerStarted{message.pid, std::move(received.descriptors[0]),
                           std::move(received.descriptors[1])};
    case ForkServerMessage::kNotStarted:
      return RunnerNotStarted{message.value};
    case ForkServerMessage::kExited:
      return RunnerExited{message.pid, message.value, message.cpu_seconds};
    case ForkServerMessage::kStart:
    case ForkServerMessage::kKill:
      break;
  }
  GAUNTLET_CHECK(false,
                 fmt::format("the fork server sent a message of type {}", static_cast<int>(message.type)));
}

}  // namespace gauntlet::worker
