// Masters whose workers come from elsewhere: workers that outlive them, status and stop, keys.
// Covers: cli/options/stop_signal.cc, master/session/campaign_server.cc, master/session/campaign_service.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_database.h"
#include "tests/integration/service_driver.h"
#include "tests/support/local_socket.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

mode_t ModeOf(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 ? info.st_mode & 07777 : 0;
}

TEST(ServiceTest, WorkersOutliveAKilledMasterAndServeTheNext) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 15;
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
  EXPECT_EQ(status.at("why_nothing_runs"),
            "no worker is connected: start some with `gauntlet-worker --dir DIR`");
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
  EXPECT_EQ(Gauntlet({"stop", dir}).err,
            "gauntlet: no master serves " + (scratch / "c") + ": there is nothing to stop\n");
  EXPECT_FALSE(std::filesystem::exists(dir + "/stop"));
  EXPECT_EQ(Gauntlet({"status", scratch / "none"}).exit_code, 2);
}

// On loopback, too: other users of the machine reach it.
TEST(ServiceTest, EveryAddressIsEncryptedForKnownKeysAndTellsNobody) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 500;
  const std::string dir = scratch / "c";
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(campaign, dir));
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
  const ProcessResult careless = RunProcess({WorkerPath(), "--access", open});
  EXPECT_EQ(careless.exit_code, 2);
  EXPECT_THAT(careless.err, HasSubstr("others may read it"));
  const ProcessResult unheard = stranger.Wait();
  EXPECT_EQ(unheard.exit_code, 3) << unheard.err;
  EXPECT_EQ(StatusOf(dir).at("runs_done"), 0);
  EXPECT_THAT(StatusOf(dir).at("rejected_messages"), testing::Gt(0));

  const std::unique_ptr<Process> worker = StartWorker(dir);
  EXPECT_TRUE(StatusBecomes(dir, [](const json& status) { return status.value("runs_done", 0) > 0; }))
      << worker->Err();
  // Other users of the machine may read command lines; files of the directory are read while they are
  // written.
  std::string told;
  for (const pid_t process : {master->pid(), worker->pid()}) {
    std::vector<pid_t> family = DescendantsOf(process);
    family.push_back(process);
    for (const pid_t pid : family) {
      for (const char* what : {"cmdline", "environ"}) {
        told += ReadFile("/proc/" + std::to_string(pid) + "/" + what);
      }
    }
  }
  for (const auto& entry : std::filesystem::directory_iterator(dir)) {
    if (entry.path().filename().string().rfind("campaign.db", 0) == 0) told += ReadFile(entry.path());
  }
  EXPECT_THAT(told, AllOf(HasSubstr(dir), HasSubstr("PATH="), HasSubstr("SQLite format 3")));
  EXPECT_EQ(Gauntlet({"stop", dir}).exit_code, 0);
  EXPECT_EQ(master->Wait().exit_code, 3);
  worker->Wait();

  const json keys = json::parse(ReadFile(dir + "/master.key"));
  for (const char* name : {"server_secret", "worker_secret"}) {
    const std::string key = keys.at(name);
    EXPECT_EQ(told.find(key), std::string::npos)
        << name << " stands in a command line, environment or database";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir)) {
      if (!entry.is_regular_file() || entry.path().filename() == "master.key") continue;
      EXPECT_EQ(ReadFile(entry.path()).find(key), std::string::npos) << name << " stands in " << entry.path();
    }
    EXPECT_THAT(master->Err() + master->Out() + worker->Err(), Not(HasSubstr(key)));
  }
  std::filesystem::permissions(dir + "/master.key", std::filesystem::perms(0644));
  const ProcessResult refused = Gauntlet({"resume", dir});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, "gauntlet: " + (scratch / "c/master.key") +
                             " holds the campaign's secret keys and has mode 644: others may read it. Delete "
                             "it, and new keys are made\n");
}

TEST(ServiceTest, MetricsAreServedOnThisMachinesOwnAddress) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 500;
  const std::string dir = scratch / "c";
  std::vector<std::string> arguments = MasterArguments(campaign, dir);
  arguments.insert(arguments.end(), {"--metrics-port", "0"});
  const std::unique_ptr<Process> master = StartGauntlet(arguments);
  const std::unique_ptr<Process> worker = StartWorker(dir);
  ASSERT_TRUE(StatusBecomes(dir, [](const json& status) { return status.value("runs_done", 0) > 0; }));
  const std::string url = StatusOf(dir).at("master").at("metrics");
  EXPECT_THAT(url, testing::MatchesRegex("http://127.0.0.1:[0-9]+/metrics"));
  const std::string answer =
      Converse(std::stoi(url.substr(url.rfind(':') + 1)), "GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(answer, AllOf(HasSubstr("200 OK"), HasSubstr("experiment=\"flocking\""),
                            testing::ContainsRegex("gauntlet_runs_stored_total [1-9]"),
                            HasSubstr("gauntlet_workers{state=")));
  EXPECT_EQ(Gauntlet({"stop", dir}).exit_code, 0);
  EXPECT_EQ(master->Wait().exit_code, 3);

  for (const std::string port : {"x", "65536", "-1"}) {
    const ProcessResult refused =
        Gauntlet({"evolve", "flocking", "--dir", scratch / "none", "--metrics-port", port});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("--metrics-port " + port + ": must be a port from 1 to 65535"));
  }
  EXPECT_FALSE(std::filesystem::exists(scratch / "none"));
}

TEST(ServiceTest, ARefusedAddressLeavesNothingSoThatTheCorrectedCommandWorks) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  const ListeningSocket taken;
  const std::string in_use = "tcp://127.0.0.1:" + std::to_string(taken.port());
  // 203.0.113.77 belongs to no machine (RFC 5737).
  for (const std::string& bad :
       std::vector<std::string>{in_use, "tcp://203.0.113.77:*", "tcp://127.0.0.1:99999"}) {
    const ProcessResult refused = Gauntlet(MasterArguments(SmallCampaign(), dir, bad));
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("cannot listen on '" + bad + "'"));
    EXPECT_FALSE(std::filesystem::exists(dir)) << bad;
  }
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(SmallCampaign(), dir));
  const std::unique_ptr<Process> worker = StartWorker(dir);
  EXPECT_EQ(master->Wait().exit_code, 0) << master->Err();
}

TEST(ServiceTest, PlaintextIsAskedForAndSaidOnEveryAddress) {
  SmallCampaign campaign;
  campaign.generations = 2;
  for (const std::string endpoint : {"tcp://0.0.0.0:*", "tcp://127.0.0.1:*"}) {
    const TemporaryDirectory scratch;
    std::vector<std::string> arguments = Insecure(MasterArguments(campaign, scratch / "c", endpoint));
    arguments.emplace_back("--quiet");
    const std::unique_ptr<Process> master = StartGauntlet(arguments);
    const std::unique_ptr<Process> worker = StartWorker(scratch / "c");
    const ProcessResult result = master->Wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("INSECURE"));
    EXPECT_THAT(MasterLog(scratch / "c"), HasSubstr("INSECURE: whoever reaches tcp://"));
    EXPECT_EQ(worker->Wait().exit_code, 0);
  }
}

TEST(ServiceTest, AnIpcEndpointIsEncryptedToo) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 2;
  const std::string dir = scratch / "c";
  const std::unique_ptr<Process> master =
      StartGauntlet(MasterArguments(campaign, dir, "ipc://" + scratch / "socket"));
  ASSERT_TRUE(Serves(dir));
  EXPECT_TRUE(json::parse(ReadFile(dir + "/access.json")).contains("curve"));
  const std::unique_ptr<Process> worker = StartWorker(dir);
  EXPECT_EQ(master->Wait().exit_code, 0) << master->Err();
  EXPECT_EQ(StateHash(dir), UndisturbedHash(campaign));
}

}  // namespace
}  // namespace gauntlet::testing_support
