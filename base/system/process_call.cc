#include "base/system/process_call.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>

#include "base/system/atomic_file.h"
#include "base/system/unique_fd.h"

extern char** environ;  // NOLINT(readability-redundant-declaration)

namespace gauntlet {
namespace {

using Clock = std::chrono::steady_clock;

struct Pipe {
  UniqueFd read;
  UniqueFd write;
};

// `make` is given room for the two ends.
bool Open(Pipe& pipe, int (*make)(int* ends)) {
  std::array<int, 2> ends{};
  if (make(ends.data()) != 0) return false;
  pipe.read.Reset(ends[0]);
  pipe.write.Reset(ends[1]);
  return true;
}

Error Failure(const std::string& program, const std::string& what) {
  return {ErrorKind::kIo, "cannot call " + program + ": " + what};
}

std::string LastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  constexpr std::size_t kMost = 300;
  const std::size_t begin = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  return text.substr(begin, kMost);
}

// False at its end.
bool ReadSome(int fd, std::string& into, std::size_t most) {
  std::array<char, 65536> buffer{};
  const ssize_t count = read(fd, buffer.data(), buffer.size());
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  if (count == 0) return false;
  into.append(buffer.data(), std::min(static_cast<std::size_t>(count), most - std::min(most, into.size())));
  return true;
}

// False when all is written or nobody reads.
bool WriteSome(int fd, std::string_view& rest) {
  const ssize_t count = send(fd, rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  rest.remove_prefix(static_cast<std::size_t>(count));
  return !rest.empty();
}

// Serves the three pipes until both outputs are at their end, and keeps `most` bytes of each. False at the
// deadline.
bool Converse(Pipe& in, Pipe& out, Pipe& err, std::string_view input, CallOutput& result, std::size_t most,
              Clock::time_point deadline) {
  if (input.empty()) in.write.Reset();
  while (out.read.get() >= 0 || err.read.get() >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    std::array<pollfd, 3> waiting = {pollfd{in.write.get(), POLLOUT, 0}, pollfd{out.read.get(), POLLIN, 0},
                                     pollfd{err.read.get(), POLLIN, 0}};
    if (poll(waiting.data(), waiting.size(), static_cast<int>(std::min<long>(left, 1000))) < 0 &&
        errno != EINTR)
      return false;
    if (waiting[0].revents != 0 && !WriteSome(in.write.get(), input)) in.write.Reset();
    if (waiting[1].revents != 0 && !ReadSome(out.read.get(), result.out, most)) out.read.Reset();
    if (waiting[2].revents != 0 && !ReadSome(err.read.get(), result.err, most)) err.read.Reset();
  }
  return true;
}

// Waits for the child until the deadline, then kills it, or the group that it leads with all that it started.
// False when it had to be killed.
bool Reap(pid_t child, bool leads_group, Clock::time_point deadline, int& status) {
  constexpr int kPollMilliseconds = 5;
  while (true) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child || (ended < 0 && errno != EINTR)) return true;
    if (Clock::now() >= deadline) break;
    poll(nullptr, 0, kPollMilliseconds);
  }
  kill(leads_group ? -child : child, SIGKILL);
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return false;
}

}  // namespace

int Spawn(const std::vector<std::string>& arguments, const SpawnOptions& options, pid_t& child) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    const int ours = options.streams[static_cast<std::size_t>(stream)];
    if (ours >= 0) posix_spawn_file_actions_adddup2(&actions, ours, stream);
  }
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);

  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGCHLD, SIGXFSZ})
    sigaddset(&signals, signal);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(
      &attributes, static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | options.flags));

  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  std::vector<char*> environment;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (!options.inherits || options.inherits(*entry)) environment.push_back(*entry);
  }
  environment.push_back(nullptr);
  const int failed = posix_spawnp(&child, argv[0], &actions, &attributes, argv.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return failed;
}

Result<CallOutput> CallProcess(const std::vector<std::string>& arguments, std::string_view input,
                               const CallOptions& options) {
  const std::string& program = arguments.at(0);
  const Clock::time_point end =
      options.deadline ? Clock::now() + *options.deadline : Clock::time_point::max();
  Pipe in;
  Pipe out;
  Pipe err;
  const auto make = [](int* ends) { return pipe2(ends, O_CLOEXEC); };
  // Writing to a socket whose other end is gone is an error, to a pipe a signal that ends the process.
  const auto make_sockets = [](int* ends) {
    return socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends);
  };
  if (!Open(in, make_sockets) || !Open(out, make) || !Open(err, make)) {
    return SystemError("cannot call " + program, errno);
  }

  pid_t child = -1;
  const int failed =
      Spawn(arguments,
            {.streams = {in.read.get(), out.write.get(), options.part_of_us ? -1 : err.write.get()},
             .flags = options.part_of_us ? 0 : POSIX_SPAWN_SETPGROUP,
             .inherits = options.inherits},
            child);
  if (failed == ENOENT) return Error{ErrorKind::kNotFound, "there is no " + program};
  if (failed != 0) return SystemError("cannot call " + program, failed);
  in.read.Reset();
  out.write.Reset();
  err.write.Reset();

  CallOutput result;
  const bool spoken = Converse(in, out, err, input, result, options.most_output, end);
  int status = 0;
  const bool ended = Reap(child, !options.part_of_us, spoken ? end : Clock::now(), status);
  if (!options.deadline && !spoken) return Failure(program, "its output could not be read");
  if (!spoken || !ended) {
    // A full queue makes sbatch wait and say so.
    const std::string said = result.err.empty() ? "" : "; so far it said: " + LastLine(result.err);
    return Failure(program, "no answer within " +
                                std::to_string(options.deadline ? options.deadline->count() : 0) + " ms" +
                                said);
  }
  constexpr int kSignalBase = 128;
  result.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : kSignalBase + WTERMSIG(status);
  return result;
}

}  // namespace gauntlet
