#include "master/dispatch/worker_program.h"

#include <fmt/format.h>

#include <csignal>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/system/process_call.h"
#include "master/dispatch/local_pool.h"
#include "master/dispatch/run_limits.h"
#include "proto/run_codec.h"

namespace gauntlet::master {
namespace {

// A kill comes from outside (a memory killer, an operator): the pure question may be asked again this often.
constexpr int kTries = 3;

// stdout of gauntlet-worker with these arguments; its stderr is ours.
Result<std::string> RunWorkerProgram(std::vector<std::string> arguments, std::string_view input) {
  // With every pose of every tick, a result may be large.
  const CallOptions options{.part_of_us = true, .most_output = std::size_t{1} << 30};
  const std::string program = WorkerProgramPath();
  arguments.insert(arguments.begin(), program);
  for (int attempt = 1;; ++attempt) {
    Result<CallOutput> output = CallProcess(arguments, input, options);
    if (!output) return output.error();
    if (output->exit_code == 0) return std::move(output->out);
    if (output->signal == SIGKILL && attempt < kTries) continue;
    return Error{ErrorKind::kInternal,
                 fmt::format("{} ended {} {}", program, output->signal != 0 ? "by signal" : "with status",
                             output->signal != 0 ? output->signal : output->exit_code)};
  }
}

}  // namespace

Result<sim::RunResult> SimulateInRunner(const sim::RunSpec& spec) {
  const std::string cpu_limit = fmt::format("{}", CpuLimitSeconds(spec.scenario, spec.scenario_parameters));
  Result<std::string> output =
      RunWorkerProgram({"--run-spec", "-", "--cpu-limit", cpu_limit, "--quiet"}, proto::EncodeRunSpec(spec));
  if (!output) return output.error();
  return proto::DecodeRunResult(*output);
}

Result<proto::GoldenHashes> GoldenHashesOfThisMachine(const std::vector<std::string>& controllers) {
  std::vector<std::string> arguments = {"--golden"};
  arguments.insert(arguments.end(), controllers.begin(), controllers.end());
  const Result<std::string> output = RunWorkerProgram(std::move(arguments), {});
  if (!output) return output.error();
  if (output->empty()) return proto::GoldenHashes();
  Result<proto::GoldenHashes> hashes = proto::ReadGoldenHashes(*output);
  if (hashes) return hashes;
  return Error{ErrorKind::kInternal, "gauntlet-worker --golden: " + hashes.error().message};
}

}  // namespace gauntlet::master
