#include "worker/fork_server.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iterator>

#include "worker/fork_server_process.h"

namespace gauntlet::worker {
namespace {

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

Result<std::unique_ptr<ForkServer>> ForkServer::Start(const RunFunction& run) {
  CheckSingleThreaded();
  Result<SocketPair> control = MakeSocketPair(SOCK_SEQPACKET);
  if (!control.ok()) return control.error();
  const pid_t supervisor = getpid();
  const pid_t pid = fork();
  if (pid < 0) return Error{ErrorKind::kIo, fmt::format("fork: {}", std::strerror(errno))};
  if (pid == 0) {
    control->first.Reset();
    ForkServerMain(std::move(control->second), supervisor, run);
  }
  return std::unique_ptr<ForkServer>(new ForkServer(pid, std::move(control->first)));
}

ForkServer::~ForkServer() {
  control_.Reset();
  if (ReapWithin(pid_, kEndDeadline)) return;
  kill(pid_, SIGKILL);
  ReapWithin(pid_, kEndDeadline);
}

void ForkServer::RequestRunner() {
  Send({});
}

void ForkServer::Kill(pid_t runner, int signal) {
  Send({runner, signal});
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
        .value = request.signal,
        .cpu_seconds = 0.0};
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
  switch (ReceiveMessage(control_.get(), MSG_DONTWAIT, received)) {
    case ReceiveState::kNothing:
      return std::nullopt;
    case ReceiveState::kEnded:
      gone_ = true;
      return ForkServerGone{};
    case ReceiveState::kMessage:
      break;
  }
  const ForkServerMessage& message = received.message;
  switch (message.type) {
    case ForkServerMessage::kStarted:
      if (!received.first.valid() || !received.second.valid()) {
        // This process has no room for them (RLIMIT_NOFILE), so nobody could talk to that runner.
        Kill(message.pid, SIGKILL);
        return RunnerNotStarted{EMFILE};
      }
      return RunnerStarted{message.pid, std::move(received.first), std::move(received.second)};
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
