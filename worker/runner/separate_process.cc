#include "worker/runner/separate_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <stdio_ext.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "base/system/atomic_file.h"
#include "base/system/process_tree.h"
#include "base/system/resource_limits.h"
#include "base/system/unique_fd.h"
#include "proto/messages.h"
#include "worker/runner/confinement.h"
#include "worker/runner/fork_server.h"
#include "worker/runner/shifted_clock.h"

namespace gauntlet::worker {
namespace {

// The largest file that it may write.
constexpr rlim_t kMostFileBytes = rlim_t{64} << 20;
// No two processes that live at about the same time have clocks of the same time, and no clock is more than
// an hour ahead.
constexpr pid_t kMostShift = 3600;  // s
constexpr rlim_t kMostResultBytes = rlim_t{1} << 30;
// The memory of a larger one is given back.
constexpr std::uint64_t kKeptResultBytes = 1 << 20;

rlim_t CpuLimitOf(const SeparateOptions& options) {
  return static_cast<rlim_t>(std::ceil(options.cpu_limit_seconds));
}

void WriteToStderr(std::string_view text) {
  // Best effort: there is nobody else to tell.
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
}

[[noreturn]] void OutOfMemory() {
  WriteToStderr("out of memory\n");
  _exit(kExitOutOfMemory);
}

// Lets what the process allocates from here on lie on pages of 2 MB where the system has them. A new process
// pays for its first touch of every page. Measured: 1.7 us for one of 4 kB, of which a run takes hundreds,
// and 50 us for one of 2 MB. Malloc takes what is new from the end of its heap.
void UseLargePages() {
  constexpr std::uintptr_t kPage = 4096;                          // bytes
  constexpr std::uintptr_t kLargePage = std::uintptr_t{2} << 20;  // bytes, of x86-64
  constexpr std::uintptr_t kAdvised = 2 * kLargePage;             // more than most runs need
  constexpr int kMostOfHeap = 32 << 20;                           // the largest block that comes from it
  mallopt(M_MMAP_THRESHOLD, kMostOfHeap);
  mallopt(M_TRIM_THRESHOLD, kMostOfHeap);
  mallopt(M_TOP_PAD, static_cast<int>(kAdvised + kLargePage));
  // What lies before the first large page is skipped: allocated and, but for its first byte, never touched.
  const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
  const std::uintptr_t first = (end + 2 * kPage + kLargePage - 1) / kLargePage * kLargePage;
  auto* const skipped = static_cast<volatile char*>(std::malloc(first - end - kPage));
  if (skipped == nullptr) return;
  *skipped = 0;  // or else the compiler leaves the allocation out
  // A wish: where it is not granted, the memory is as good.
  madvise(reinterpret_cast<void*>(first), kAdvised, MADV_HUGEPAGE);
}

[[noreturn]] void LiveSeparately(const std::function<std::string()>& work, const SeparateOptions& options,
                                 pid_t parent, const ResultFile& result) {
  setpgid(0, 0);
  ShowToOthers();
  if (!DieWithParent(parent)) _exit(0);
  if (!MoveInto(options.scratch)) _exit(kExitWithoutPlugin);
  LimitTime(options);
  // Whoever catches the signal is killed a second later.
  if (options.cpu_limit_seconds > 0.0) SetHardLimit(RLIMIT_CPU, CpuLimitOf(options), 1);
  ShiftTimeOfDay(std::chrono::seconds(getpid() % kMostShift));
  UseLargePages();
  const std::string bytes = CallOrEnd(work);
  std::fflush(nullptr);
  if (!result.Write(bytes)) {
    if (errno == ENOSPC || errno == ENOMEM) OutOfMemory();
    _exit(kExitUnheard);
  }
  _exit(0);
}

}  // namespace

Result<ResultFile> ResultFile::Make() {
  ResultFile made;
  made.file_.Reset(memfd_create("result", MFD_CLOEXEC));
  rlimit files{};
  if (!made.file_.valid() || getrlimit(RLIMIT_FSIZE, &files) != 0 ||
      ftruncate(made.file_.get(), static_cast<off_t>(std::min(files.rlim_cur, kMostResultBytes))) != 0)
    return SystemError("cannot make a file in memory", errno);
  return made;
}

void ResultFile::Clear() const {
  constexpr std::uint64_t kNothing = 0;
  // What cannot be cleared is not read either.
  [[maybe_unused]] const ssize_t written = pwrite(file_.get(), &kNothing, sizeof kNothing, 0);
}

bool ResultFile::Write(const std::string& bytes) const {
  const std::uint64_t written = bytes.size() + 1;  // 0 says that nothing was
  // Limits of files are for what is written, not for what is mapped.
  void* const begin = mmap(nullptr, sizeof written + bytes.size(), PROT_WRITE, MAP_SHARED, file_.get(), 0);
  if (begin == MAP_FAILED) return false;
  std::memcpy(static_cast<char*>(begin) + sizeof written, bytes.data(), bytes.size());
  std::memcpy(begin, &written, sizeof written);
  return true;
}

std::optional<std::string> ResultFile::Read() const {
  std::uint64_t size = 0;
  if (pread(file_.get(), &size, sizeof size, 0) != sizeof size || size-- == 0 || size > kMostResultBytes)
    return std::nullopt;
  std::string bytes(size, '\0');
  if (pread(file_.get(), bytes.data(), size, sizeof size) != static_cast<ssize_t>(size)) return std::nullopt;
  if (size > kKeptResultBytes)
    fallocate(file_.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0,
              static_cast<off_t>(sizeof size + size));
  return bytes;
}

bool OnlyOthersSend(int signal) {
  // SIGPIPE: the supervisor has closed the pipe.
  constexpr std::array kSignals = {SIGKILL, SIGTERM, SIGINT,  SIGHUP, SIGQUIT,
                                   SIGPIPE, SIGUSR1, SIGUSR2, SIGPWR};
  return std::ranges::find(kSignals, signal) != kSignals.end();
}

void LimitForGood(const SeparateOptions& options) {
  SetHardLimit(RLIMIT_CORE, 0);
  SetHardLimit(RLIMIT_FSIZE, kMostFileBytes);
  if (options.memory_limit_bytes > 0) SetHardLimit(RLIMIT_AS, rlim_t{options.memory_limit_bytes});
}

void LimitTime(const SeparateOptions& options) {
  if (options.cpu_limit_seconds > 0.0) SetSoftLimit(RLIMIT_CPU, CpuLimitOf(options));
  if (options.wall_limit_seconds > 0) alarm(options.wall_limit_seconds);
}

bool MoveInto(const std::string& folder) {
  __fpurge(stdout);  // what this process' parent had not yet written is not this one's to say
  if (chdir(folder.c_str()) != 0) return false;
  const char* const temporary = getenv("TMPDIR");
  if ((temporary == nullptr || temporary != folder) && setenv("TMPDIR", folder.c_str(), /*replace=*/1) != 0)
    return false;
  const UniqueFd output(
      open(kOutputFile, O_WRONLY | O_CREAT | O_APPEND | O_TRUNC | O_CLOEXEC, kReadableByAll));
  const UniqueFd nothing(open("/dev/null", O_RDONLY | O_CLOEXEC));
  return output.valid() && nothing.valid() && dup2(nothing.get(), STDIN_FILENO) >= 0 &&
         dup2(output.get(), STDOUT_FILENO) >= 0 && dup2(output.get(), STDERR_FILENO) >= 0 &&
         setvbuf(stdout, nullptr, _IOLBF, 0) == 0;
}

int WaitForGroup(pid_t child) {
  siginfo_t ended{};
  while (waitid(P_PID, static_cast<id_t>(child), &ended, WEXITED | WNOWAIT) != 0 && errno == EINTR) continue;
  kill(-child, SIGKILL);  // it is not reaped yet, so the process group is still its own
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

std::string OutputTail(const std::string& folder) {
  const Result<std::string> output = ReadSmallFile(folder + "/" + kOutputFile, kMostFileBytes);
  if (!output) return "";
  return output->substr(output->size() - std::min(output->size(), proto::kMaxStderrTail));
}

double SecondsWithChildren() {
  double seconds = 0.0;
  for (const int whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    if (getrusage(whose, &usage) == 0) seconds += CpuSecondsOf(usage);
  }
  return seconds;
}

std::string CallOrEnd(const std::function<std::string()>& work) {
  std::set_new_handler(OutOfMemory);
  try {
    return work();
  } catch (const std::bad_alloc&) {
    OutOfMemory();
  } catch (const std::exception& error) {
    std::fflush(nullptr);
    WriteToStderr(fmt::format("uncaught exception: {}\n", error.what()));
  } catch (...) {
    std::fflush(nullptr);
    WriteToStderr("uncaught exception of an unknown type\n");
  }
  _exit(kExitException);
}

Result<SeparateOutcome> CallInSeparateProcess(const std::function<std::string()>& work,
                                              const SeparateOptions& options, const ResultFile& result) {
  result.Clear();
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return SystemError("cannot start a process", errno);
  if (child == 0) LiveSeparately(work, options, parent, result);

  SeparateOutcome outcome;
  rusage usage{};
  while (wait4(child, &outcome.wait_status, 0, &usage) < 0 && errno == EINTR) continue;
  EndProcessesBelow();
  const bool killed = WIFSIGNALED(outcome.wait_status) && WTERMSIG(outcome.wait_status) == SIGKILL;
  if (killed && options.cpu_limit_seconds > 0.0 && CpuSecondsOf(usage) >= options.cpu_limit_seconds)
    outcome.wait_status = SIGXCPU;  // as if it had not caught that signal
  if (outcome.wait_status == 0) outcome.bytes = result.Read();
  if (!outcome.bytes) outcome.output_tail = OutputTail(options.scratch);
  return outcome;
}

void EndBySignal(int number, const char* what) {
  if (OnlyOthersSend(number) && number != SIGKILL) {
    WriteToStderr(fmt::format("{} ended its process by signal {} ({})\n", what, number, strsignal(number)));
    _exit(kExitSignalled + number);
  }
  SetSoftLimit(RLIMIT_CORE, 0);
  signal(number, SIG_DFL);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, number);
  sigprocmask(SIG_UNBLOCK, &only, nullptr);
  raise(number);
  _exit(kExitSignalled + number);  // of a signal that ends nobody
}

void EndAs(const SeparateOutcome& outcome) {
  WriteToStderr(outcome.output_tail);
  if (WIFSIGNALED(outcome.wait_status)) EndBySignal(WTERMSIG(outcome.wait_status), "the plug-in");
  const int code = WEXITSTATUS(outcome.wait_status);
  if (code == kExitUnheard)
    WriteToStderr("the plug-in closed files that are not its own, among them the run's result\n");
  if (code == 0) WriteToStderr("exit(0) was called before the run had a result\n");
  _exit(code == 0 ? kExitWithoutResult : code);
}

}  // namespace gauntlet::worker
