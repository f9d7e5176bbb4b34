// Two masters on one campaign: there is only ever one that stores.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>

#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

constexpr int kMastersGenerations = 6;

SmallCampaign Campaign() {
  SmallCampaign campaign;
  campaign.generations = kMastersGenerations;
  return campaign;
}

// A frozen master lives: on its own host nobody takes the campaign from it, and it goes on when it wakes.
TEST(TwoMasters, OnOneHostAFrozenMasterKeepsItsCampaign) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(Campaign(), dir));
  const std::unique_ptr<Process> worker = StartSlowWorker(dir, 50);
  ASSERT_TRUE(RunsDone(dir, 8));
  master->Signal(SIGSTOP);
  const ProcessResult second = Gauntlet(ResumeArguments(dir));
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, HasSubstr(std::to_string(master->pid())));
  master->Signal(SIGCONT);
  EXPECT_EQ(master->Wait().exit_code, 0) << master->Err();
  EXPECT_EQ(StateHash(dir), UndisturbedHash(Campaign()));
}

// A copy that was made while the master served: it serves the original only.
TEST(TwoMasters, ACopyOfARunningCampaignHasNoMaster) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  const std::string copy = scratch / "copy";
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(Campaign(), dir));
  const std::unique_ptr<Process> worker = StartSlowWorker(dir, 50);
  ASSERT_TRUE(RunsDone(dir, 8));
  // Files do not change while they are copied: as a snapshot of the file system would be.
  master->Signal(SIGSTOP);
  std::filesystem::copy(dir, copy, std::filesystem::copy_options::recursive);
  master->Signal(SIGCONT);

  EXPECT_EQ(StatusOf(dir).value("state", ""), "running");
  const nlohmann::json status = StatusOf(copy);
  EXPECT_EQ(status.value("state", ""), "stopped") << status;
  EXPECT_TRUE(status.at("master").is_null());
  const ProcessResult stop = Gauntlet({"stop", copy}, std::chrono::seconds(30));
  EXPECT_EQ(stop.exit_code, 0);
  EXPECT_EQ(stop.err, "gauntlet: no master serves " + (scratch / "copy") + ": there is nothing to stop\n");
  EXPECT_FALSE(std::filesystem::exists(copy + "/stop"));

  const ProcessResult resumed = Gauntlet({"resume", copy, "--workers", "2", "--quiet"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(master->Wait().exit_code, 0) << master->Err();
  EXPECT_EQ(StateHash(copy), UndisturbedHash(Campaign()));
  EXPECT_EQ(StateHash(dir), UndisturbedHash(Campaign()));
  EXPECT_NE(ReadFile(copy + "/origin.json"), ReadFile(dir + "/origin.json"));
}

// A job that Slurm has started again fences its twin: woken, the twin sees the newer number and stops.
TEST(TwoMasters, OnOneHostAFrozenTwinThatIsFencedStopsWhenItWakes) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(Campaign(), dir));
  std::unique_ptr<Process> worker = StartSlowWorker(dir, 50);
  ASSERT_TRUE(RunsDone(dir, 8));
  master->Signal(SIGSTOP);
  // What `resume --as-job` does first, without a cluster: the next number.
  ASSERT_EQ(ReadFile(dir + "/epoch"), "1\n");
  std::ofstream(scratch / "epoch") << "2\n";
  std::filesystem::rename(scratch / "epoch", dir + "/epoch");
  master->Signal(SIGCONT);
  const ProcessResult stopped = master->Wait();
  EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("newer"));
  // Its worker waits for the twin, which goes on with what was stored.
  EXPECT_TRUE(worker->Running()) << worker->Err();
  const ProcessResult twin = Gauntlet(ResumeArguments(dir));
  EXPECT_EQ(twin.exit_code, 0) << twin.err;
  EXPECT_EQ(worker->Wait().exit_code, 0);
  EXPECT_EQ(StateHash(dir), UndisturbedHash(Campaign()));
}

// Two hosts and a file system that knows no locks between them: other pids, locks that each host keeps to
// itself, and the second host's clock two minutes ahead, so that the frozen master counts as dead at once.
TEST(TwoMasters, OnAnotherHostAFrozenMasterIsReplacedAndStopsWhenItWakes) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  const std::string local_locks = "LD_PRELOAD=" + FaultShimPath();
  const auto elsewhere = [](const std::vector<std::string>& command) {
    std::vector<std::string> argv = {"/usr/bin/unshare", "--map-root-user", "--pid",
                                     "--fork",           "--kill-child",    "--mount-proc"};
    argv.insert(argv.end(), command.begin(), command.end());
    return argv;
  };
  const ProcessResult possible = RunProcess(elsewhere({"/bin/true"}));
  if (possible.exit_code != 0) GTEST_SKIP() << "no pid namespace to be had here: " << possible.err;

  Process first(elsewhere(GauntletCommand(MasterArguments(Campaign(), dir))),
                {local_locks, "GAUNTLET_FAULT_LOCAL_LOCKS=1"});
  const std::unique_ptr<Process> worker = StartSlowWorker(dir, 50);
  ASSERT_TRUE(RunsDone(dir, 8)) << first.Err();
  SignalFamily(first, SIGSTOP);

  Process second(GauntletCommand(ResumeArguments(dir)),
                 {local_locks, "GAUNTLET_FAULT_LOCAL_LOCKS=1", "GAUNTLET_FAULT_CLOCK_OFFSET=120"});
  ASSERT_TRUE(Eventually([&] { return ReadFile(dir + "/epoch") == "2\n" || !second.Running(); }, kPatience));
  // The first wakes in the middle of it, or when all is over: it must not touch anything.
  SignalFamily(first, SIGCONT);
  const ProcessResult stopped = first.Wait();
  EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
  const ProcessResult done = second.Wait();
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(StateHash(dir), UndisturbedHash(Campaign()));
}

}  // namespace
}  // namespace gauntlet::testing_support
