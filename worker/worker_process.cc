#include "worker/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "base/system/atomic_file.h"
#include "base/system/resource_limits.h"
#include "proto/access_file.h"
#include "proto/run_codec.h"
#include "proto/run_failure.h"
#include "worker/command/command_environment.h"
#include "worker/command/probe.h"
#include "worker/runner/fork_server.h"
#include "worker/runner/runner_pool.h"
#include "worker/supervisor.h"

namespace gauntlet::worker {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kAccessPollInterval{200};
// Between two looks at a run passes a second; what lies much further apart, this process was stopped.
constexpr double kLongestWaitSeconds = 5.0;

int Complain(const std::string& text, int code) {
  fmt::print(stderr, "gauntlet-worker: {}\n", text);
  return code;
}

int WithoutParent(pid_t parent) {
  return Complain(fmt::format("process {} is not the one that started this one, or has ended", parent),
                  kExitDone);
}

// A runner's pipe and output.
constexpr rlim_t kOpenFilesPerSlot = 2;
// Everything else: sockets, logs, ZeroMQ, and what we inherited.
constexpr rlim_t kOtherDescriptors = 128;

// Error: so many slots need more open files than are allowed.
Status AllowDescriptors(int slots) {
  Status allowed = AllowOpenFiles(kOpenFilesPerSlot * static_cast<rlim_t>(slots) + kOtherDescriptors,
                                  fmt::format("{} slots", slots));
  if (allowed) return allowed;
  return Error{allowed.error().kind,
               allowed.error().message + ": use fewer slots in each of several workers, or raise the limit"};
}

int ExitCodeOf(const Error& error) {
  return error.kind == ErrorKind::kNoSpace ? kExitWithoutResources : kExitInternal;
}

// A signalfd of the signals that stop a worker; they are blocked in this thread and those it starts.
UniqueFd BlockStopSignals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set, signal);
  sigprocmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return UniqueFd(signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK));
}

// nullopt: a signal asked to stop. Error: the file is wrong, or has not come in time (kNotFound), or could
// not be read all that time (kIo).
Result<std::optional<Access>> WaitForAccess(const WorkerOptions& options, int signals) {
  const auto deadline = steady_clock::now() + std::chrono::duration<double>(options.orphan_timeout_seconds);
  bool told_missing = false;
  bool told_unreadable = false;
  while (true) {
    Result<Access> access = ReadAccess(options.access_path);
    if (access.ok()) return std::optional(std::move(*access));
    const bool missing = access.error().kind == ErrorKind::kNotFound;
    // On a network file system what cannot be read now may be there in a moment.
    if (!missing && access.error().kind != ErrorKind::kIo) return access.error();
    if (steady_clock::now() >= deadline) return access.error();
    if (!std::exchange(missing ? told_missing : told_unreadable, true)) {
      if (missing) {
        spdlog::info("waiting for {}: no master serves this campaign now", options.access_path);
      } else {
        spdlog::warn("{}; trying again", access.error().message);
      }
    }
    pollfd stop{.fd = signals, .events = POLLIN, .revents = 0};
    if (poll(&stop, 1, static_cast<int>(kAccessPollInterval.count())) > 0) return std::optional<Access>();
  }
}

ProcessIdentity Identity() {
  ProcessIdentity identity = IdentifyThisProcess();
  // All nodes of a Slurm cluster on one machine share a host name; Slurm's name tells them apart.
  if (const char* node = std::getenv("SLURMD_NODENAME"); node != nullptr) identity.host = node;
  return identity;
}

std::uint64_t RandomId() {
  std::random_device device;
  return std::uniform_int_distribution<std::uint64_t>(1)(device);
}

bool WriteToStdout(std::string_view bytes) {
  return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
}

// "completed: fitness 0.25, hash 0123456789abcdef", "was refused: ...".
std::string DescribeEnd(const Result<sim::RunResult>& result) {
  if (!result) return "gave no readable result";
  if (result->verdict == sim::Verdict::kRefused) return "was refused: " + result->message;
  return fmt::format("completed: fitness {}, hash {:016x}", result->fitness, result->hash);
}

// One job in one fresh runner.
std::variant<EncodedResult, RunnerFailure> RunInRunner(ForkServer& server, const RunnerJob& job) {
  RunnerPool pool(server, 1);
  const auto external = [](const std::string& why) {
    return RunnerFailure{.kind = FailureKind::kExternal, .stderr_tail = why};
  };
  std::optional<steady_clock::time_point> not_started;
  const double wall_limit = kWallPerCpu * job.cpu_limit_seconds;  // 0: none
  std::optional<double> awake;  // s since it began, without what passed while this process was stopped
  auto before = steady_clock::now();
  while (true) {
    const auto woken = steady_clock::now();
    if (awake) {
      *awake += std::min(std::chrono::duration<double>(woken - before).count(), kLongestWaitSeconds);
      if (wall_limit > 0.0 && *awake >= wall_limit) {
        pool.Kill(0);
        return WaitedTooLong(wall_limit);
      }
    }
    before = woken;
    pool.Flush();
    std::vector<pollfd> polled = pool.Descriptors();
    if (poll(polled.data(), polled.size(), 1000) < 0) {
      for (pollfd& item : polled) item.revents = 0;
    }
    for (WorkerEvent& event : pool.Process(polled, steady_clock::now())) {
      if (std::holds_alternative<SlotBecameReady>(event)) {
        pool.StartJob(0, job);
        awake = 0.0;
      } else if (auto* finished = std::get_if<RunFinished>(&event)) {
        return std::move(finished->result);
      } else if (auto* died = std::get_if<RunnerDied>(&event); died != nullptr && died->at_work) {
        return std::move(died->failure);
      } else if (std::holds_alternative<AllRunnersLost>(event)) {
        return external("the fork server ended");
      } else if (const auto* missing = std::get_if<NoRunnerStarted>(&event)) {
        const auto now = steady_clock::now();
        if (!not_started) not_started = now;
        if (now - *not_started >= kNoRunnerPatience) return external(missing->reason);
      }
    }
  }
}

}  // namespace

Status StartLogging(const std::string& file, bool quiet, const LogLimits& limits) {
  try {
    auto to_stderr = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    std::vector<spdlog::sink_ptr> sinks{to_stderr};
    if (!file.empty()) {
      // What ends the worker stands on stderr too: whoever started it may not look into the file.
      to_stderr->set_level(spdlog::level::err);
      sinks.push_back(
          std::make_shared<spdlog::sinks::rotating_file_sink_mt>(file, limits.bytes, limits.former));
    }
    auto logger = std::make_shared<spdlog::logger>("worker", sinks.begin(), sinks.end());
    logger->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
    logger->flush_on(spdlog::level::info);
    logger->set_pattern(fmt::format("%Y-%m-%d %H:%M:%S.%e worker {} %l: %v", getpid()));
    spdlog::set_default_logger(std::move(logger));
  } catch (const spdlog::spdlog_ex& error) {
    return InvalidInput(error.what());
  }
  return Ok{};
}

int RunWorker(const WorkerOptions& options, const RunFunction& run) {
  if (options.parent > 0 && !DieWithParent(options.parent)) return WithoutParent(options.parent);
  if (const Status allowed = AllowDescriptors(options.slots); !allowed.ok()) {
    return Complain(allowed.error().message, kExitRefused);
  }
  PluginSettings plugins = options.plugins;
  plugins.setups = MakeSharedSetups();
  Result<std::unique_ptr<ForkServer>> fork_server = ForkServer::Start(run, plugins);
  if (!fork_server.ok()) return Complain(fork_server.error().message, ExitCodeOf(fork_server.error()));
  ExplainAborts("gauntlet-worker");  // not of the fork server and its runners, whose aborts are theirs
  const UniqueFd signals = BlockStopSignals();
  if (const Status logging = StartLogging(options.log_file, options.quiet); !logging.ok()) {
    return Complain(logging.error().message, kExitRefused);
  }

  Result<std::optional<Access>> access = WaitForAccess(options, signals.get());
  if (!access.ok()) {
    spdlog::error("{}", access.error().message);
    return access.error().kind == ErrorKind::kNotFound ? kExitOrphaned : kExitRefused;
  }
  if (!access->has_value()) return kExitDone;
  Result<proto::GoldenHashes> golden_hashes =
      GoldenHashesOf((*access)->controllers, options.golden_hashes, plugins);
  if (!golden_hashes) {
    spdlog::error("{}", golden_hashes.error().message);
    return kExitRefused;
  }

  SupervisorOptions supervisor_options;
  supervisor_options.access_path = options.access_path;
  supervisor_options.parent = options.parent;
  WorkerSettings& settings = supervisor_options.state;
  settings.orphan_timeout =
      std::chrono::duration_cast<Duration>(std::chrono::duration<double>(options.orphan_timeout_seconds));
  settings.identity = Hello{.campaign_id = (*access)->campaign_id,
                            .instance_id = RandomId(),
                            .software_version = options.software_version,
                            .slots = static_cast<std::uint32_t>(options.slots),
                            .process = Identity(),
                            .allocation = options.allocation,
                            .golden_hashes = *std::move(golden_hashes)};
  spdlog::info("instance {:016x}, {} slot(s), campaign {}, {}", settings.identity.instance_id, options.slots,
               (*access)->campaign_id, (*access)->endpoints.front());
  return Supervise(std::move(supervisor_options), std::move(**access), **fork_server, signals.get());
}

Result<std::string> ReadSpec(const std::string& file) {
  const UniqueFd opened(file == "-" ? dup(STDIN_FILENO) : open(file.c_str(), O_RDONLY | O_CLOEXEC));
  const std::string place = file == "-" ? "stdin" : file;
  if (!opened.valid()) return Error{ErrorKind::kIo, fmt::format("{}: {}", place, std::strerror(errno))};
  return ReadAll(opened.get(), place, kMaxMessageBytes);
}

int RunOneSpec(const SpecOptions& options, const RunFunction& run) {
  if (options.parent > 0 && !DieWithParent(options.parent)) return WithoutParent(options.parent);
  Result<std::unique_ptr<ForkServer>> fork_server = ForkServer::Start(run, options.plugins);
  if (!fork_server.ok()) return Complain(fork_server.error().message, ExitCodeOf(fork_server.error()));
  Result<std::string> spec = ReadSpec(options.spec_file);
  if (!spec.ok()) return Complain(spec.error().message, kExitRefused);

  const auto outcome = RunInRunner(**fork_server, {.spec = std::move(*spec),
                                                   .cpu_limit_seconds = options.cpu_limit_seconds,
                                                   .memory_limit_bytes = options.memory_limit_bytes});
  std::string result;
  if (const auto* given = std::get_if<EncodedResult>(&outcome)) {
    result = *given;
    if (!options.quiet)
      fmt::print(stderr, "gauntlet-worker: the run {}\n", DescribeEnd(DecodeRunResult(result)));
  } else {
    const RunnerFailure& failure = std::get<RunnerFailure>(outcome);
    if (IsWithoutPlugin(failure)) {
      fmt::print(stderr, "gauntlet-worker: {}", failure.stderr_tail);
      return kExitRefused;
    }
    const bool whole_lines = failure.stderr_tail.empty() || failure.stderr_tail.ends_with('\n');
    fmt::print(stderr, "gauntlet-worker: the run {}\n{}{}", Describe(failure), failure.stderr_tail,
               whole_lines ? "" : "\n");
    if (failure.kind == FailureKind::kExternal) return kExitInternal;
    result = EncodeRunResult(ResultOf(failure));
  }
  if (!WriteToStdout(result)) return Complain("the result cannot be written to stdout", kExitInternal);
  return kExitDone;
}

}  // namespace gauntlet::worker
