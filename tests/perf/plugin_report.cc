// plugin_report [RUNS]: what a run costs whose controller is built in, comes from a plug-in with the same
// code, and from one that was written for ARGoS (argos/example): light flocking of 10 robots for 200 and for
// 800 s. User and system CPU of the runner and of all processes that it starts, the same seeds in turn;
// medians, and the medians of each run's ratio to the built-in one.

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/system/atomic_file.h"
#include "base/system/sha256.h"
#include "proto/run_codec.h"
#include "tests/perf/cpu_cost.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"
#include "worker/plugin/plugin_library.h"
#include "worker/run_executor.h"
#include "worker/runner/fork_server.h"
#include "worker/runner/pipe.h"
#include "worker/runner/runner.h"

namespace gauntlet::perf {
namespace {

constexpr std::uint64_t kRuns = 60;
constexpr std::size_t kMostLibrary = std::size_t{64} << 20;  // bytes

class MeasuredRunner {
 public:
  // `library`: "" for a controller that is built in.
  MeasuredRunner(std::string controller, const std::string& library) : controller_(std::move(controller)) {
    if (!library.empty()) plugin_ = Sha256(ReadSmallFile(library, kMostLibrary).value());
    worker::SocketPair pipe = std::move(worker::MakeSocketPair(SOCK_STREAM)).value();
    const pid_t parent = getpid();
    const pid_t child = fork();
    GAUNTLET_CHECK(child >= 0, "no process could be made");
    if (child == 0) {
      if (!worker::DieWithParent(parent)) _exit(0);
      pipe.first.Reset();
      worker::RunnerMain(pipe.second.get(), worker::Run, {.files = {library}, .load = worker::LoadPlugin});
    }
    pipe_ = std::move(pipe.first);
  }

  // CPU time of the run, s.
  double Run(sim::RunSpec spec) {
    spec.controller = controller_;
    spec.plugin = plugin_;
    GAUNTLET_CHECK(worker::WriteFrame(pipe_.get(), worker::EncodeJob({.spec = proto::EncodeRunSpec(spec)})),
                   "the runner takes no job");
    std::optional<std::string> frame;
    while (!(frame = answers_.Next())) {
      const auto state = answers_.ReadFrom(pipe_.get(), worker::FrameBuffer::Wait::kYes);
      GAUNTLET_CHECK(state == worker::FrameBuffer::State::kOpen, "the runner has ended");
    }
    const worker::RunnerReport report = worker::DecodeReport(*frame).value();
    const sim::RunResult result = proto::DecodeRunResult(report.result).value();
    GAUNTLET_CHECK(result.verdict == sim::Verdict::kCompleted, result.message);
    return report.process_cpu_seconds - std::exchange(cpu_seconds_, report.process_cpu_seconds);
  }

 private:
  std::string controller_;
  std::string plugin_;
  UniqueFd pipe_;
  worker::FrameBuffer answers_;
  double cpu_seconds_ = 0.0;  // until the last report
};

// The library of argos/example, made as people make theirs.
std::string BuildExample(const testing_support::TemporaryDirectory& folder) {
  const std::string example = std::string(GAUNTLET_SOURCE_DIR) + "/argos/example/light_flocking";
  const std::string library = folder / "liblight.so";
  const testing_support::ProcessResult built =
      testing_support::RunProcess({GAUNTLET_BINARY_DIR "/gauntlet", "build-controller", example + ".cc",
                                   "--argos", example + ".argos", "-o", library});
  GAUNTLET_CHECK(built.exit_code == 0, built.err);
  return library;
}

void Report(std::vector<MeasuredRunner>& runners, double seconds, std::uint64_t runs) {
  std::vector<std::vector<double>> costs(runners.size());
  std::vector<std::vector<double>> ratios(runners.size());
  sim::RunSpec spec;
  spec.scenario = "light-flocking";
  spec.scenario_parameters = {{"time_limit", seconds}};
  for (std::uint64_t seed = 0; seed <= runs; ++seed) {
    spec.seed = seed;
    double built_in = 0.0;
    for (std::size_t i = 0; i < runners.size(); ++i) {
      const double cost = runners[i].Run(spec);
      if (i == 0) built_in = cost;
      if (seed == 0) continue;  // the first one loads libraries
      costs[i].push_back(cost);
      ratios[i].push_back(cost / built_in);
    }
  }
  fmt::print("{:<14}{:>10.2f}", fmt::format("{:.0f} s", seconds), 1e3 * Median(costs[0]));
  for (std::size_t i = 1; i < runners.size(); ++i)
    fmt::print("{:>10.2f}{:>7.2f}", 1e3 * Median(costs[i]), Median(ratios[i]));
  fmt::print("\n");
}

int Main(const std::vector<std::string>& arguments) {
  const std::uint64_t runs =
      arguments.empty() ? kRuns : std::strtoull(arguments.front().c_str(), nullptr, 10);
  if (runs == 0 || arguments.size() > 1) {
    fmt::print(stderr, "usage: plugin_report [RUNS]\n");
    return 2;
  }
  const testing_support::TemporaryDirectory folder;
  std::vector<MeasuredRunner> runners;
  runners.emplace_back("light-flocking", "");
  runners.emplace_back("twin", GAUNTLET_TWINS);
  runners.emplace_back("light_flocking_controller", BuildExample(folder));
  fmt::print("{:<14}{:>10}{:>10}{:>7}{:>10}{:>7}\n", "ms per run of", "built in", "SDK", "times", "ARGoS",
             "times");
  for (const double seconds : {200.0, 800.0}) Report(runners, seconds, runs);
  return 0;
}

}  // namespace
}  // namespace gauntlet::perf

int main(int argc, char** argv) {
  return gauntlet::perf::Main({argv + 1, argv + argc});
}
