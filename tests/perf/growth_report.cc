// What a campaign's size does to it: gauntlet-worker-noop's runs of one search, a new campaign for every
// number of runs, on this machine.
//
//   growth_report [RUNS...]      5000 20000 50000 100000 200000 without arguments
// Columns: runs; runs per second from the master's first line to its last; bytes of campaign.db per run;
// seconds that show and status take afterwards.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace gauntlet::perf {
namespace {

using testing_support::Process;
using testing_support::ProcessResult;
using testing_support::TemporaryDirectory;
using Clock = std::chrono::steady_clock;

constexpr int kPopulation = 100;
constexpr std::chrono::seconds kPatience{900};

std::string Program(const std::string& name) {
  static const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  return folder / name;
}

// What it prints goes nowhere.
double SecondsOf(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {Program("gauntlet")};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const auto begin = Clock::now();
  const ProcessResult result = Process(command).Wait(kPatience);
  if (result.exit_code != 0) fmt::print(stderr, "{}", result.err);
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void Report(int runs) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "campaign";
  Process master({Program("gauntlet"), "evolve", "flocking", "--dir", dir, "--no-progress", "--workers", "2",
                  "--population", std::to_string(kPopulation), "--generations",
                  std::to_string(std::max(1, runs / kPopulation))},
                 {"GAUNTLET_WORKER=" + Program("gauntlet-worker-noop")});
  const ProcessResult result = master.Wait(kPatience);
  const std::size_t rate = result.err.find("s (");
  if (result.exit_code != 0 || rate == std::string::npos) {
    fmt::print(stderr, "{} runs: exit {}\n{}", runs, result.exit_code, result.err);
    return;
  }
  const double per_second = std::strtod(result.err.c_str() + rate + 3, nullptr);
  const auto bytes = static_cast<double>(std::filesystem::file_size(dir + "/campaign.db"));
  const double show = SecondsOf({"show", dir});
  const double status = SecondsOf({"status", dir});
  fmt::print("{:9} {:9.0f} {:9.0f} {:9.2f} {:9.2f}\n", runs, per_second, bytes / runs, show, status);
  std::fflush(stdout);
}

}  // namespace
}  // namespace gauntlet::perf

int main(int argc, char** argv) {
  std::vector<int> sizes = {5'000, 20'000, 50'000, 100'000, 200'000};
  if (argc > 1) sizes.clear();
  for (int i = 1; i < argc; ++i) {
    const int runs = std::atoi(argv[i]);
    if (runs < gauntlet::perf::kPopulation) {
      fmt::print(stderr, "usage: {} [RUNS...]   (each at least {}, not '{}')\n", argv[0],
                 gauntlet::perf::kPopulation, argv[i]);
      return 2;
    }
    sizes.push_back(runs);
  }
  fmt::print("{:>9} {:>9} {:>9} {:>9} {:>9}\n", "runs", "runs/s", "bytes/run", "show, s", "status, s");
  for (const int runs : sizes) gauntlet::perf::Report(runs);
  return 0;
}
