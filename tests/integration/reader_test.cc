// Reading commands beside a master that goes on: on its machine, and from what takes itself for another one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class ReaderTest : public testing::Test {
 protected:
  void SetUp() override {
    SmallCampaign campaign;
    campaign.generations = 500;
    master_ = StartGauntlet(MasterArguments(campaign, dir_));
    ASSERT_TRUE(Serves(dir_)) << master_->Err();
    worker_ = StartWorker(dir_);
    ASSERT_TRUE(RunsDone(dir_, 8)) << worker_->Err();
  }
  void TearDown() override {
    EXPECT_EQ(Gauntlet({"stop", dir_}).exit_code, 0);
    EXPECT_EQ(master_->Wait().exit_code, 3) << master_->Err();
    worker_->Wait();
    EXPECT_FALSE(std::filesystem::exists(dir_ + "/snapshot.db"));
    EXPECT_FALSE(std::filesystem::exists(dir_ + "/campaign.db-wal"));
  }

  TemporaryDirectory scratch_;
  std::string dir_ = scratch_ / "c";
  std::unique_ptr<Process> master_;
  std::unique_ptr<Process> worker_;
};

TEST_F(ReaderTest, ShowReplayAndTheShellOfSqliteWorkBesideTheMaster) {
  const ProcessResult show = Gauntlet({"show", dir_, "--json"});
  ASSERT_EQ(show.exit_code, 0) << show.err;
  const json summary = json::parse(show.out);
  EXPECT_GE(summary.at("runs_done"), 8);
  EXPECT_EQ(summary.at("finished"), false);
  EXPECT_EQ(show.err, "");
  const ProcessResult replay = Gauntlet({"replay", dir_, "3", "--svg", scratch_ / "run.svg"});
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "run.svg"));
  EXPECT_TRUE(RunsDone(dir_, summary.at("runs_done").get<int>() + 1)) << "the master goes on";
}

TEST_F(ReaderTest, CompareSaysThatTheCampaignIsBeingWritten) {
  const ProcessResult compare = Gauntlet({"compare", dir_ + ":all", dir_ + ":all", "--json"});
  ASSERT_EQ(compare.exit_code, 0) << compare.err;
  const json comparison = json::parse(compare.out);
  EXPECT_GE(comparison.at("n1"), 8);
  EXPECT_EQ(comparison.at("notes").dump(),
            "[\"" + (scratch_ / "c") + " is being written: its runs as they were stored just now\",\"" +
                (scratch_ / "c") + " is half-finished: what it has so far is compared\",\"" +
                (scratch_ / "c") + " is being written: its runs as they were stored just now\",\"" +
                (scratch_ / "c") + " is half-finished: what it has so far is compared\"]");
}

TEST_F(ReaderTest, ExportSaysThatTheCampaignIsBeingWritten) {
  const ProcessResult ended = Gauntlet({"export", dir_, "--format", "json", "--out", scratch_ / "runs.json"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr(dir_ + " is being written"));
  EXPECT_THAT(ended.err, HasSubstr(dir_ + " is half-finished"));
  const json exported = json::parse(ReadFile(scratch_ / "runs.json"));
  EXPECT_GE(exported.at("runs").size(), 8U);
  EXPECT_EQ(exported.at("finished"), false);
  EXPECT_EQ(exported.at("notes").size(), 2U);
  EXPECT_TRUE(RunsDone(dir_, static_cast<int>(exported.at("runs").size()) + 1)) << "the master goes on";
}

TEST_F(ReaderTest, AnotherMachineSeesASnapshotAndIsToldOfWhen) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can make a process that takes the master for a stranger";
  // In a namespace of its own a pid means another process: the master may be anywhere.
  std::vector<std::string> elsewhere = {"/usr/bin/unshare", "--pid", "--fork"};
  for (const std::string& argument : GauntletCommand({"show", dir_, "--json"})) elsewhere.push_back(argument);
  ProcessResult show;
  ASSERT_TRUE(Eventually(
      [&] {
        show = RunProcess(elsewhere);
        return show.exit_code == 0 && json::parse(show.out).at("runs_done") >= 1;
      },
      kPatience))
      << show.err;
  EXPECT_THAT(show.err, HasSubstr("is served from another machine; this is what was stored as of "));
}

}  // namespace
}  // namespace gauntlet::testing_support
