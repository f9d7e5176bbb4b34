#include "tests/integration/durability_drill.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "sim/random/random_stream.h"
#include "tests/integration/campaign_database.h"
#include "tests/integration/scripted_worker.h"
#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

std::vector<std::uint64_t> LoggedSeeds(const std::string& run_log) {
  std::vector<std::uint64_t> seeds;
  std::istringstream lines(ReadFile(run_log));
  for (std::string line; std::getline(lines, line);) seeds.push_back(std::stoull(line));
  return seeds;
}

// Answers leases until the master ends or `end` comes.
void Serve(ScriptedWorker& worker, Process& master, steady_clock::time_point end,
           std::map<proto::Fence, std::uint64_t>& waiting, std::set<std::uint64_t>& acknowledged,
           DurabilityReport& report) {
  auto next_beat = steady_clock::now();
  while (steady_clock::now() < end && master.Running()) {
    if (steady_clock::now() >= next_beat) {
      std::vector<proto::Fence> held;
      for (const auto& [fence, run] : waiting) held.push_back(fence);
      worker.Beat(held);
      next_beat += std::chrono::seconds(1);
    }
    const std::optional<proto::MasterMessage> message = worker.Hear(milliseconds(20));
    if (!message) continue;
    if (const auto* lease = std::get_if<proto::Lease>(&*message)) {
      if (acknowledged.contains(lease->run_id)) ++report.leased_again;
      waiting[lease->fence] = lease->run_id;
      worker.Say(ScriptedWorker::Answer(*lease));
      ++report.simulated;
    } else if (const auto* acknowledge = std::get_if<proto::Acknowledge>(&*message)) {
      for (const proto::Fence fence : acknowledge->fences) {
        if (const auto found = waiting.find(fence); found != waiting.end())
          acknowledged.insert(found->second);
        waiting.erase(fence);
      }
    }
  }
}

bool Serves(const std::string& dir, std::uint64_t epoch) {
  const Result<proto::Access> access = proto::ReadAccess(dir + "/access.json");
  return access.ok() && access->epoch >= epoch;
}

}  // namespace

DurabilityReport EvolveThroughPowerLosses(const SmallCampaign& campaign, const std::string& dir, int kills,
                                          std::uint64_t seed, milliseconds longest_life) {
  sim::RandomStream random(seed, sim::StreamPurpose::kTest);
  DurabilityReport report;
  std::set<std::uint64_t> acknowledged;
  std::vector<std::string> arguments = MasterArguments(campaign, dir);
  const std::vector<std::string> shim = {"LD_PRELOAD=" + FaultShimPath(),
                                         "GAUNTLET_FAULT_LOSE_UNSYNCED=" + dir};
  for (std::uint64_t epoch = 1;; ++epoch) {
    Process master(GauntletCommand(arguments), shim);
    // A new worker each time: what the former had not handed in is lost, as on a machine that lost power.
    ScriptedWorker worker(dir, 0x1000 + epoch);
    // A master killed between its last result and its end leaves the next one nothing to do.
    const bool ended =
        Eventually([&] { return !master.Running() || Serves(dir, epoch); }, kPatience) && !master.Running();
    if (ended) {
      const ProcessResult result = master.Wait();
      EXPECT_EQ(result.exit_code, 0) << result.err;
      break;
    }
    const bool joined = worker.Join(epoch);
    EXPECT_TRUE(joined) << master.Err();
    if (!joined) return report;
    const bool last = report.kills >= kills;
    const auto life = last ? milliseconds(kPatience * 10)
                           : milliseconds(random.Below(static_cast<std::uint32_t>(longest_life.count())));
    std::map<proto::Fence, std::uint64_t> waiting;
    Serve(worker, master, steady_clock::now() + life, waiting, acknowledged, report);
    if (!master.Running()) {
      const ProcessResult result = master.Wait();
      EXPECT_EQ(result.exit_code, 0) << result.err;
      break;
    }
    master.Signal(SIGKILL);
    master.Wait();
    // What was acknowledged in its last moment counts too.
    while (const auto message = worker.Hear(milliseconds(30))) {
      if (const auto* acknowledge = std::get_if<proto::Acknowledge>(&*message)) {
        for (const proto::Fence fence : acknowledge->fences) {
          if (waiting.contains(fence)) acknowledged.insert(waiting[fence]);
        }
      }
    }
    ++report.kills;
    report.acknowledged = static_cast<int>(acknowledged.size());
    arguments = ResumeArguments(dir);
  }
  report.runs = Show(dir).value("runs_done", 0);
  EXPECT_EQ(StateHash(dir), UndisturbedHash(campaign));
  return report;
}

MassacreReport EvolveThroughMassacre(const SmallCampaign& campaign, const std::string& dir, int workers,
                                     int master_kills, int worker_kills, std::uint64_t seed,
                                     milliseconds longest_life, milliseconds run) {
  sim::RandomStream random(seed, sim::StreamPurpose::kTest);
  MassacreReport report;
  const TemporaryDirectory scratch;
  const std::string run_log = scratch / "runs";
  const std::vector<std::string> environment = {
      "GAUNTLET_WORKER=" + WorkerPath() + "-slow", "GAUNTLET_TEST_RUN_LOG=" + run_log,
      "GAUNTLET_TEST_RUN_MILLISECONDS=" + std::to_string(run.count())};
  std::vector<std::string> arguments = EvolveArguments(campaign, dir, workers);
  std::set<std::uint64_t> stored;  // before the present master began
  for (bool finished = false; !finished;) {
    Process master(GauntletCommand(arguments), environment);
    const bool last = report.master_kills == master_kills;
    const auto end =
        steady_clock::now() + (last ? milliseconds(kPatience * 10) : RandomTime(random, longest_life));
    while (steady_clock::now() < end && master.Running()) {
      // Two workers or runners for one master.
      Eventually([&] { return !master.Running(); }, RandomTime(random, longest_life / 3));
      if (report.worker_kills == worker_kills || !std::filesystem::exists(dir + "/access.json")) continue;
      report.worker_kills += KillADescendant(master, random) ? 1 : 0;
    }
    finished = !master.Running();
    const std::vector<pid_t> family = DescendantsOf(master.pid());
    if (!finished) {
      master.Signal(SIGKILL);
      ++report.master_kills;
    }
    const ProcessResult result = master.Wait();
    EXPECT_EQ(result.exit_code, finished ? 0 : -1) << result.err;
    EXPECT_TRUE(Eventually([&] { return std::none_of(family.begin(), family.end(), Alive); },
                           std::chrono::seconds(20)))
        << "outlived their killed master";
    // What a killed master left; the next is only disturbed once it has written its own. (Before, its only
    // child is the one that tells the golden hash.)
    std::filesystem::remove(dir + "/access.json");
    const std::vector<std::uint64_t> begun = LoggedSeeds(run_log);
    for (auto i = static_cast<std::size_t>(report.evaluations); i < begun.size(); ++i)
      report.evaluated_after_stored += stored.contains(begun[i]) ? 1 : 0;
    report.evaluations = static_cast<int>(begun.size());
    // A master killed before it had created its campaign leaves nothing to resume.
    if (!std::filesystem::exists(dir + "/campaign.db")) continue;
    stored.clear();
    for (const std::string& number : Query(dir, "SELECT printf('%llu', seed) FROM runs"))
      stored.insert(std::stoull(number));
    arguments = {"resume", dir, "--workers", std::to_string(workers), "--quiet"};
  }
  report.runs = Show(dir).value("runs_done", 0);
  EXPECT_EQ(StateHash(dir), UndisturbedHash(campaign));
  return report;
}

}  // namespace gauntlet::testing_support
