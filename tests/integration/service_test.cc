// Masters whose workers come from elsewhere: workers that outlive them, status and stop, keys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_driver.h"

namespace gauntlet {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::Eventually;
using testing_support::EvolveArguments;
using testing_support::Gauntlet;
using testing_support::Process;
using testing_support::ProcessResult;
using testing_support::ReadFile;
using testing_support::SmallCampaign;
using testing_support::StartGauntlet;
using testing_support::StateHash;
using testing_support::TemporaryDirectory;
using testing_support::WorkerPath;

constexpr std::chrono::seconds kPatience{60};

std::vector<std::string> MasterArguments(const SmallCampaign& campaign, const std::string& dir,
                                         const std::string& endpoint = "tcp://127.0.0.1:*") {
  return {"master",        campaign.experiment,
          "--dir",         dir,
          "--bind",        endpoint,
          "--seed",        campaign.seed,
          "--population",  std::to_string(campaign.population),
          "--generations", std::to_string(campaign.generations),
          "--no-progress"};
}

std::unique_ptr<Process> StartWorker(const std::string& dir, const std::string& orphan_timeout = "60") {
  return std::make_unique<Process>(
      std::vector<std::string>{WorkerPath(), "--dir", dir, "--orphan-timeout", orphan_timeout});
}

json StatusOf(const std::string& dir) {
  const ProcessResult result = Gauntlet({"status", dir, "--json"});
  return result.exit_code == 0 ? json::parse(result.out, nullptr, false) : json();
}

bool StatusBecomes(const std::string& dir, const std::function<bool(const json&)>& condition) {
  return Eventually(
      [&] {
        const json status = StatusOf(dir);
        return status.is_object() && condition(status);
      },
      kPatience);
}

mode_t ModeOf(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 ? info.st_mode & 07777 : 0;
}

// Ids of the stored runs; the database's triggers see to it that none is stored twice.
std::vector<std::uint64_t> StoredRuns(const std::string& dir) {
  std::vector<std::uint64_t> runs;
  sqlite3* database = nullptr;
  if (sqlite3_open_v2(("file:" + dir + "/campaign.db?immutable=1").c_str(), &database,
                      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr) == SQLITE_OK) {
    sqlite3_stmt* query = nullptr;
    sqlite3_prepare_v2(database, "SELECT id FROM runs ORDER BY id", -1, &query, nullptr);
    while (sqlite3_step(query) == SQLITE_ROW) {
      runs.push_back(static_cast<std::uint64_t>(sqlite3_column_int64(query, 0)));
    }
    sqlite3_finalize(query);
  }
  sqlite3_close(database);
  return runs;
}

TEST(ServiceTest, WorkersOutliveAKilledMasterAndServeTheNext) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 40;
  const std::string undisturbed = scratch / "undisturbed";
  ASSERT_EQ(Gauntlet(EvolveArguments(campaign, undisturbed, 2)).exit_code, 0);

  const std::string dir = scratch / "c";
  std::unique_ptr<Process> master = StartGauntlet(MasterArguments(campaign, dir));
  const std::unique_ptr<Process> workers[] = {StartWorker(dir), StartWorker(dir)};
  ASSERT_TRUE(StatusBecomes(dir, [](const json& status) { return status.value("runs_done", 0) >= 8; }));
  master->Signal(SIGKILL);
  master->Wait();
  for (const auto& worker : workers) EXPECT_TRUE(worker->Running()) << worker->Err();
  master = StartGauntlet({"resume", dir, "--bind", "tcp://127.0.0.1:*", "--no-progress"});
  EXPECT_EQ(master->Wait().exit_code, 0);
  for (const auto& worker : workers)
    EXPECT_EQ(worker->Wait().exit_code, 0) << "let go when the search is done";
  EXPECT_EQ(StateHash(dir), StateHash(undisturbed));
  EXPECT_EQ(StoredRuns(dir), StoredRuns(undisturbed));
}

TEST(ServiceTest, StatusSaysWhatRunsWhereAndWhyNothingRunsAndStopEndsIt) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 500;
  const std::string dir = scratch / "c";
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(campaign, dir));
  ASSERT_TRUE(StatusBecomes(dir, [](const json& status) { return status.value("runs_queued", 0) > 0; }));
  json status = StatusOf(dir);
  EXPECT_THAT(status.at("why_nothing_runs"), HasSubstr("no worker is connected"));
  EXPECT_THAT(Gauntlet({"status", dir}).out, HasSubstr("nothing runs: no worker is connected"));

  const std::unique_ptr<Process> worker = StartWorker(dir);
  ASSERT_TRUE(StatusBecomes(dir, [&status](const json& now) {
    status = now;
    return !now.at("worker_list").empty() && !now.at("worker_list")[0].at("runs").empty();
  }));
  EXPECT_EQ(status.at("state"), "running");
  EXPECT_EQ(status.at("worker_list")[0].at("pid"), worker->pid());
  EXPECT_EQ(status.at("worker_list")[0].at("state"), "running");
  EXPECT_GE(status.at("worker_list")[0].at("runs")[0].at("run"), 1);
  EXPECT_TRUE(status.at("why_nothing_runs").is_null());
  EXPECT_EQ(status.at("master").at("pid"), master->pid());

  const ProcessResult stop = Gauntlet({"stop", dir});
  EXPECT_EQ(stop.exit_code, 0) << stop.err;
  EXPECT_EQ(master->Wait().exit_code, 3);
  EXPECT_EQ(worker->Wait().exit_code, 0) << "stop lets workers go";
  EXPECT_EQ(StatusOf(dir).at("state"), "stopped");
  EXPECT_THAT(Gauntlet({"stop", dir}).err, HasSubstr("nothing to stop"));
  EXPECT_FALSE(std::filesystem::exists(dir + "/stop"));
  EXPECT_EQ(Gauntlet({"status", scratch / "none"}).exit_code, 2);
}

TEST(ServiceTest, OuterAddressesAreEncryptedForKnownKeysAndTellNobody) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 500;
  const std::string dir = scratch / "c";
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(campaign, dir, "tcp://0.0.0.0:*"));
  ASSERT_TRUE(StatusBecomes(dir, [](const json& status) { return status.contains("master"); }));
  EXPECT_EQ(StatusOf(dir).at("master").at("encrypted"), true);
  EXPECT_EQ(ModeOf(dir + "/access.json"), 0600u);
  EXPECT_EQ(ModeOf(dir + "/master.key"), 0600u);

  // One with another key is never answered; one whose file others may read does not even try.
  const std::string forged = scratch / "forged.json";
  json access = json::parse(ReadFile(dir + "/access.json"));
  const std::string secret = access.at("curve").at("worker_secret");
  access["curve"]["worker_secret"] = secret.substr(5) + secret.substr(0, 5);  // Z85: whole groups of 5
  std::ofstream(forged) << access.dump();
  std::filesystem::permissions(forged, std::filesystem::perms(0600));
  Process stranger({WorkerPath(), "--access", forged, "--orphan-timeout", "2"});
  const std::string open = scratch / "open.json";
  std::filesystem::copy_file(dir + "/access.json", open);
  std::filesystem::permissions(open, std::filesystem::perms(0644));
  const ProcessResult careless = testing_support::RunProcess({WorkerPath(), "--access", open});
  EXPECT_EQ(careless.exit_code, 2);
  EXPECT_THAT(careless.err, HasSubstr("others may read it"));
  const ProcessResult unheard = stranger.Wait();
  EXPECT_EQ(unheard.exit_code, 3) << unheard.err;
  EXPECT_EQ(StatusOf(dir).at("runs_done"), 0);
  EXPECT_THAT(StatusOf(dir).at("rejected_messages"), testing::Gt(0));

  const std::unique_ptr<Process> worker = StartWorker(dir);
  EXPECT_TRUE(StatusBecomes(dir, [](const json& status) { return status.value("runs_done", 0) > 0; }))
      << worker->Err();
  EXPECT_EQ(Gauntlet({"stop", dir}).exit_code, 0);
  EXPECT_EQ(master->Wait().exit_code, 3);
  worker->Wait();

  const json keys = json::parse(ReadFile(dir + "/master.key"));
  for (const char* name : {"server_secret", "worker_secret"}) {
    const std::string key = keys.at(name);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir)) {
      if (!entry.is_regular_file() || entry.path().filename() == "master.key") continue;
      EXPECT_EQ(ReadFile(entry.path()).find(key), std::string::npos) << name << " stands in " << entry.path();
    }
    EXPECT_THAT(master->Err() + master->Out() + worker->Err(), Not(HasSubstr(key)));
  }
  std::filesystem::permissions(dir + "/master.key", std::filesystem::perms(0644));
  const ProcessResult refused = Gauntlet({"resume", dir, "--bind", "tcp://0.0.0.0:*"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("master.key"), HasSubstr("others may read it")));
}

TEST(ServiceTest, PlaintextOnAnOuterAddressIsAskedForAndSaid) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 2;
  std::vector<std::string> arguments = MasterArguments(campaign, scratch / "c", "tcp://0.0.0.0:*");
  arguments.push_back("--insecure");
  arguments.push_back("--quiet");
  const std::unique_ptr<Process> master = StartGauntlet(arguments);
  const std::unique_ptr<Process> worker = StartWorker(scratch / "c");
  const ProcessResult result = master->Wait();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("INSECURE"));
  EXPECT_EQ(worker->Wait().exit_code, 0);
}

}  // namespace
}  // namespace gauntlet
