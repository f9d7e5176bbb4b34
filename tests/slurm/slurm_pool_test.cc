#include "slurm/slurm_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>

#include "tests/support/fake_slurm.h"

namespace gauntlet::slurm {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

class SlurmPoolTest : public testing::Test {
 protected:
  SlurmPoolTest() { Restart(); }
  void Restart() {
    pool_.reset();
    SlurmPoolOptions options;
    options.limits.max_allocations = 3;
    options.limits.max_queued = 3;
    options.job = {
        .name = "gauntlet-ab12-w", .worker = "w", .access_file = "/a", .log_directory = "/l", .slots = 1};
    options.job_template = std::string(kWorkerTemplate);
    pool_ = std::make_unique<SlurmPool>(options, cluster_.MakeClient());
  }
  // Supervises, with the clock going on, until the pool's thread has nothing to say for a while.
  void Settle() {
    constexpr int kQuietMilliseconds = 100;
    for (int i = 0; i < 100; ++i) {
      now_ += seconds(1);
      pool_->Observe(view_, now_);
      ASSERT_TRUE(pool_->Supervise(now_).ok());
      for (DispatchEvent& event : pool_->TakeEvents()) events_ += event.text + "\n";
      std::vector<int> fds;
      pool_->AppendWaitFds(fds);
      pollfd waiting{fds.at(0), POLLIN, 0};
      if (poll(&waiting, 1, kQuietMilliseconds) == 0) return;
    }
    FAIL() << "the pool never comes to rest";
  }
  // One interval of queries further.
  void Later() {
    now_ += seconds(10);
    Settle();
  }

  testing_support::FakeSlurm cluster_;
  PoolView view_;
  TimePoint now_ = TimePoint{} + std::chrono::hours(1);
  std::string events_;
  std::unique_ptr<SlurmPool> pool_;
};

TEST_F(SlurmPoolTest, SubmitsWhatTheRunsNeedUnderNamesOfTheCampaign) {
  view_.unfinished_runs = 2;
  Settle();
  EXPECT_THAT(cluster_.names(), ElementsAre("gauntlet-ab12-w1", "gauntlet-ab12-w1"))
      << "two equal ones are an array";
  view_.unfinished_runs = 100;
  Settle();
  EXPECT_THAT(cluster_.names(), ElementsAre("gauntlet-ab12-w1", "gauntlet-ab12-w1", "gauntlet-ab12-w2"));
  EXPECT_EQ(pool_->running(), 3);
}

TEST_F(SlurmPoolTest, AdoptsTheJobsOfAnEarlierMasterBeforeItSubmitsAny) {
  cluster_.Add("70", "gauntlet-ab12-w9", "RUNNING");
  cluster_.Add("71", "somebody-else", "RUNNING");
  view_.unfinished_runs = 1;
  Settle();
  EXPECT_EQ(cluster_.names().size(), 2U) << "one run, one allocation: the adopted one";
  EXPECT_EQ(events_, "adopted job 70 (RUNNING)\n");
  pool_.reset();
  EXPECT_THAT(cluster_.cancelled, ElementsAre("70"));
}

TEST_F(SlurmPoolTest, AJobWhoseSubmissionsAnswerWasLostIsFoundByItsName) {
  cluster_.loses_answers = true;
  view_.unfinished_runs = 1;
  Settle();
  Later();
  Later();
  EXPECT_EQ(cluster_.names().size(), 1U) << "not submitted twice";
  EXPECT_EQ(pool_->running(), 1);
}

TEST_F(SlurmPoolTest, SaysWhyNothingStartsAndTriesAgain) {
  cluster_.refusal = "sbatch refused (exit code 1): Invalid account";
  view_.unfinished_runs = 1;
  Settle();
  EXPECT_EQ(pool_->Trouble(now_),
            "1 start has failed: sbatch refused (exit code 1): Invalid account; the next try is in 16 s; "
            "name yours: --slurm account=NAME (`sacctmgr show associations user=$USER` lists them)");
  EXPECT_EQ(events_,
            "1 start has failed: sbatch refused (exit code 1): Invalid account; the next try is in 16 s; "
            "name yours: --slurm account=NAME (`sacctmgr show associations user=$USER` lists them)\n");
  cluster_.refusal = "";
  now_ += seconds(15);
  Settle();
  EXPECT_EQ(cluster_.names().size(), 1U);
}

TEST_F(SlurmPoolTest, CountsWorkersByTheirAllocation) {
  view_.unfinished_runs = 1;
  Settle();
  view_.workers = {{.allocation = "1:0:node1", .busy = true}, {.allocation = "", .busy = true}};
  Settle();
  ASSERT_EQ(pool_->Allocations().size(), 1U);
  EXPECT_EQ(pool_->Allocations()[0].workers, 1);
  EXPECT_EQ(pool_->Trouble(now_), "");
}

TEST_F(SlurmPoolTest, GivesIdleAllocationsBackAndNeverAdoptsThemAgain) {
  view_.unfinished_runs = 1;
  Settle();
  cluster_.Set("1", "RUNNING");
  view_.workers = {{.allocation = "1:0:node1", .busy = false}};
  view_.unfinished_runs = 0;
  Later();
  now_ += seconds(300);
  Settle();
  EXPECT_THAT(cluster_.cancelled, ElementsAre("1"));
  Later();
  EXPECT_EQ(pool_->running(), 0);
}

TEST_F(SlurmPoolTest, ACancelledJobThatSlurmStillShowsIsNotAdopted) {
  view_.unfinished_runs = 1;
  Settle();
  pool_->SignalAll(15);
  Settle();
  EXPECT_EQ(pool_->running(), 0);
  EXPECT_THAT(cluster_.names(), IsEmpty());
}

TEST_F(SlurmPoolTest, CancelsATaskOfAnArrayAloneAndTellsItsWorkersFromTheOthers) {
  view_.unfinished_runs = 2;
  Settle();
  cluster_.Set("1_1", "RUNNING");
  cluster_.Set("1_2", "RUNNING");
  view_.unfinished_runs = 1;
  for (int i = 0; i < 35; ++i) {
    view_.workers = {{.allocation = "1_1:0:node1", .busy = true},
                     {.allocation = "1_2:0:node1", .busy = false}};
    Later();
  }
  EXPECT_THAT(cluster_.cancelled, ElementsAre("1_2"));
  EXPECT_EQ(pool_->running(), 1);
}

TEST_F(SlurmPoolTest, CancelsAgainWhatTheControllerDidNotHear) {
  view_.unfinished_runs = 1;
  Settle();
  cluster_.Set("1", "RUNNING");
  Later();
  cluster_.deaf = true;
  for (int i = 0; i < 15; ++i) Later();  // no worker ever says hello
  EXPECT_THAT(cluster_.cancelled, IsEmpty());
  cluster_.deaf = false;
  Later();
  EXPECT_THAT(cluster_.cancelled, ElementsAre("1"));
}

TEST_F(SlurmPoolTest, AsksSlurmAtMostOncePerIntervalWhateverGoesWrong) {
  view_.unfinished_runs = 50;
  cluster_.controller_error = "Unable to contact slurm controller (connect failure)";
  cluster_.refusal = cluster_.controller_error;
  const TimePoint start = now_;
  for (int i = 0; i < 30; ++i) {
    Settle();
    if (i == 10) cluster_.controller_error = "";
    if (i == 20) cluster_.refusal = "";
  }
  const auto elapsed = std::chrono::duration_cast<seconds>(now_ - start).count();
  EXPECT_LE(cluster_.queries, elapsed / 10 + 1);
  EXPECT_GE(cluster_.queries, 2);
}

TEST_F(SlurmPoolTest, LeavesItsJobsToASuccessorWhenReleased) {
  view_.unfinished_runs = 2;
  Settle();
  EXPECT_TRUE(pool_->Release());
  pool_->SignalAll(15);
  Restart();
  EXPECT_EQ(cluster_.names().size(), 2U);
  EXPECT_THAT(cluster_.cancelled, IsEmpty());
  Settle();
  EXPECT_EQ(pool_->running(), 2) << "adopted";
}

TEST_F(SlurmPoolTest, LeavesNothingBehind) {
  view_.unfinished_runs = 3;
  Settle();
  cluster_.Set("1_2", "RUNNING");
  pool_.reset();
  EXPECT_THAT(cluster_.names(), IsEmpty());
}

TEST_F(SlurmPoolTest, ASilentControllerLosesNoAllocation) {
  view_.unfinished_runs = 1;
  Settle();
  cluster_.controller_error = "Unable to contact slurm controller (connect failure)";
  for (int i = 0; i < 5; ++i) Later();
  EXPECT_EQ(pool_->running(), 1);
  EXPECT_EQ(pool_->Trouble(now_),
            "Slurm does not answer: Unable to contact slurm controller (connect failure); what runs goes on; "
            "`scontrol ping` says when it is back");
  cluster_.controller_error = "";
  Later();
  EXPECT_EQ(cluster_.names().size(), 1U);
}

}  // namespace
}  // namespace gauntlet::slurm
