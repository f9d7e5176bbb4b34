#include "base/system/resource_limits.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>
#include <string_view>
#include <system_error>

namespace gauntlet {
namespace {

// What every command opens sooner or later: standard streams, database, log, pipes of a child.
constexpr rlim_t kFewestOpenFiles = 64;
constexpr mode_t kWritableByOthers = 022;

struct Limit {
  __rlimit_resource resource;
  rlim_t unit;
  const char* name;  // after the number
};
constexpr std::array<Limit, 5> kLimits = {
    {{RLIMIT_NOFILE, 1, " open files (ulimit -n)"},
     {RLIMIT_NPROC, 1, " processes and threads of this user (ulimit -u)"},
     {RLIMIT_AS, 1024, " kB of address space (ulimit -v)"},
     {RLIMIT_DATA, 1024, " kB of data (ulimit -d)"},
     {RLIMIT_FSIZE, 1024, " kB in a file (ulimit -f)"}}};

// Text of bounded length, made with nothing that a signal handler must not call.
class SafeText {
 public:
  void Add(std::string_view text) {
    const std::size_t count = std::min(text.size(), text_.size() - size_);
    std::copy_n(text.data(), count, text_.data() + size_);
    size_ += count;
  }
  void Add(rlim_t number) {
    std::array<char, 24> digits{};
    std::size_t begin = digits.size();
    do {
      digits[--begin] = static_cast<char>('0' + number % 10);
      number /= 10;
    } while (number > 0);
    Add({digits.data() + begin, digits.size() - begin});
  }
  void AddLimits() {
    bool first = true;
    for (const Limit& limit : kLimits) {
      rlimit now{};
      if (getrlimit(limit.resource, &now) != 0 || now.rlim_cur == RLIM_INFINITY) continue;
      if (!first) Add(", ");
      first = false;
      Add(now.rlim_cur / limit.unit);
      Add(limit.name);
    }
    if (first) Add("none but the machine's own");
  }
  std::string_view text() const { return {text_.data(), size_}; }

 private:
  std::array<char, 600> text_{};
  std::size_t size_ = 0;
};

const char* aborting_program = "";

// Only async-signal-safe calls.
void HandleAbort(int /*signal*/) {
  SafeText text;
  text.Add(aborting_program);
  text.Add(": a library ended this process, which could not get a thread, a file or memory. Limits here: ");
  text.AddLimits();
  text.Add("\n");
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.text().data(), text.text().size());
  _exit(kExitWithoutResources);
}

}  // namespace

Status PrepareProgram() {
  umask(umask(0) | kWritableByOthers);
  std::signal(SIGXFSZ, SIG_IGN);
  return AllowOpenFiles(kFewestOpenFiles, "gauntlet's programs");
}

Status AllowOpenFiles(rlim_t needed, const std::string& who) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= needed) return Ok{};
  if (limit.rlim_max < needed) {
    return InvalidInput(
        fmt::format("{} need up to {} open files, and at most {} are allowed here (ulimit -Hn)", who, needed,
                    limit.rlim_max));
  }
  limit.rlim_cur = needed;
  if (setrlimit(RLIMIT_NOFILE, &limit) == 0) return Ok{};
  return Error{ErrorKind::kIo,
               fmt::format("{} open files cannot be allowed: {}", needed, std::strerror(errno))};
}

void SetSoftLimit(__rlimit_resource resource, rlim_t wanted) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min(wanted, limit.rlim_max);
  setrlimit(resource, &limit);
}

void SetHardLimit(__rlimit_resource resource, rlim_t wanted, rlim_t above) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_max = std::min(wanted + above, limit.rlim_max);
  limit.rlim_cur = std::min(wanted, limit.rlim_max);
  setrlimit(resource, &limit);
}

double CpuSecondsOf(const rusage& usage) {
  double seconds = 0.0;
  for (const timeval& time : {usage.ru_utime, usage.ru_stime})
    seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  return seconds;
}

std::string DescribeLimits() {
  SafeText text;
  text.AddLimits();
  return std::string(text.text());
}

std::optional<Error> ErrorOfResources(const std::exception& exception) {
  const auto missing = [&](std::string_view what) {
    return Error{ErrorKind::kNoSpace,
                 fmt::format("{} could not be had here. Limits here: {}", what, DescribeLimits())};
  };
  if (dynamic_cast<const std::bad_alloc*>(&exception) != nullptr) return missing("memory");
  const auto* system = dynamic_cast<const std::system_error*>(&exception);
  if (system == nullptr) return std::nullopt;
  const std::error_code& code = system->code();
  if (code == std::errc::resource_unavailable_try_again) return missing("a thread or a process");
  if (code == std::errc::not_enough_memory) return missing("memory");
  if (code == std::errc::too_many_files_open || code == std::errc::too_many_files_open_in_system)
    return missing("another open file");
  return std::nullopt;
}

void ExplainAborts(const char* program) {
  aborting_program = program;
  std::signal(SIGABRT, HandleAbort);
}

}  // namespace gauntlet
