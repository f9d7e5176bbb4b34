#include "worker/command/watched_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fts.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/system/atomic_file.h"
#include "base/system/process_tree.h"
#include "base/system/resource_limits.h"
#include "base/system/unique_fd.h"
#include "worker/runner/confinement.h"
#include "worker/runner/fork_server.h"
#include "worker/runner/pipe.h"
#include "worker/runner/separate_process.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// When a program is looked at first, and how far apart two looks are at most. A look costs up to 1 ms.
constexpr milliseconds kFirstLook{20};
constexpr milliseconds kMostBetweenLooks{250};
// How often is looked whether the machine has many more processes, so that no program takes them all. Such a
// look costs some microseconds.
constexpr milliseconds kCrowdLook{10};
// A program that starts processes without end has as many before it is ended, at most.
constexpr std::size_t kMostProcessesOfUser = 8 * kMostProcesses;
// Its folder is looked at by every fourth.
constexpr int kLooksPerFolder = 4;
// Where the kernel tells no end of a process by a descriptor (before Linux 5.3).
constexpr milliseconds kLookForEnd{10};
constexpr std::uint64_t kBytesPerBlock = 512;  // of st_blocks
constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;
constexpr const char* kUsualPath = "/usr/local/bin:/usr/bin:/bin";

double ChildrensSeconds() {
  rusage usage{};
  return getrusage(RUSAGE_CHILDREN, &usage) == 0 ? CpuSecondsOf(usage) : 0.0;
}

std::uint64_t BytesIn(const std::string& folder) {
  std::string root = folder;
  std::array<char*, 2> roots{root.data(), nullptr};
  FTS* const walk = fts_open(roots.data(), FTS_PHYSICAL | FTS_NOCHDIR, nullptr);
  if (walk == nullptr) return 0;
  std::uint64_t bytes = 0;
  while (const FTSENT* entry = fts_read(walk)) {
    if (entry->fts_info == FTS_F || entry->fts_info == FTS_D)
      bytes += kBytesPerBlock * static_cast<std::uint64_t>(entry->fts_statp->st_blocks);
  }
  fts_close(walk);
  return bytes;
}

std::vector<char*> Pointers(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

void TakeUsualSignals() {
  for (int number = 1; number <= SIGRTMAX; ++number) signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

// What the new process needs, made before it exists.
struct Image {
  std::string path;
  std::vector<char*> arguments;
  std::vector<char*> environment;
  std::array<UniqueFd, 3> streams;
  SocketPair socket;  // by which it hands the listener over, and then says why there is no program
};

Result<Image> MakeImage(const WatchedOptions& options) {
  Image image;
  TRY(image.path, FindProgram(options.arguments.at(0), options.environment, options.folder));
  image.arguments = Pointers(options.arguments);
  image.environment = Pointers(options.environment);
  image.streams[STDIN_FILENO].Reset(open("/dev/null", O_RDONLY | O_CLOEXEC));
  for (const auto& [stream, name] :
       {std::pair(STDOUT_FILENO, &options.stdout_file), std::pair(STDERR_FILENO, &options.stderr_file)}) {
    const std::string file = options.folder + "/" + *name;
    image.streams[static_cast<std::size_t>(stream)].Reset(
        open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, kReadableByAll));
    if (!image.streams[static_cast<std::size_t>(stream)].valid())
      return SystemError(fmt::format("cannot write {}", file), errno);
  }
  TRY(image.socket, MakeSocketPair(SOCK_SEQPACKET));
  return image;
}

[[noreturn]] void BecomeProgram(const Image& image, const WatchedOptions& options, pid_t parent) {
  const int socket = image.socket.second.get();
  setsid();
  if (!DieWithParent(parent)) _exit(0);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    dup2(image.streams[static_cast<std::size_t>(stream)].get(), stream);
  CloseAllBut({socket});
  if (options.group != nullptr) ControlGroup::EndThisFirst();
  SetHardLimit(RLIMIT_CORE, 0);
  if (options.disk_bytes > 0) SetHardLimit(RLIMIT_FSIZE, rlim_t{options.disk_bytes});
  // Of all processes of our user, other runs among them; of a super-user's, none.
  if (const std::size_t tasks = TasksOfMachine(); tasks > 0)
    SetHardLimit(RLIMIT_NPROC, tasks + kMostProcessesOfUser);
  for (const __rlimit_resource ours : {RLIMIT_AS, RLIMIT_CPU}) SetSoftLimit(ours, RLIM_INFINITY);
  TakeUsualSignals();
  int failed = chdir(options.folder.c_str()) == 0 ? 0 : errno;
  if (options.confine) {
    const UniqueFd listener = ConfineToTree(Starting::kFree);
    const std::array descriptors{listener.get()};
    SendPacket(socket, "c", {descriptors.data(), listener.valid() ? std::size_t{1} : std::size_t{0}});
  }
  if (failed == 0) {
    execve(image.path.c_str(), image.arguments.data(), image.environment.data());
    failed = errno;
  }
  SendPacket(socket, {reinterpret_cast<const char*>(&failed), sizeof failed}, {});
  _exit(kExitWithoutPlugin);
}

Error NotExecuted(const std::string& path, int failed) {
  const bool of_program = failed == ENOENT || failed == EACCES || failed == ENOEXEC || failed == ENOTDIR ||
                          failed == EPERM || failed == ELOOP;
  const std::string what = fmt::format("the program {} cannot be executed", path);
  if (!of_program) return SystemError(what, failed);
  const char* const why = failed == ENOENT    ? "the interpreter that it names is not there"
                          : failed == ENOEXEC ? "it is no program of this machine, and names no interpreter"
                                              : std::strerror(failed);
  return {ErrorKind::kNotFound, fmt::format("{}: {}", what, why)};
}

ExceededLimit MetIn(const ControlGroup* group) {
  if (group == nullptr) return ExceededLimit::kNone;
  if (group->OutOfMemory()) return ExceededLimit::kMemory;
  return group->OutOfProcesses() ? ExceededLimit::kProcesses : ExceededLimit::kNone;
}

// Looks at a program and what it has started, children and orphans of this process.
class Watch {
 public:
  // `before`: the CPU time of this process' children when the program was started, s.
  Watch(const WatchedOptions& options, pid_t program, double before, UniqueFd listener)
      : options_(options), program_(program), before_(before) {
    end_.Reset(static_cast<int>(syscall(SYS_pidfd_open, program, 0)));
    // Orphans are below this process, not below the program.
    if (listener.valid()) guard_.emplace(std::move(listener), getpid());
  }

  // Until the program has ended, or a limit is exceeded.
  ExceededLimit Wait() {
    const Clock::time_point begin = Clock::now();
    const Clock::time_point wall_end = options_.wall_limit > 0.0
                                           ? begin + std::chrono::duration_cast<Clock::duration>(
                                                         std::chrono::duration<double>(options_.wall_limit))
                                           : Clock::time_point::max();
    const std::size_t before = TasksOfMachine();
    milliseconds between = kFirstLook;
    Clock::time_point next_look = begin + between;
    while (!Ended()) {
      Clock::time_point now = Clock::now();
      if (now >= wall_end) return ExceededLimit::kWall;
      if (TasksOfMachine() > before + kMostProcesses && GroupExceeds(program_, kMostProcesses))
        return ExceededLimit::kProcesses;
      if (now >= next_look) {
        if (const ExceededLimit exceeded = Look(); exceeded != ExceededLimit::kNone) return exceeded;
        between = std::min(2 * between, kMostBetweenLooks);
        now = Clock::now();
        next_look = now + between;
      }
      Sleep(std::min(kCrowdLook, std::chrono::ceil<milliseconds>(std::min(next_look, wall_end) - now)));
    }
    return ExceededLimit::kNone;
  }

 private:
  bool Ended() const {
    siginfo_t ended{};
    return waitid(P_PID, static_cast<id_t>(program_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 ||
           ended.si_pid != 0;
  }

  // Until something happens.
  void Sleep(milliseconds most) {
    std::array<pollfd, 2> polled{{{.fd = end_.get(), .events = POLLIN, .revents = 0},
                                  {.fd = guard_ ? guard_->fd() : -1, .events = POLLIN, .revents = 0}}};
    const milliseconds timeout = end_.valid() ? most : std::min(most, kLookForEnd);
    if (poll(polled.data(), polled.size(), static_cast<int>(timeout.count())) > 0 && guard_)
      guard_->Serve(polled[1].revents);
  }

  ExceededLimit Look() {
    ReapOrphans();
    if (const ExceededLimit exceeded = MetIn(options_.group); exceeded != ExceededLimit::kNone)
      return exceeded;
    double seconds = 0.0;
    if (options_.group != nullptr && options_.group->IsWhole()) {
      seconds = options_.group->CpuSeconds().value_or(0.0);
    } else {
      // First what has ended, or a process that ends meanwhile counts twice.
      seconds = ChildrensSeconds() - before_;
      std::uint64_t bytes = 0;
      const std::vector<pid_t> processes = SampleBelow(getpid());
      if (processes.size() > kMostProcesses) return ExceededLimit::kProcesses;
      for (const pid_t process : processes) {
        seconds += gauntlet::CpuSecondsOf(process);
        bytes += ResidentBytesOf(process);
      }
      if (options_.memory_bytes > 0 && bytes > options_.memory_bytes) return ExceededLimit::kMemory;
    }
    if (options_.cpu_limit > 0.0 && seconds > options_.cpu_limit) return ExceededLimit::kCpu;
    const bool looks_into_folder = options_.disk_bytes > 0 && ++looks_ % kLooksPerFolder == 0;
    return looks_into_folder && BytesIn(options_.folder) > options_.disk_bytes ? ExceededLimit::kDisk
                                                                               : ExceededLimit::kNone;
  }

  void ReapOrphans() const {
    siginfo_t ended{};
    while (waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid != 0 &&
           ended.si_pid != program_) {
      waitpid(ended.si_pid, nullptr, 0);
      ended = {};
    }
  }

  const WatchedOptions& options_;
  pid_t program_;
  double before_;
  UniqueFd end_;  // readable when the program has ended; where the kernel has such descriptors
  std::optional<TreeGuard> guard_;
  int looks_ = 0;
};

}  // namespace

Result<std::string> FindProgram(const std::string& name, const std::vector<std::string>& environment,
                                const std::string& folder) {
  constexpr std::string_view kPath = "PATH=";
  const auto set = std::ranges::find_if(environment, [&](const auto& one) { return one.starts_with(kPath); });
  const std::string path = set == environment.end() ? kUsualPath : set->substr(kPath.size());
  const std::string own = fs::path(folder) / name;
  std::vector<std::string> candidates{own};
  const bool is_path = name.find('/') != std::string::npos;
  std::istringstream parts(is_path ? "" : path);
  for (std::string part; std::getline(parts, part, ':');) {
    if (part.starts_with('/')) candidates.push_back(part + "/" + name);
  }
  struct stat status {};
  for (const std::string& candidate : candidates) {
    if (stat(candidate.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
        access(candidate.c_str(), X_OK) == 0)
      return candidate;
  }
  const bool is_there = stat(own.c_str(), &status) == 0;
  const std::string why = is_there  ? "it is no file that may be executed here"
                          : is_path ? "there is no such file"
                                    : fmt::format("it is in no folder of PATH ({})", path);
  return Error{ErrorKind::kNotFound, fmt::format("the program {} cannot be started: {}", name, why)};
}

Result<WatchedOutcome> RunWatched(const WatchedOptions& options) {
  TRY(Image image, MakeImage(options));
  TakeOrphans();
  if (options.group != nullptr) options.group->Limit({options.memory_bytes, kMostProcesses});
  const double before = ChildrensSeconds();
  const pid_t parent = getpid();
  const pid_t program = fork();
  if (program < 0) return SystemError("cannot start a process", errno);
  if (program == 0) BecomeProgram(image, options, parent);
  image.socket.second.Reset();
  std::optional<Packet> confined;
  if (options.confine) confined = ReceivePacket(image.socket.first.get(), 1, 0);
  UniqueFd listener;
  if (confined && !confined->descriptors.empty()) listener = std::move(confined->descriptors[0]);
  int failed = 0;
  const std::optional<Packet> failure = ReceivePacket(image.socket.first.get(), sizeof failed, 0);
  WatchedOutcome outcome;
  if (!failure) outcome.exceeded = Watch(options, program, before, std::move(listener)).Wait();
  if (outcome.exceeded != ExceededLimit::kNone) kill(-program, SIGKILL);
  outcome.wait_status = WaitForGroup(program);
  EndProcessesBelow();
  if (failure && failure->bytes.size() == sizeof failed) {
    std::memcpy(&failed, failure->bytes.data(), sizeof failed);
    return NotExecuted(image.path, failed);
  }
  if (outcome.exceeded == ExceededLimit::kNone) outcome.exceeded = MetIn(options.group);
  // What a quick one has left is looked at now. Whoever may write no more ends by SIGXFSZ, or as it ends of
  // an error.
  if (outcome.exceeded == ExceededLimit::kNone && options.disk_bytes > 0) {
    const std::uint64_t bytes = BytesIn(options.folder);
    const bool full = bytes > options.disk_bytes || (outcome.wait_status != 0 && bytes == options.disk_bytes);
    const bool ended_by_it = WIFSIGNALED(outcome.wait_status) && WTERMSIG(outcome.wait_status) == SIGXFSZ;
    if (full || ended_by_it) outcome.exceeded = ExceededLimit::kDisk;
  }
  outcome.cpu_seconds = ChildrensSeconds() - before;
  if (options.group != nullptr)
    outcome.cpu_seconds = options.group->CpuSeconds().value_or(outcome.cpu_seconds);
  return outcome;
}

std::string HowItEnded(const WatchedOptions& options, const WatchedOutcome& outcome) {
  constexpr std::string_view kExceeded = "exceeded its limit of ";
  switch (outcome.exceeded) {
    case ExceededLimit::kWall:
      return fmt::format("{}{} s of wall time", kExceeded, options.wall_limit);
    case ExceededLimit::kCpu:
      return fmt::format("{}{} s of CPU time", kExceeded, options.cpu_limit);
    case ExceededLimit::kMemory:
      return fmt::format("{}{} MB of memory", kExceeded, options.memory_bytes / kMegabyte);
    case ExceededLimit::kDisk:
      return fmt::format("{}{} MB in its folder", kExceeded, options.disk_bytes / kMegabyte);
    case ExceededLimit::kProcesses:
      return fmt::format("{}{} processes", kExceeded, kMostProcesses);
    case ExceededLimit::kNone:
      break;
  }
  if (!WIFSIGNALED(outcome.wait_status))
    return fmt::format("ended with exit code {}", WEXITSTATUS(outcome.wait_status));
  const int number = WTERMSIG(outcome.wait_status);
  return fmt::format("was ended by signal {} ({})", number, strsignal(number));
}

std::string TailOf(const std::string& path, std::size_t most_bytes) {
  const UniqueFd file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat status {};
  if (!file.valid() || fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return "";
  std::string tail(std::min(static_cast<std::size_t>(status.st_size), most_bytes), '\0');
  const off_t begin = status.st_size - static_cast<off_t>(tail.size());
  const ssize_t got = pread(file.get(), tail.data(), tail.size(), begin);
  tail.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return tail;
}

}  // namespace gauntlet::worker
