#include "worker/describe_plugin.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "proto/run_failure.h"
#include "worker/runner.h"
#include "worker/worker_state.h"

namespace gauntlet::worker {
namespace {

// Of the time in which a library is loaded and lists its controllers, which takes milliseconds.
constexpr double kCpuSeconds = 10.0;
constexpr unsigned kWallSeconds = 30;
constexpr std::uint64_t kMemoryBytes = kMemoryLimitWorks ? std::uint64_t{2} << 30 : 0;  // as runners have

// What a description begins with, and what a refusal, in what comes back from the process.
constexpr char kDescribed = '+';
constexpr char kRefused = '-';

// In words, why nothing came back.
std::string WhatHappened(const SeparateOutcome& outcome) {
  const proto::RunnerFailure failure = ClassifyExit(outcome.wait_status, outcome.output_tail);
  std::string what = failure.signal == SIGALRM  ? fmt::format("took more than {} s", kWallSeconds)
                     : outcome.wait_status == 0 ? "called exit(0)"
                                                : proto::Describe(failure);
  what += " when it was loaded";
  const std::string& said = failure.stderr_tail;
  if (!said.empty()) what += ", saying: " + said.substr(0, said.find_last_not_of('\n') + 1);
  return what;
}

}  // namespace

int PrintDescription(const std::string& path, const DescribePluginFunction& describe) {
  std::error_code failed;
  const std::string absolute = std::filesystem::absolute(path, failed);
  const auto refuse = [](const std::string& why) {
    fmt::print(stderr, "gauntlet-worker: {}\n", why);
    return kExitRefused;
  };
  const auto work = [&] {
    const Result<std::string> description = describe({.path = absolute, .name = path, .hash = ""});
    return description ? kDescribed + *description : kRefused + description.error().message;
  };
  const Result<SeparateOutcome> outcome = CallInSeparateProcess(work, {.cpu_limit_seconds = kCpuSeconds,
                                                                       .memory_limit_bytes = kMemoryBytes,
                                                                       .wall_limit_seconds = kWallSeconds});
  if (!outcome) return refuse(outcome.error().message);
  if (!outcome->bytes) return refuse(fmt::format("the plug-in {} {}", path, WhatHappened(*outcome)));
  const std::string text = outcome->bytes->substr(1);
  if (outcome->bytes->front() != kDescribed) return refuse(text);
  const bool printed = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  return printed && std::fflush(stdout) == 0 ? kExitDone : kExitInternal;
}

}  // namespace gauntlet::worker
