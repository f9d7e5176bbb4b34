#include "worker/runner.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <ctime>
#include <exception>
#include <new>

#include "base/canonical_encoder.h"
#include "base/utf8.h"
#include "proto/run_codec.h"
#include "worker/pipe.h"

namespace gauntlet::worker {

using proto::FailureKind;
using proto::RunnerFailure;

namespace {

void WriteToStderr(std::string_view text) {
  // Best effort: there is nobody else to tell.
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
}

[[noreturn]] void OutOfMemory() {
  WriteToStderr("out of memory\n");
  _exit(kExitOutOfMemory);
}

double SecondsOf(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The soft limits of this process: a lowered hard limit could never be raised again. Remembers what is set,
// so that most runs cost no system call.
class Limits {
 public:
  // `used`: the CPU time that this process has had, s.
  void Set(const RunnerJob& job, double used) {
    rlim_t cpu = RLIM_INFINITY;
    if (job.cpu_limit_seconds > 0.0) cpu = static_cast<rlim_t>(std::ceil(used + job.cpu_limit_seconds));
    Set(RLIMIT_CPU, cpu, cpu_);
    if (!kMemoryLimitWorks) return;
    Set(RLIMIT_AS, job.memory_limit_bytes == 0 ? RLIM_INFINITY : rlim_t{job.memory_limit_bytes}, memory_);
  }
  static void ForbidCoreDumps() {
    std::optional<rlim_t> unknown;
    Set(RLIMIT_CORE, 0, unknown);
  }

 private:
  static void Set(__rlimit_resource resource, rlim_t wanted, std::optional<rlim_t>& now) {
    if (now == wanted) return;
    now = wanted;
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0) return;
    limit.rlim_cur = std::min(wanted, limit.rlim_max);
    setrlimit(resource, &limit);
  }

  std::optional<rlim_t> cpu_;
  std::optional<rlim_t> memory_;
};

sim::RunResult Refuse(const Error& error) {
  sim::RunResult refused;
  refused.verdict = sim::Verdict::kRefused;
  refused.message = "spec: " + error.message;
  refused.hash = sim::HashOf(refused);
  return refused;
}

RunnerReport Execute(const RunnerJob& job, const RunFunction& run) {
  const double start = SecondsOf(CLOCK_THREAD_CPUTIME_ID);
  const Result<sim::RunSpec> spec = proto::DecodeRunSpec(job.spec);
  sim::RunResult result = spec.ok() ? run(*spec) : Refuse(spec.error());
  RunnerReport report;
  report.cpu_seconds = SecondsOf(CLOCK_THREAD_CPUTIME_ID) - start;
  result.cpu_seconds = report.cpu_seconds;
  const bool record = spec.ok() && spec->record_trajectory;
  report.result = proto::EncodeRunResult(
      result, record ? proto::TrajectoryEncoding::kInclude : proto::TrajectoryEncoding::kLeaveOut);
  if (job.max_result_bytes > 0 && report.result.size() > job.max_result_bytes) {
    report.result = proto::EncodeRunResult(result, proto::TrajectoryEncoding::kLeaveOut);
  }
  report.process_cpu_seconds = SecondsOf(CLOCK_PROCESS_CPUTIME_ID);
  return report;
}

bool OnlyOthersSend(int signal) {
  // SIGPIPE: the supervisor has closed the pipe.
  constexpr std::array kSignals = {SIGKILL, SIGTERM, SIGINT,  SIGHUP, SIGQUIT,
                                   SIGPIPE, SIGUSR1, SIGUSR2, SIGPWR};
  return std::ranges::find(kSignals, signal) != kSignals.end();
}

}  // namespace

std::string EncodeJob(const RunnerJob& job) {
  CanonicalEncoder encoder;
  encoder.Double(job.cpu_limit_seconds);
  encoder.Uint(job.memory_limit_bytes);
  encoder.Uint(job.max_result_bytes);
  encoder.String(job.spec);
  return encoder.Take();
}

std::optional<RunnerJob> DecodeJob(std::string_view bytes) {
  CanonicalDecoder decoder(bytes);
  RunnerJob job;
  job.cpu_limit_seconds = decoder.Double();
  job.memory_limit_bytes = decoder.Uint();
  job.max_result_bytes = decoder.Uint();
  job.spec = decoder.String();
  if (!decoder.ok() || !decoder.AtEnd()) return std::nullopt;
  return job;
}

std::string EncodeReport(const RunnerReport& report) {
  CanonicalEncoder encoder;
  encoder.Double(report.cpu_seconds);
  encoder.Double(report.process_cpu_seconds);
  encoder.String(report.result);
  return encoder.Take();
}

std::optional<RunnerReport> DecodeReport(std::string_view bytes) {
  CanonicalDecoder decoder(bytes);
  RunnerReport report;
  report.cpu_seconds = decoder.Double();
  report.process_cpu_seconds = decoder.Double();
  report.result = decoder.String();
  if (!decoder.ok() || !decoder.AtEnd()) return std::nullopt;
  return report;
}

RunnerFailure ClassifyExit(int wait_status, std::string_view stderr_tail) {
  RunnerFailure failure;
  if (stderr_tail.size() > proto::kMaxStderrTail)
    stderr_tail.remove_prefix(stderr_tail.size() - proto::kMaxStderrTail);
  failure.stderr_tail = ToUtf8(stderr_tail);
  if (WIFSIGNALED(wait_status)) {
    failure.signal = WTERMSIG(wait_status);
    failure.kind = failure.signal == SIGXCPU        ? FailureKind::kHung
                   : OnlyOthersSend(failure.signal) ? FailureKind::kExternal
                                                    : FailureKind::kCrashed;
    return failure;
  }
  failure.exit_code = WEXITSTATUS(wait_status);
  failure.kind = failure.exit_code == kExitOutOfMemory ? FailureKind::kOutOfMemory : FailureKind::kCrashed;
  return failure;
}

RunnerFailure WaitedTooLong(double wall_seconds) {
  return {.kind = FailureKind::kHung,
          .stderr_tail = fmt::format("no end after {:.0f} s: it waits", wall_seconds)};
}

void RunnerMain(int pipe, const RunFunction& run) {
  std::set_new_handler(OutOfMemory);
  Limits::ForbidCoreDumps();
  Limits limits;
  FrameBuffer messages;
  double used = SecondsOf(CLOCK_PROCESS_CPUTIME_ID);
  while (true) {
    const std::optional<std::string> message = messages.Next();
    if (!message) {
      if (messages.ReadFrom(pipe, FrameBuffer::Wait::kYes) != FrameBuffer::State::kOpen) _exit(0);
      continue;
    }
    const std::optional<RunnerJob> job = DecodeJob(*message);
    GAUNTLET_CHECK(job.has_value(), "a job that does not decode");
    limits.Set(*job, used);
    try {
      const RunnerReport report = Execute(*job, run);
      used = report.process_cpu_seconds;
      if (!WriteFrame(pipe, EncodeReport(report))) _exit(0);
    } catch (const std::bad_alloc&) {
      OutOfMemory();
    } catch (const std::exception& error) {
      WriteToStderr(fmt::format("uncaught exception: {}\n", error.what()));
      _exit(kExitException);
    } catch (...) {
      WriteToStderr("uncaught exception of an unknown type\n");
      _exit(kExitException);
    }
  }
}

}  // namespace gauntlet::worker
