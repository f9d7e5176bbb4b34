// A runner: a child process that simulates one run after the other under limits, and talks to its supervisor
// by a pipe. What goes wrong in a run ends the runner, never more.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "proto/messages.h"
#include "sim/run_result.h"
#include "sim/run_spec.h"
#include "worker/plugin/plugin_files.h"
#include "worker/runner/separate_process.h"

namespace gauntlet::worker {

// The pure function that a runner calls; worker/run_executor.h has the real one, tests bring their own.
using RunFunction = std::function<sim::RunResult(const sim::RunSpec&)>;

// Sanitizers reserve terabytes of address space: memory limits cannot be set under them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kMemoryLimitWorks = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kMemoryLimitWorks = false;
#else
inline constexpr bool kMemoryLimitWorks = true;
#endif
#else
inline constexpr bool kMemoryLimitWorks = true;
#endif

// Supervisor -> runner.
struct RunnerJob {
  std::string spec;                      // serialized gauntlet.v1.RunSpec
  double cpu_limit_seconds = 0.0;        // 0 = no limit; rounded up to the next whole second of the process
  std::uint64_t memory_limit_bytes = 0;  // address space; 0 = no limit
  std::uint64_t max_result_bytes = 0;    // a larger result is sent without its trajectory; 0 = no limit
  bool without_ways = false;             // nobody wants them (proto::EncodeWithoutWays)
};

// Runner -> supervisor.
struct RunnerReport {
  std::string result;                // serialized gauntlet.v1.RunResult
  double cpu_seconds = 0.0;          // of this run
  double process_cpu_seconds = 0.0;  // of the runner since its start
};

// A result as it was asked for; `record`: with its trajectory.
std::string EncodeResult(const RunnerJob& job, bool record, const sim::RunResult& result);
std::string EncodeJob(const RunnerJob& job);
std::optional<RunnerJob> DecodeJob(std::string_view bytes);
std::string EncodeReport(const RunnerReport& report);
std::optional<RunnerReport> DecodeReport(std::string_view bytes);

// Why a runner ended without a result, from its status (waitpid). Own faults are the signals a process brings
// on itself, SIGXCPU (the CPU limit) and any exit; SIGKILL, SIGTERM and the other signals that only somebody
// else sends are external, and so is that the plug-in of a run cannot be had here (kExitWithoutPlugin).
proto::RunnerFailure ClassifyExit(int wait_status, std::string_view stderr_tail);
// Whether it says that what a run needs cannot be had here.
bool IsWithoutPlugin(const proto::RunnerFailure& failure);
// The last line on stderr of a runner that ends with kExitOfProgram: ClassifyExit takes the code from it.
std::string ExitCodeLine(int exit_code);

// A run that sleeps or waits uses no CPU time, so its limit never ends it. So many times its CPU limit of
// wall time does: so late that a run at work on a crowded machine has met its CPU limit long before.
inline constexpr double kWallPerCpu = 20.0;
// Of a run that had not ended after `wall_seconds`.
proto::RunnerFailure WaitedTooLong(double wall_seconds);

// The child's life: works off jobs from `pipe` until it is closed. Limits apply to this very process. A run
// of a plug-in has a process of its own, under the same limits; as that one ends without a result, this one
// ends.
[[noreturn]] void RunnerMain(int pipe, const RunFunction& run, const PluginSettings& plugins);

}  // namespace gauntlet::worker
