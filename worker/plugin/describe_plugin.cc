#include "worker/plugin/describe_plugin.h"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/system/process_tree.h"
#include "proto/run_codec.h"
#include "proto/run_failure.h"
#include "worker/runner/prepared_process.h"
#include "worker/runner/runner.h"
#include "worker/worker_state.h"

namespace gauntlet::worker {
namespace {

// Of the time in which a library is loaded and answers, which takes milliseconds.
constexpr double kCpuSeconds = 5.0;
constexpr unsigned kWallSeconds = 30;
constexpr std::uint64_t kMemoryBytes = kMemoryLimitWorks ? std::uint64_t{2} << 30 : 0;  // as runners have

// What an answer begins with, and what a refusal, in what comes back from the process.
constexpr char kAnswered = '+';
constexpr char kRefused = '-';

// In words, why nothing came back.
std::string WhatHappened(const SeparateOutcome& outcome, std::string_view when) {
  const proto::RunnerFailure failure = ClassifyExit(outcome.wait_status, outcome.output_tail);
  std::string what = failure.signal == SIGALRM  ? fmt::format("took more than {} s", kWallSeconds)
                     : outcome.wait_status == 0 ? "called exit(0)"
                                                : proto::Describe(failure);
  what.append(" ").append(when);
  const std::string& said = failure.stderr_tail;
  if (!said.empty()) what += ", saying: " + said.substr(0, said.find_last_not_of('\n') + 1);
  return what;
}

int Refuse(const std::string& why) {
  fmt::print(stderr, "gauntlet-worker: {}\n", why);
  return kExitRefused;
}

// Prints what `ask`, called in a process of its own, says of the library. `when`: in what, for refusals.
// `files`: the descriptors that it needs.
int PrintAnswer(const std::string& library, std::string_view when, std::set<int> files,
                const std::function<Result<std::string>()>& ask) {
  const auto work = [&](const std::string&) {
    const Result<std::string> answer = ask();
    return answer ? kAnswered + *answer : kRefused + answer.error().message;
  };
  TakeOrphans();
  PreparedProcess process([] {}, work, std::move(files));
  const Result<SeparateOutcome> outcome = process.Call("", {.cpu_limit_seconds = kCpuSeconds,
                                                            .memory_limit_bytes = kMemoryBytes,
                                                            .wall_limit_seconds = kWallSeconds});
  process.End();
  EndProcessesBelow();
  if (!outcome) return Refuse(outcome.error().message);
  if (!outcome->bytes) return Refuse(fmt::format("the plug-in {} {}", library, WhatHappened(*outcome, when)));
  const std::string text = outcome->bytes->substr(1);
  if (outcome->bytes->front() != kAnswered) return Refuse(text);
  const bool printed = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  return printed && std::fflush(stdout) == 0 ? kExitDone : kExitInternal;
}

}  // namespace

int PrintDescription(const std::string& path, const DescribePluginFunction& describe) {
  std::error_code failed;
  const std::string absolute = std::filesystem::absolute(path, failed);
  return PrintAnswer(path, "when it was loaded", {},
                     [&] { return describe({.path = absolute, .name = path, .hash = ""}); });
}

int PrintBeginning(const std::string& spec, const PluginSettings& plugins,
                   const DescribeBeginningFunction& describe) {
  const Result<sim::RunSpec> asked = proto::DecodeRunSpec(spec);
  if (!asked) return Refuse("spec: " + asked.error().message);
  PluginFiles libraries(plugins);
  const Result<std::vector<PluginFile>> files = libraries.Of(*asked);
  if (!files) return Refuse(files.error().message);
  std::string names;
  for (const PluginFile& file : *files) names += (names.empty() ? "" : " with ") + file.name;
  return PrintAnswer(names, "when it was asked how a run begins", DescriptorsOf(*files),
                     [&]() -> Result<std::string> {
                       for (const PluginFile& file : *files) {
                         TRY(plugins.load(file));
                       }
                       return describe(*asked);
                     });
}

}  // namespace gauntlet::worker
