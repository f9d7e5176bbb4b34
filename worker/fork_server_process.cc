#include "worker/fork_server_process.h"

#include <fcntl.h>
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
#include <csignal>
#include <cstring>
#include <set>

namespace gauntlet::worker {
namespace {

// Runners are so much nicer than the supervisor, whose heartbeats must leave in time on the fullest machine.
constexpr int kRunnerNiceness = 5;
constexpr std::size_t kDescriptors = 2;
constexpr std::size_t kDescriptorBytes = kDescriptors * sizeof(int);

bool SendMessage(int control, ForkServerMessage message, int first = -1, int second = -1) {
  iovec part{.iov_base = &message, .iov_len = sizeof message};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kDescriptorBytes)> space{};
  if (first >= 0) {
    header.msg_control = space.data();
    header.msg_controllen = space.size();
    cmsghdr* rights = CMSG_FIRSTHDR(&header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(kDescriptorBytes);
    const std::array<int, kDescriptors> fds{first, second};
    std::memcpy(CMSG_DATA(rights), fds.data(), kDescriptorBytes);
  }
  ssize_t sent = -1;
  do {
    sent = sendmsg(control, &header, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(sizeof message);
}

void DieWithParent(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);
}

double CpuSecondsOf(const rusage& usage) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

sigset_t ChildSignals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  return set;
}

class Server {
 public:
  Server(UniqueFd control, const RunFunction& run) : control_(std::move(control)), run_(run) {
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
    switch (ReceiveMessage(control_.get(), MSG_DONTWAIT, received)) {
      case ReceiveState::kNothing:
        return;
      case ReceiveState::kEnded:
        End();
      case ReceiveState::kMessage:
        break;
    }
    if (received.message.type == ForkServerMessage::kStart) {
      StartRunner();
    } else if (received.message.type == ForkServerMessage::kKill && runners_.contains(received.message.pid)) {
      kill(received.message.pid, received.message.value);
    }
  }

  void StartRunner() {
    Result<SocketPair> pipe = MakeSocketPair(SOCK_STREAM);
    std::array<int, 2> output{-1, -1};
    if (!pipe.ok() || pipe2(output.data(), O_CLOEXEC) != 0) {
      Report({.type = ForkServerMessage::kNotStarted, .pid = 0, .value = errno, .cpu_seconds = 0.0});
      return;
    }
    UniqueFd output_reader(output[0]);
    UniqueFd output_writer(output[1]);
    const pid_t server = getpid();
    const pid_t pid = fork();
    if (pid < 0) {
      Report({.type = ForkServerMessage::kNotStarted, .pid = 0, .value = errno, .cpu_seconds = 0.0});
      return;
    }
    if (pid == 0) {
      DieWithParent(server);
      pipe->first.Reset();
      output_reader.Reset();
      control_.Reset();
      child_signals_.Reset();
      BecomeRunner(std::move(pipe->second), std::move(output_writer));
    }
    runners_.insert(pid);
    if (!SendMessage(control_.get(),
                     {.type = ForkServerMessage::kStarted, .pid = pid, .value = 0, .cpu_seconds = 0.0},
                     pipe->first.get(), output_reader.get())) {
      End();
    }
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
    RunnerMain(pipe.get(), run_);
  }

  void Reap() {
    signalfd_siginfo info{};
    while (read(child_signals_.get(), &info, sizeof info) > 0) {
    }
    while (true) {
      int status = 0;
      rusage usage{};
      const pid_t pid = wait4(-1, &status, WNOHANG, &usage);
      if (pid <= 0) return;
      runners_.erase(pid);
      Report({.type = ForkServerMessage::kExited,
              .pid = pid,
              .value = status,
              .cpu_seconds = CpuSecondsOf(usage)});
    }
  }

  void Report(const ForkServerMessage& message) {
    if (!SendMessage(control_.get(), message)) End();
  }

  [[noreturn]] void End() {
    for (const pid_t pid : runners_) kill(pid, SIGKILL);
    while (wait4(-1, nullptr, 0, nullptr) > 0 || errno == EINTR) {
    }
    _exit(0);
  }

  UniqueFd control_;
  UniqueFd child_signals_;
  const RunFunction& run_;
  std::set<pid_t> runners_;
};

}  // namespace

ReceiveState ReceiveMessage(int control, int flags, ReceivedMessage& received) {
  iovec part{.iov_base = &received.message, .iov_len = sizeof received.message};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kDescriptorBytes)> space{};
  header.msg_control = space.data();
  header.msg_controllen = space.size();
  ssize_t got = -1;
  do {
    got = recvmsg(control, &header, flags | MSG_CMSG_CLOEXEC);
  } while (got < 0 && errno == EINTR);
  if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return ReceiveState::kNothing;
  if (got != static_cast<ssize_t>(sizeof received.message)) return ReceiveState::kEnded;
  const cmsghdr* rights = CMSG_FIRSTHDR(&header);
  if (rights != nullptr && rights->cmsg_type == SCM_RIGHTS) {
    // The second one is missing when there was room for one only (MSG_CTRUNC).
    std::array<int, kDescriptors> fds{-1, -1};
    std::memcpy(fds.data(), CMSG_DATA(rights),
                std::min<std::size_t>(rights->cmsg_len - CMSG_LEN(0), kDescriptorBytes));
    received.first.Reset(fds[0]);
    received.second.Reset(fds[1]);
  }
  return ReceiveState::kMessage;
}

void ForkServerMain(UniqueFd control, pid_t supervisor, const RunFunction& run) {
  DieWithParent(supervisor);
  signal(SIGINT, SIG_IGN);
  signal(SIGTERM, SIG_IGN);
  signal(SIGHUP, SIG_IGN);
  signal(SIGPIPE, SIG_IGN);
  prctl(PR_SET_NAME, "gauntlet-fork");
  Server(std::move(control), run).Serve();
}

}  // namespace gauntlet::worker
