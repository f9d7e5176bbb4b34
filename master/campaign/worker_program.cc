#include "master/campaign/worker_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <vector>

#include "master/dispatch/local_pool.h"
#include "master/dispatch/run_codec.h"

namespace gauntlet::master {
namespace {

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() { Close(); }
  int get() const { return fd_; }
  void Close() {
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
  }

 private:
  int fd_;
};

// Feeds `input` and collects the output at the same time, so that neither side waits for ever on a full pipe.
std::string Converse(FileDescriptor& to_child, std::string_view input, const FileDescriptor& from_child) {
  std::string output;
  std::array<char, 65536> buffer{};
  for (bool open = true; open;) {
    if (input.empty()) to_child.Close();
    std::array<pollfd, 2> waiting = {{{from_child.get(), POLLIN, 0}, {to_child.get(), POLLOUT, 0}}};
    if (poll(waiting.data(), to_child.get() >= 0 ? 2 : 1, -1) < 0) {
      if (errno == EINTR) continue;
      break;
    }
    if (to_child.get() >= 0 && (waiting[1].revents & (POLLOUT | POLLERR)) != 0) {
      const ssize_t written = write(to_child.get(), input.data(), input.size());
      if (written > 0) input.remove_prefix(static_cast<std::size_t>(written));
      if (written < 0 && errno != EAGAIN && errno != EINTR) input = {};
    }
    if (waiting[0].revents != 0) {
      const ssize_t size = read(from_child.get(), buffer.data(), buffer.size());
      if (size > 0) output.append(buffer.data(), static_cast<std::size_t>(size));
      open = size > 0 || (size < 0 && (errno == EINTR || errno == EAGAIN));
    }
  }
  return output;
}

// A kill comes from outside (a memory killer, an operator): the pure question may be asked again this often.
constexpr int kTries = 3;

// stdout of gauntlet-worker with these arguments; its stderr is ours. `killed`: SIGKILL ended it.
Result<std::string> RunWorkerProgramOnce(std::vector<std::string> arguments, std::string_view input,
                                         bool& killed) {
  const std::string program = WorkerProgramPath();
  std::array<int, 2> in{};
  std::array<int, 2> out{};
  if (pipe2(in.data(), O_CLOEXEC) != 0)
    return Error{ErrorKind::kIo, fmt::format("no pipe: {}", std::strerror(errno))};
  FileDescriptor child_in(in[0]);
  FileDescriptor to_child(in[1]);
  if (pipe2(out.data(), O_CLOEXEC) != 0)
    return Error{ErrorKind::kIo, fmt::format("no pipe: {}", std::strerror(errno))};
  FileDescriptor from_child(out[0]);
  FileDescriptor child_out(out[1]);
  fcntl(to_child.get(), F_SETFL, O_NONBLOCK);

  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, child_in.get(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, child_out.get(), STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);  // the master ignores it, which a child would inherit
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, program.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    return Error{ErrorKind::kIo, fmt::format("cannot start {}: {}", program, std::strerror(error))};
  child_in.Close();
  child_out.Close();

  struct sigaction ignore {};
  struct sigaction previous {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &previous);
  std::string output = Converse(to_child, input, from_child);
  sigaction(SIGPIPE, &previous, nullptr);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return Error{ErrorKind::kInternal,
                 fmt::format("{} ended {} {}", program, WIFSIGNALED(status) ? "by signal" : "with status",
                             WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status))};
  }
  return output;
}

Result<std::string> RunWorkerProgram(const std::vector<std::string>& arguments, std::string_view input) {
  for (int attempt = 1;; ++attempt) {
    bool killed = false;
    Result<std::string> output = RunWorkerProgramOnce(arguments, input, killed);
    if (!killed || attempt == kTries) return output;
  }
}

}  // namespace

Result<sim::RunResult> SimulateInRunner(std::string_view spec) {
  Result<std::string> output = RunWorkerProgram({"--run-spec", "-"}, spec);
  if (!output) return output.error();
  return DecodeRunResult(*output);
}

Result<std::uint64_t> GoldenHashOfThisMachine() {
  Result<std::string> output = RunWorkerProgram({"--golden"}, {});
  if (!output) return output.error();
  std::uint64_t hash = 0;
  const std::string& text = *output;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (error != std::errc() || end - text.data() != 16) {
    return Error{ErrorKind::kInternal,
                 fmt::format("gauntlet-worker --golden printed '{}', not a hash", text)};
  }
  return hash;
}

}  // namespace gauntlet::master
