// What the service costs besides the simulations, all with the same processes on this machine: a master, two
// workers, loopback.
//
//   bare      a ROUTER and two DEALERs that exchange messages of a lease's and a result's size
//   service   gauntlet master and gauntlet-worker-noop: search, leases, supervisors, runners, every result
//             durable; the figures are those that the master prints, its start and end included
//   50 ms     the same with runs that use 50 ms of CPU time each
//   crowd     512 workers that are connected when a generation is queued: until each has a lease
//   memory    of the master, with --memory only (a million runs take about a minute and 1.5 GB of disk)
//
//   throughput_report [--runs N] [--repeat K] [--memory [RUNS]]
// Each figure is K times measured (3), the median stands first.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/run_result.h"
#include "tests/integration/service_driver.h"
#include "tests/integration/worker_crowd.h"
#include "tests/perf/bare_loop.h"
#include "tests/perf/noop_runs.h"

namespace gauntlet::perf {
namespace {

using testing_support::Eventually;
using testing_support::Process;
using testing_support::TemporaryDirectory;

constexpr int kWorkers = 2;
// Of a lease of `evolve flocking` and of the result that gauntlet-worker-noop gives for it.
constexpr std::size_t kLeaseBytes = 1125;
constexpr std::size_t kResultBytes = 80;
constexpr std::chrono::seconds kPatience{300};

std::string Program(const std::string& name) {
  static const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  return folder / name;
}

struct Campaign {
  bool plain = false;  // without keys and encryption
  int population = 500;
  int replicates = 20;
  int generations = 5;
  int run_milliseconds = 0;
  int workers = kWorkers;
};

struct Figures {
  double runs = 0.0;
  double seconds = 0.0;
  double per_second = 0.0;
  double master_microseconds = 0.0;  // of CPU per run
};

// "gauntlet: 50,000 runs in 3.2 s (15432.1/s; master 22 us of CPU per run)...", the numbers in it.
std::optional<Figures> FiguresIn(const std::string& messages) {
  const std::size_t found = messages.find(" runs in ");
  if (found == std::string::npos) return std::nullopt;
  Figures figures;
  const std::size_t number = messages.rfind(' ', found - 1) + 1;
  std::string count = messages.substr(number, found - number);
  std::erase(count, ',');
  figures.runs = std::strtod(count.c_str(), nullptr);
  const std::size_t rate = messages.find('(', found);
  const std::size_t cost = messages.find("master ", found);
  if (rate == std::string::npos || cost == std::string::npos) return std::nullopt;
  figures.per_second = std::strtod(messages.c_str() + rate + 1, nullptr);
  figures.master_microseconds = std::strtod(messages.c_str() + cost + 7, nullptr);
  figures.seconds = figures.runs / figures.per_second;
  return figures;
}

// A master and its workers while they run.
class Service {
 public:
  explicit Service(const Campaign& campaign)
      : master_(Command(campaign, dir()), {"GAUNTLET_WORKER=" + Program("gauntlet-worker-noop")}) {
    served_ = Eventually([this] { return std::filesystem::exists(dir() + "/access.json"); }, kPatience);
    for (int i = 0; i < campaign.workers; ++i) {
      workers_.push_back(std::make_unique<Process>(
          std::vector<std::string>{Program("gauntlet-worker-noop"), "--dir", dir(), "--quiet"},
          std::vector<std::string>{fmt::format("GAUNTLET_NOOP_MS={}", campaign.run_milliseconds)}));
    }
  }

  static std::vector<std::string> Command(const Campaign& campaign, const std::string& dir) {
    std::vector<std::string> command = {Program("gauntlet"),
                                        "master",
                                        "flocking",
                                        "--bind",
                                        "tcp://127.0.0.1:*",
                                        "--dir",
                                        dir,
                                        "--no-progress",
                                        "--population",
                                        std::to_string(campaign.population),
                                        "--generations",
                                        std::to_string(campaign.generations),
                                        "--set",
                                        fmt::format("search.replicates={}", campaign.replicates)};
    if (campaign.plain) command.emplace_back("--insecure");
    return command;
  }

  std::string dir() const { return scratch_ / "campaign"; }
  bool served() const { return served_; }
  Process& master() { return master_; }
  std::optional<Figures> Finish() {
    const testing_support::ProcessResult result = master_.Wait(kPatience);
    if (result.exit_code != 0) fmt::print(stderr, "{}", result.err);
    return FiguresIn(result.err);
  }

 private:
  TemporaryDirectory scratch_;
  Process master_;
  bool served_ = false;
  std::vector<std::unique_ptr<Process>> workers_;
};

// "15432 (14980 15432 16001)"
template <typename Measure>
std::string Repeated(int times, const char* format, const Measure& measure) {
  std::vector<double> figures;
  for (int i = 0; i < times; ++i) figures.push_back(measure());
  std::sort(figures.begin(), figures.end());
  std::string all;
  for (const double figure : figures) all += " " + fmt::format(fmt::runtime(format), figure);
  return fmt::format(fmt::runtime(format), figures[figures.size() / 2]) + "  of" + all;
}

BareLoop Bare(std::size_t exchanges, bool curve) {
  return {.exchanges = exchanges,
          .workers = kWorkers,
          .ahead = 64,
          .lease = std::string(kLeaseBytes, 'l'),
          .result = std::string(kResultBytes, 'r'),
          .curve = curve};
}

double CrowdSeconds() {
  constexpr int kCrowd = 512;
  Service service({.population = 2 * kCrowd, .replicates = 1, .generations = 2, .workers = 0});
  if (!service.served()) return -1.0;
  testing_support::WorkerCrowd crowd(service.dir(), kCrowd, kNoopGoldenHashes);
  const sim::RunResult result = NoopResult(1);
  if (!crowd.Join(kPatience) || crowd.AwaitLeases(2 * kCrowd, kPatience) < 0.0) return -1.0;
  // A second each: no more than two leases for one worker. The last answer's way is counted too.
  crowd.AnswerAll(result, 1.0);
  return crowd.AwaitLeases(kCrowd, std::chrono::seconds(60));
}

// Resident memory of the master when a tenth, a half and all runs are stored.
void PrintMemory(std::size_t runs) {
  const Campaign campaign{.generations = static_cast<int>(runs / 10'000)};
  Service service(campaign);
  const auto total = static_cast<double>(runs);
  double first = 0.0;
  for (const double mark : {0.1, 0.5, 0.98}) {
    double done = 0.0;
    Eventually(
        [&] {
          std::ifstream file(service.dir() + "/status.json");
          const auto status = nlohmann::json::parse(file, nullptr, false);
          if (status.is_object()) done = status.value("runs_done", 0.0);
          return done >= mark * total || !service.master().Running();
        },
        kPatience);
    if (done < mark * total) break;  // it had ended before it was seen
    const double resident = testing_support::ResidentMebibytes(service.master().pid());
    if (first == 0.0) first = resident;
    fmt::print("memory of the master after {:9.0f} runs: {:6.1f} MiB ({:+.1f})\n", done, resident,
               resident - first);
    std::fflush(stdout);
  }
  const auto figures = service.Finish();
  if (figures) fmt::print("{:.0f} runs: {:.0f}/s\n", figures->runs, figures->per_second);
}

// Plain and encrypted campaigns in turns: what else the machine does disturbs both alike.
void ReportService(std::size_t runs, int repeat, const std::function<void(const std::string&)>& say) {
  std::vector<double> rates[2];
  std::vector<double> costs[2];
  std::vector<double> ratios;
  for (int i = 0; i < repeat; ++i) {
    for (const bool plain : {true, false}) {
      Campaign campaign{.plain = plain};
      campaign.generations = std::max(1, static_cast<int>(runs / 10'000));
      const auto figures = Service(campaign).Finish();
      rates[plain ? 0 : 1].push_back(figures ? figures->per_second : 0.0);
      costs[plain ? 0 : 1].push_back(figures ? figures->master_microseconds : 0.0);
    }
    ratios.push_back(rates[1].back() / rates[0].back());
  }
  const auto listed = [repeat](const std::vector<double>& figures, const char* format) {
    std::size_t next = 0;
    return Repeated(repeat, format, [&] { return figures[next++]; });
  };
  for (const int which : {0, 1}) {
    std::sort(costs[which].begin(), costs[which].end());
    say(fmt::format("service, {}: runs/s {}; master CPU {:.0f} us per run",
                    which == 0 ? "plain (--insecure)" : "CURVE (default)", listed(rates[which], "{:.0f}"),
                    costs[which][costs[which].size() / 2]));
  }
  say("service, CURVE's rate as a share of plain's, in pairs: " + listed(ratios, "{:.3f}"));
}

int Report(std::size_t runs, int repeat, std::size_t memory_runs) {
  const auto say = [](const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
  };
  for (const bool curve : {false, true}) {
    say(fmt::format("bare, {}: exchanges/s {}", curve ? "CURVE" : "plain",
                    Repeated(repeat, "{:.0f}", [&] { return RunBareLoop(Bare(runs, curve)); })));
  }
  ReportService(runs, repeat, say);
  say("service, runs of 50 ms of CPU time, share of ideal: " + Repeated(repeat, "{:.3f}", [] {
        const Campaign campaign{.population = 400, .replicates = 1, .generations = 3, .run_milliseconds = 50};
        const auto figures = Service(campaign).Finish();
        return figures ? figures->runs * 0.050 / kWorkers / figures->seconds : 0.0;
      }));
  say("512 connected workers, CURVE, from queueing until each has a lease, s: " +
      Repeated(repeat, "{:.2f}", CrowdSeconds));
  if (memory_runs > 0) PrintMemory(memory_runs);
  return 0;
}

}  // namespace
}  // namespace gauntlet::perf

int main(int argc, char** argv) {
  std::size_t runs = 50'000;
  std::size_t memory_runs = 0;
  int repeat = 3;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const bool has_value = i + 1 < argc && argv[i + 1][0] != '-';
    if (option == "--memory" && !has_value) {
      memory_runs = 1'000'000;
    } else if (has_value && (option == "--runs" || option == "--repeat" || option == "--memory")) {
      const unsigned long value = std::strtoul(argv[++i], nullptr, 10);
      if (option == "--runs") runs = std::max(10'000UL, value);
      if (option == "--repeat") repeat = static_cast<int>(std::max(1UL, value));
      if (option == "--memory") memory_runs = std::max(20'000UL, value);
    } else {
      fmt::print(stderr, "usage: {} [--runs N] [--repeat K] [--memory [RUNS]]\n", argv[0]);
      return 2;
    }
  }
  return gauntlet::perf::Report(runs, repeat, memory_runs);
}
