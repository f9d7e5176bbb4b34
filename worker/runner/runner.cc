#include "worker/runner/runner.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <map>

#include "base/canonical_encoder.h"
#include "base/parse_number.h"
#include "base/system/resource_limits.h"
#include "base/utf8.h"
#include "controllers/command/definition.h"
#include "proto/run_codec.h"
#include "worker/command/command_runs.h"
#include "worker/runner/pipe.h"
#include "worker/runner/prepared_process.h"

namespace gauntlet::worker {

using proto::FailureKind;
using proto::RunnerFailure;

namespace {

double SecondsOf(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The soft limits of this process. Remembers what is set, so that most runs cost no system call.
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

 private:
  static void Set(__rlimit_resource resource, rlim_t wanted, std::optional<rlim_t>& now) {
    if (now == wanted) return;
    now = wanted;
    SetSoftLimit(resource, wanted);
  }

  std::optional<rlim_t> cpu_;
  std::optional<rlim_t> memory_;
};

sim::RunResult Refuse(const Error& error) {
  sim::RunResult refused;
  refused.verdict = sim::Verdict::kRefused;
  refused.message = "spec: " + error.message;
  sim::SetHashes(refused);
  return refused;
}

RunnerReport Execute(const RunnerJob& job, const Result<sim::RunSpec>& spec, const RunFunction& run) {
  const double start = SecondsOf(CLOCK_THREAD_CPUTIME_ID);
  sim::RunResult result = spec.ok() ? run(*spec) : Refuse(spec.error());
  RunnerReport report;
  report.cpu_seconds = SecondsOf(CLOCK_THREAD_CPUTIME_ID) - start;
  result.cpu_seconds = report.cpu_seconds;
  report.result = EncodeResult(job, spec.ok() && spec->record_trajectory, result);
  report.process_cpu_seconds = SecondsOf(CLOCK_PROCESS_CPUTIME_ID);
  return report;
}

constexpr std::string_view kEndedWith = "the program ended with exit code ";

// What ExitCodeLine says at the end of a text.
std::optional<int> ExitCodeIn(std::string_view text) {
  const std::size_t begin = text.rfind(kEndedWith);
  if (begin == std::string_view::npos || !text.ends_with('\n')) return std::nullopt;
  text.remove_suffix(1);
  return ParseNumber<int>(text.substr(begin + kEndedWith.size()));
}

[[noreturn]] void EndWithoutPlugin(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  std::fflush(stderr);
  _exit(kExitWithoutPlugin);
}

// Runs of plug-ins. Each gets a process of its own, which begins with the library as freshly loaded and does
// nothing to this one.
class PluginRuns {
 public:
  PluginRuns(const PluginSettings& settings, const RunFunction& run) : files_(settings), run_(run) {}

  // The report of the run. Ends this process as that of the run when that one ended without a result.
  std::string Execute(const RunnerJob& job, const sim::RunSpec& spec) {
    PreparedProcess& process = ProcessOf(spec);
    const Result<SeparateOutcome> outcome =
        process.Call(EncodeJob(job), {.cpu_limit_seconds = job.cpu_limit_seconds,
                                      .memory_limit_bytes = kMemoryLimitWorks ? job.memory_limit_bytes : 0,
                                      .scratch = files_.settings().scratch});
    if (!outcome) EndWithoutPlugin(outcome.error());
    std::optional<RunnerReport> report;
    if (outcome->bytes) report = DecodeReport(*outcome->bytes);
    if (!report) {
      processes_.clear();  // reaped, they count as part of this one
      EndAs(*outcome);
    }
    report->process_cpu_seconds = SecondsWithChildren();
    for (const auto& [hash, living] : processes_) report->process_cpu_seconds += living.cpu_seconds();
    return EncodeReport(*report);
  }

  // Ends the processes that have loaded plug-ins; they are started again when they are needed.
  void EndProcesses() { processes_.clear(); }

 private:
  using ControllersAndScenarios = std::pair<std::string, std::string>;

  // The process that has loaded the spec's plug-ins and runs nothing.
  PreparedProcess& ProcessOf(const sim::RunSpec& spec) {
    const ControllersAndScenarios plugins(spec.plugin, spec.scenario_plugin);
    const auto found = processes_.find(plugins);
    if (found != processes_.end()) return found->second;
    const Result<std::vector<PluginFile>> files = files_.Of(spec);
    if (!files) EndWithoutPlugin(files.error());
    const auto load = [this, files = *files] {
      for (const PluginFile& file : files) {
        if (const Status loaded = files_.settings().load(file); !loaded) EndWithoutPlugin(loaded.error());
      }
    };
    const auto work = [this](const std::string& bytes) {
      const std::optional<RunnerJob> job = DecodeJob(bytes);
      GAUNTLET_CHECK(job.has_value(), "a job that does not decode");
      return EncodeReport(worker::Execute(*job, proto::DecodeRunSpec(job->spec), run_));
    };
    return processes_.try_emplace(plugins, load, work, DescriptorsOf(*files)).first->second;
  }

  PluginFiles files_;
  const RunFunction& run_;
  std::map<ControllersAndScenarios, PreparedProcess> processes_;  // by the plug-ins' hashes
};

}  // namespace

std::string EncodeResult(const RunnerJob& job, bool record, const sim::RunResult& result) {
  std::string bytes = job.without_ways && !record
                          ? proto::EncodeWithoutWays(result)
                          : proto::EncodeRunResult(result, record ? proto::TrajectoryEncoding::kInclude
                                                                  : proto::TrajectoryEncoding::kLeaveOut);
  if (job.max_result_bytes > 0 && bytes.size() > job.max_result_bytes)
    bytes = proto::EncodeRunResult(result, proto::TrajectoryEncoding::kLeaveOut);
  return bytes;
}

std::string EncodeJob(const RunnerJob& job) {
  CanonicalEncoder encoder;
  encoder.Double(job.cpu_limit_seconds);
  encoder.Uint(job.memory_limit_bytes);
  encoder.Uint(job.max_result_bytes);
  encoder.Bool(job.without_ways);
  encoder.String(job.spec);
  return encoder.Take();
}

std::optional<RunnerJob> DecodeJob(std::string_view bytes) {
  CanonicalDecoder decoder(bytes);
  RunnerJob job;
  job.cpu_limit_seconds = decoder.Double();
  job.memory_limit_bytes = decoder.Uint();
  job.max_result_bytes = decoder.Uint();
  job.without_ways = decoder.Bool();
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
  if (const auto own = failure.exit_code == kExitOfProgram ? ExitCodeIn(stderr_tail) : std::nullopt) {
    failure.exit_code = *own;
    failure.kind = FailureKind::kCrashed;
    return failure;
  }
  failure.kind = failure.exit_code == kExitOutOfMemory     ? FailureKind::kOutOfMemory
                 : failure.exit_code == kExitWithoutPlugin ? FailureKind::kExternal
                                                           : FailureKind::kCrashed;
  return failure;
}

bool IsWithoutPlugin(const RunnerFailure& failure) {
  return failure.kind == FailureKind::kExternal && failure.exit_code == kExitWithoutPlugin;
}

std::string ExitCodeLine(int exit_code) {
  return fmt::format("{}{}\n", kEndedWith, exit_code);
}

RunnerFailure WaitedTooLong(double wall_seconds) {
  return {.kind = FailureKind::kHung,
          .stderr_tail = fmt::format("no end after {:.0f} s: it waits", wall_seconds)};
}

void RunnerMain(int pipe, const RunFunction& run, const PluginSettings& plugins) {
  SetSoftLimit(RLIMIT_CORE, 0);
  Limits limits;
  PluginRuns plugin_runs(plugins, run);
  CommandRuns command_runs(plugins);
  FrameBuffer messages;
  while (true) {
    const std::optional<std::string> message = messages.Next();
    if (!message) {
      if (messages.ReadFrom(pipe, FrameBuffer::Wait::kYes) != FrameBuffer::State::kOpen) _exit(0);
      continue;
    }
    const std::optional<RunnerJob> job = DecodeJob(*message);
    GAUNTLET_CHECK(job.has_value(), "a job that does not decode");
    limits.Set(*job, SecondsOf(CLOCK_PROCESS_CPUTIME_ID));
    const std::string report = CallOrEnd([&] {
      const Result<sim::RunSpec> spec = proto::DecodeRunSpec(job->spec);
      const bool of_plugins = spec.ok() && !(spec->plugin.empty() && spec->scenario_plugin.empty());
      if (of_plugins && spec->scenario == controllers::command::kScenario) {
        plugin_runs.EndProcesses();  // or the program's end would be theirs
        return command_runs.Execute(*job, *spec);
      }
      if (of_plugins) return plugin_runs.Execute(*job, *spec);
      return EncodeReport(Execute(*job, spec, run));
    });
    if (!WriteFrame(pipe, report)) _exit(0);
  }
}

}  // namespace gauntlet::worker
