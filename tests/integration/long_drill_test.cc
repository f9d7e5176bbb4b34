// The long forms of the drills, on the default experiment. `./dev drill` runs them; the suite has shorter
// ones.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "analysis/statistics/comparison.h"
#include "analysis/statistics/proportions.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/crowd_drill.h"
#include "tests/integration/durability_drill.h"
#include "tests/integration/lying_workers_drill.h"
#include "tests/integration/other_user_drill.h"
#include "tests/integration/service_driver.h"
#include "tests/integration/stranger.h"
#include "tests/integration/worker_crowd.h"
#include "tests/integration/zmtp_fuzz.h"
#include "tests/perf/noop_runs.h"
#include "tests/plugin/plugin_files.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

constexpr const char* kGauntlet = GAUNTLET_BINARY_DIR "/gauntlet";
constexpr const char* kNoopWorker = GAUNTLET_BINARY_DIR "/gauntlet-worker-noop";

SmallCampaign DefaultCampaign() {
  SmallCampaign campaign;
  campaign.population = 20;
  campaign.generations = 50;
  campaign.seed = "1";
  return campaign;
}

TEST(LongDrill, MasterKilledAt20RandomMoments) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign = DefaultCampaign();
  campaign.generations = 200;  // fast machines are through with fewer before enough kills have hit
  const int hits =
      EvolveThroughMasterKills(campaign, scratch / "c", 2, 20, 3, std::chrono::milliseconds(3000));
  fmt::print("master kills that hit: {} of 20\n", hits);
  EXPECT_GE(hits, 5);
  EXPECT_EQ(StateHash(scratch / "c"), UndisturbedHash(campaign));
}

TEST(LongDrill, WorkersKilled40Times) {
  const TemporaryDirectory scratch;
  const int hits =
      EvolveThroughWorkerKills(DefaultCampaign(), scratch / "c", 3, 40, 4, std::chrono::milliseconds(600));
  fmt::print("workers and runners killed: {}\n", hits);
  EXPECT_GE(hits, 10);
  EXPECT_EQ(StateHash(scratch / "c"), UndisturbedHash(DefaultCampaign()));
}

TEST(LongDrill, EveryWorkerCountGivesTheSameStateHash) {
  for (const int workers : {1, 5}) {
    const TemporaryDirectory scratch;
    ASSERT_EQ(Gauntlet(EvolveArguments(DefaultCampaign(), scratch / "c", workers)).exit_code, 0);
    EXPECT_EQ(StateHash(scratch / "c"), UndisturbedHash(DefaultCampaign())) << workers << " workers";
  }
}

// The number to hold: 100 masters and 200 workers within one evolution. They take two minutes, in which two
// workers end 2,700 runs of 100 ms at most.
void KillAHundredMastersAndTwoHundredWorkers(SmallCampaign campaign) {
  const TemporaryDirectory scratch;
  campaign.population = 20;
  campaign.generations = 200;
  const MassacreReport report =
      EvolveThroughMassacre(campaign, scratch / "c", 2, 100, 200, 5, std::chrono::milliseconds(2000),
                            std::chrono::milliseconds(100));
  fmt::print("{} masters and {} workers killed, {} runs, {} evaluations, {} of stored runs\n",
             report.master_kills, report.worker_kills, report.runs, report.evaluations,
             report.evaluated_after_stored);
  EXPECT_EQ(report.master_kills, 100);
  EXPECT_EQ(report.worker_kills, 200);
  EXPECT_EQ(report.evaluated_after_stored, 0);
}

TEST(LongDrill, AHundredMastersAndTwoHundredWorkersKilled) {
  KillAHundredMastersAndTwoHundredWorkers(DefaultCampaign());
}

TEST(LongDrill, AHundredMastersAndTwoHundredWorkersKilledOverAPlugin) {
  const TemporaryDirectory scratch;
  KillAHundredMastersAndTwoHundredWorkers(SmallPlugin(scratch));
}

TEST(LongDrill, AHundredLossesOfPower) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign = DefaultCampaign();
  campaign.generations = 100;
  const DurabilityReport report =
      EvolveThroughPowerLosses(campaign, scratch / "c", 100, 6, std::chrono::milliseconds(600));
  fmt::print("{} kills, {} runs acknowledged before one, {} of them leased again, {} simulated, {} runs\n",
             report.kills, report.acknowledged, report.leased_again, report.simulated, report.runs);
  EXPECT_GE(report.kills, 50);
  EXPECT_EQ(report.leased_again, 0);
}

// Two and a half minutes in plaintext, as many with CURVE.
TEST(LongDrill, RandomConversationsOnTheMastersPort) {
  SmallCampaign campaign;
  campaign.generations = 300;
  const std::string& undisturbed = UndisturbedHash(campaign);
  for (const bool encrypted : {false, true}) {
    SCOPED_TRACE(encrypted ? "CURVE" : "plaintext");
    const TemporaryDirectory scratch;
    const std::string dir = scratch / "c";
    const auto begun = std::chrono::steady_clock::now();
    const auto master =
        StartGauntlet(encrypted ? MasterArguments(campaign, dir) : Insecure(MasterArguments(campaign, dir)));
    const auto worker = StartSlowWorker(dir, 60);
    ASSERT_TRUE(RunsDone(dir, 8));
    const double before = ResidentMebibytes(master->pid());
    const std::string endpoint = StatusOf(dir).at("master").at("endpoints")[0];
    double after = before;
    const ZmtpFuzzReport report =
        FuzzPort(std::stoi(endpoint.substr(endpoint.rfind(':') + 1)), encrypted, encrypted ? 12 : 11, [&] {
          if (const double now = ResidentMebibytes(master->pid()); now > 0.0) after = now;
          return master->Running();
        });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    fmt::print("{:.0f} s: {} connections, {} bytes, memory {:.1f} -> {:.1f} MiB\n", seconds,
               report.connections, report.bytes, before, after);
    EXPECT_EQ(master->Wait().exit_code, 0) << master->Err();
    EXPECT_EQ(worker->Wait().exit_code, 0) << worker->Err();
    EXPECT_EQ(StateHash(dir), undisturbed);
    EXPECT_LT(after, before + 64.0);
    EXPECT_EQ(MasterLog(dir).find("worker-lost"), std::string::npos);
  }
}

// The numbers to hold: 10,000 forged messages of each kind while an evolution runs.
TEST(LongDrill, TenThousandMessagesOfEachKindFromAnotherUser) {
  if (!CanBeAnotherUser()) GTEST_SKIP() << "only root can be another user";
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 300;  // four minutes; the attack takes less than one
  EvolveUnderForgery(campaign, scratch / "c", 10'000);
}

// 512 workers that come, take runs and go, half of them without a word, again and again for a minute.
TEST(LongDrill, FiveHundredWorkersThatJoinAndLeaveAllTheTimeLeaveNothing) {
  const std::vector<std::string> evolve = {"--population", "2000", "--generations", "30", "--quiet"};
  const std::vector<std::string> noop = {std::string("GAUNTLET_WORKER=") + kNoopWorker};
  const TemporaryDirectory scratch;
  const auto gauntlet = [&](std::vector<std::string> arguments, const std::string& dir) {
    arguments.insert(arguments.begin(), kGauntlet);
    arguments.insert(arguments.end(), {"--dir", scratch / dir});
    arguments.insert(arguments.end(), evolve.begin(), evolve.end());
    return std::make_unique<Process>(arguments, noop);
  };
  ASSERT_EQ(gauntlet({"evolve", "flocking"}, "alone")->Wait().exit_code, 0);
  const auto master = gauntlet({"master", "flocking", "--bind", "tcp://127.0.0.1:*"}, "c");
  ASSERT_TRUE(Serves(scratch / "c"));
  const auto descriptors = [&] {
    const std::filesystem::directory_iterator open(fmt::format("/proc/{}/fd", master->pid()));
    return std::distance(begin(open), end(open));
  };
  double memory = 0.0;
  std::ptrdiff_t files = 0;
  int rounds = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < end) {
    {
      WorkerCrowd crowd(scratch / "c", 512, perf::kNoopGoldenHashes,
                        1000 * static_cast<std::uint64_t>(++rounds));
      ASSERT_TRUE(crowd.Join(kPatience)) << master->Err();
      ASSERT_GE(crowd.AwaitLeases(512, kPatience), 0.0);
      crowd.SayGoodbye();
    }
    if (rounds != 5) continue;
    memory = ResidentMebibytes(master->pid());
    files = descriptors();
  }
  const auto worker =
      std::make_unique<Process>(std::vector<std::string>{kNoopWorker, "--dir", scratch / "c", "--quiet"});
  const double memory_after = ResidentMebibytes(master->pid());
  EXPECT_TRUE(Eventually([&] { return descriptors() <= files + 16; }, kPatience))
      << descriptors() << " of " << files;
  fmt::print("{} times 512 workers, memory {:.1f} -> {:.1f} MiB, descriptors {} -> {}\n", rounds, memory,
             memory_after, files, descriptors());
  // Whoever went without a word is remembered for 15 minutes, in 2.6 KiB each as measured.
  const double remembered = 256.0 * (rounds - 5) * 3.5 / 1024.0;
  EXPECT_LT(memory_after, memory + remembered + 8.0);
  EXPECT_EQ(master->Wait().exit_code, 0) << master->Err();
  EXPECT_EQ(StateHash(scratch / "c"), StateHash(scratch / "alone"));
}

// Each kind of lie alone, twice and thrice, all pairs of kinds, and threes of different kinds.
TEST(LongDrill, LiarsOfEveryKindInEveryMixWithAsManyHonestOnes) {
  const std::vector<Lie> kinds = {Lie::kCrash,      Lie::kHang,         Lie::kWrongHash,
                                  Lie::kUnreadable, Lie::kForeignLease, Lie::kSlow};
  std::vector<std::vector<Lie>> mixes;
  for (std::size_t a = 0; a < kinds.size(); ++a) {
    mixes.push_back({kinds[a]});
    mixes.push_back({kinds[a], kinds[a], kinds[a]});
    for (std::size_t b = a; b < kinds.size(); ++b) mixes.push_back({kinds[a], kinds[b]});
    mixes.push_back({kinds[a], kinds[(a + 1) % kinds.size()], kinds[(a + 3) % kinds.size()]});
  }
  SmallCampaign campaign;
  campaign.generations = 12;
  for (const std::vector<Lie>& mix : mixes) {
    std::string name;
    for (const Lie lie : mix) name += std::string(name.empty() ? "" : ", ") + std::string(NameOf(lie));
    SCOPED_TRACE(name);
    fmt::print("--- {}\n", name);
    const TemporaryDirectory scratch;
    EvolveWithLiars(campaign, scratch / "c", mix, true);
  }
}

// Ten minutes, or as many seconds as GAUNTLET_DRILL_SECONDS says.
TEST(LongDrill, SixtyFourWorkersUnderFullLoadAreNeverTakenForLost) {
  const TemporaryDirectory scratch;
  const char* wish = std::getenv("GAUNTLET_DRILL_SECONDS");
  const std::chrono::seconds duration(wish != nullptr ? std::atoi(wish) : 600);
  const CrowdReport report = WatchACrowd(scratch / "c", 64, duration);
  fmt::print("{} workers, {} s, load {:.1f}: {} runs, {} workers taken for lost, {} runs leased again\n",
             report.joined, duration.count(), report.load, report.runs, report.lost, report.leased_again);
  EXPECT_EQ(report.joined, 64);
  EXPECT_EQ(report.lost, 0);
  EXPECT_EQ(report.leased_again, 0);
}

// As many as the largest clusters have: takes both cores for half a minute.
TEST(LongDrill, FourThousandConnectedWorkersAreAllLeasedAndNoneIsLost) {
  constexpr int kCrowd = 4096;
  const TemporaryDirectory scratch;
  const auto master = StartNoopMaster(scratch / "c", "tcp://0.0.0.0:*", 2 * kCrowd, 1, 2);
  ASSERT_TRUE(Serves(scratch / "c"));
  WorkerCrowd crowd(scratch / "c", kCrowd, perf::kNoopGoldenHashes);
  ASSERT_TRUE(crowd.Join(kPatience)) << master->Err();
  ASSERT_GE(crowd.AwaitLeases(2 * kCrowd, kPatience), 0.0) << "each has two";
  // So long that every worker had to be heard, more than once.
  (void)crowd.AwaitLeases(3 * kCrowd, std::chrono::seconds(20));
  ASSERT_EQ(crowd.AnswerAll(perf::NoopResult(1), 1.0), 2U * kCrowd);
  const double seconds = crowd.AwaitLeases(kCrowd, kPatience);
  fmt::print("leased {:.2f} s after the last answer\n", seconds);
  EXPECT_GE(seconds, 0.0) << "each has one of the next generation";
  EXPECT_LT(seconds, 2.0);
  std::ifstream file(scratch / "c/status.json");
  const auto status = nlohmann::json::parse(file, nullptr, false);
  EXPECT_EQ(status.value("workers", 0), kCrowd);
  EXPECT_EQ(status.value("workers_lost", -1), 0);
}

// What random cases say in 20,000 runs and what `probability` says in far fewer; with seeds of their own.
TEST(LongDrill, ProbabilityAndRandomCasesAgree) {
  for (int seed = 1; seed <= 5; ++seed) {
    const TemporaryDirectory scratch;
    const std::string set = "seed=" + std::to_string(seed);
    ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "20000", "--set", set, "--dir", scratch / "random",
                        "--quiet"})
                  .exit_code,
              0);
    const auto random = nlohmann::json::parse(Gauntlet({"show", scratch / "random", "--json"}).out);
    const analysis::Interval counted =
        analysis::WilsonInterval(random["total_failures"], 20'000, analysis::kConfidence);
    const ProcessResult told = Gauntlet({"probability", "flocking", "--set", set, "--within", "0.1", "--dir",
                                         scratch / "probability", "--json", "--quiet"});
    ASSERT_EQ(told.exit_code, 0) << told.err;
    const auto probability = nlohmann::json::parse(told.out);
    fmt::print("seed {}: random {:.4f} to {:.4f}, probability {:.4f} to {:.4f} in {} runs\n", seed,
               counted.low, counted.high, probability["interval"][0].get<double>(),
               probability["interval"][1].get<double>(), probability["runs"].get<int>());
    EXPECT_LE(probability["interval"][0], counted.high);
    EXPECT_GE(probability["interval"][1], counted.low);
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
