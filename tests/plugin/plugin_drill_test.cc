// A campaign with a plug-in ends as any other, whatever happens to its processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/integration/durability_drill.h"
#include "tests/integration/service_driver.h"
#include "tests/plugin/plugin_files.h"

namespace gauntlet::testing_support {
namespace {

// Programs that are started meanwhile have their temporary files in this folder.
class ScopedTemporaryFiles {
 public:
  explicit ScopedTemporaryFiles(const std::string& folder) {
    setenv("TMPDIR", folder.c_str(), /*overwrite=*/1);
  }
  ~ScopedTemporaryFiles() { unsetenv("TMPDIR"); }
  ScopedTemporaryFiles(const ScopedTemporaryFiles&) = delete;
  ScopedTemporaryFiles& operator=(const ScopedTemporaryFiles&) = delete;
};

class PluginDrill : public testing::Test {
 protected:
  TemporaryDirectory scratch_;
  SmallCampaign campaign_ = SmallPlugin(scratch_);
};

TEST_F(PluginDrill, StateHashDoesNotDependOnTheNumberOfWorkers) {
  for (const int workers : {1, 4}) {
    const std::string dir = scratch_ / std::to_string(workers);
    const ProcessResult result = Gauntlet(EvolveArguments(campaign_, dir, workers));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(Show(dir)["runs_failed"], 0);
  }
  EXPECT_EQ(StateHash(scratch_ / "1"), StateHash(scratch_ / "4"));
}

TEST_F(PluginDrill, KilledMasterResumesToTheSameStateHash) {
  ASSERT_EQ(Gauntlet(EvolveArguments(campaign_, scratch_ / "undisturbed", 2)).exit_code, 0);
  EvolveThroughMasterKills(campaign_, scratch_ / "c", 2, 4, 1, std::chrono::milliseconds(900));
  EXPECT_EQ(StateHash(scratch_ / "c"), StateHash(scratch_ / "undisturbed"));
}

TEST_F(PluginDrill, KilledMasterResumesWithAScenarioOfAPlugin) {
  std::filesystem::copy_file(PluginPath("of_patrol"), scratch_ / "patrol.so");
  campaign_.experiment = scratch_ / "patrol.toml";
  std::ofstream(campaign_.experiment) << "scenario = 'my-patrol'\nplugins = ['patrol.so']\n";
  ASSERT_EQ(Gauntlet(EvolveArguments(campaign_, scratch_ / "undisturbed", 2)).exit_code, 0);
  EvolveThroughMasterKills(campaign_, scratch_ / "c", 2, 3, 1, std::chrono::milliseconds(900));
  EXPECT_EQ(StateHash(scratch_ / "c"), StateHash(scratch_ / "undisturbed"));
}

TEST_F(PluginDrill, KilledWorkersAndRunnersDoNotChangeTheStateHash) {
  ASSERT_EQ(Gauntlet(EvolveArguments(campaign_, scratch_ / "undisturbed", 2)).exit_code, 0);
  EvolveThroughWorkerKills(campaign_, scratch_ / "c", 2, 6, 2, std::chrono::milliseconds(200));
  EXPECT_EQ(StateHash(scratch_ / "c"), StateHash(scratch_ / "undisturbed"));
}

TEST_F(PluginDrill, KillsOfMastersAndWorkersTogetherLoseNothing) {
  campaign_.generations = 8;
  const MassacreReport report = EvolveThroughMassacre(
      campaign_, scratch_ / "c", 2, 3, 6, 2, std::chrono::milliseconds(700), std::chrono::milliseconds(100));
  EXPECT_EQ(report.master_kills, 3);
  EXPECT_EQ(report.worker_kills, 6);
  EXPECT_EQ(report.evaluated_after_stored, 0);
}

// A worker that cannot have the plug-in gives no result, and says why.
TEST_F(PluginDrill, WorkerWithAnotherLibraryLeaves) {
  const std::string dir = scratch_ / "c";
  const std::unique_ptr<Process> master = StartGauntlet(MasterArguments(campaign_, dir));
  ASSERT_TRUE(Serves(dir)) << master->Err();
  const std::string kept = dir + "/plugins/" + Sha256(ReadFile(PluginPath("of_twins"))) + ".so";
  std::filesystem::copy_file(PluginPath("of_faults"), kept,
                             std::filesystem::copy_options::overwrite_existing);
  const ProcessResult worker = StartWorker(dir)->Wait();
  EXPECT_EQ(worker.exit_code, 2);
  EXPECT_THAT(worker.err, testing::HasSubstr("is not the plug-in that the run was made for"));
  std::filesystem::copy_file(PluginPath("of_twins"), kept, std::filesystem::copy_options::overwrite_existing);
  const std::unique_ptr<Process> right = StartWorker(dir);
  EXPECT_EQ(master->Wait().exit_code, 0) << master->Err();
  EXPECT_EQ(Show(dir)["runs_failed"], 0);
}

// Runners that are killed leave their runs' folders; the next runner removes them.
TEST_F(PluginDrill, KilledRunnersLeaveNoFolders) {
  std::filesystem::create_directory(scratch_ / "tmp");
  const ScopedTemporaryFiles here(scratch_ / "tmp");
  EvolveThroughWorkerKills(campaign_, scratch_ / "c", 2, 6, 2, std::chrono::milliseconds(200));
  ASSERT_EQ(Gauntlet({"replay", scratch_ / "c", "1"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_empty(scratch_ / "tmp"));
}

// Every run begins with freshly loaded statics, whichever runner has it.
// A library that prints when it is loaded is loaded by each.
TEST_F(PluginDrill, RunsDoNotSeeEachOthersStatics) {
  for (const auto& [library, controller] : {std::pair{"of_faults", "counting"}, {"of_noise", "loud"}}) {
    const std::string dir = scratch_ / controller;
    const ProcessResult result =
        Gauntlet({"random", "flocking", "--cases", "40", "--dir", dir, "--workers", "2", "--quiet",
                  "--plugin", PluginPath(library), "--set", std::string("controller=") + controller, "--set",
                  "scenario_parameters.time_limit=2", "--audit", "1"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(Show(dir)["runs_failed"], 0);
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
