// Covers: slurm/slurm_pool.h
// What a pool does on clusters other than Slurm's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <fstream>

#include "slurm/slurm_pool.h"
#include "tests/support/fake_slurm.h"
#include "tests/support/process.h"

namespace gauntlet::slurm {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

class ClusterPoolTest : public testing::Test {
 protected:
  void Begin(const std::string& changes, const std::string& base = "like = \"sge\"\n") {
    const Result<Cluster> cluster = ReadCluster(base + changes, "lab.toml");
    ASSERT_TRUE(cluster.ok()) << cluster.error().message;
    SlurmPoolOptions options;
    options.limits.max_allocations = 2;
    options.cluster = *cluster;
    options.job = {
        .name = "gauntlet-ab12-w", .worker = "w", .access_file = "/a", .log_directory = logs_.path()};
    options.job_template = "#--job-name=@JOB_NAME@\n@DIRECTIVES@\n@RUN@";
    pool_ = std::make_unique<SlurmPool>(options, cluster_.MakeClient());
  }
  // One look at the queue further, with all that follows of it; the error that ends the master, "" = none.
  std::string Later(seconds step = seconds(10)) {
    now_ += step;
    constexpr int kQuietMilliseconds = 100;
    for (int i = 0; i < 100; ++i) {
      pool_->Observe(view_, now_);
      const Result<std::vector<pid_t>> done = pool_->Supervise(now_);
      if (!done) return done.error().message;
      for (DispatchEvent& event : pool_->TakeEvents()) events_ += event.text + "\n";
      std::vector<int> fds;
      pool_->AppendWaitFds(fds);
      pollfd waiting{fds.at(0), POLLIN, 0};
      if (poll(&waiting, 1, kQuietMilliseconds) == 0) return "";
    }
    return "the pool never comes to rest";
  }

  testing_support::TemporaryDirectory logs_;
  testing_support::FakeSlurm cluster_;
  PoolView view_{.unfinished_runs = 1, .workers = {}};
  TimePoint now_ = TimePoint{} + std::chrono::hours(1);
  std::string events_;
  std::unique_ptr<SlurmPool> pool_;
};

TEST_F(ClusterPoolTest, GivesUpWhenNothingEverStarts) {
  Begin("give_up_after = 3");
  cluster_.refusal = "qsub refused (exit code 1): denied";
  std::string why;
  for (int i = 0; i < 100 && why.empty(); ++i) why = Later(seconds(20));
  EXPECT_EQ(why,
            "gave up after 3 failed starts in a row, without a word from any worker; the last: qsub refused "
            "(exit code 1): denied");
}

TEST_F(ClusterPoolTest, DoesNotGiveUpOnceAWorkerHasSpoken) {
  Begin("give_up_after = 2");
  EXPECT_EQ(Later(), "");
  view_.workers = {{.allocation = "1:0:n", .busy = true}};
  EXPECT_EQ(Later(), "");
  view_.workers.clear();
  cluster_.jobs.clear();
  cluster_.refusal = "denied";
  for (int i = 0; i < 5; ++i) EXPECT_EQ(Later(seconds(900)), "");
}

TEST_F(ClusterPoolTest, WhereNothingCanBeSubmittedItEndsAtOnceUnlessSomethingLives) {
  Begin("");
  EXPECT_EQ(Later(), "");
  cluster_.hopeless = "there is no qsub in PATH";
  view_.unfinished_runs = 100;
  EXPECT_EQ(Later(), "") << "a job waits";
  cluster_.hopeless = "";
  EXPECT_EQ(Later(seconds(30)), "");
  cluster_.jobs.clear();
  EXPECT_EQ(Later(), "");
  EXPECT_EQ(Later(), "") << "it could submit again meanwhile";
  cluster_.jobs.clear();
  cluster_.hopeless = "there is no qsub in PATH";
  std::string why;
  for (int i = 0; i < 20 && why.empty(); ++i) why = Later(seconds(100));
  EXPECT_EQ(why, "there is no qsub in PATH");
}

TEST_F(ClusterPoolTest, WhereThereWasNoRoomItLooksAgain) {
  Begin("give_up_after = 1");
  cluster_.full = "no host has room for another job";
  for (int i = 0; i < 3; ++i) EXPECT_EQ(Later(), "") << "no failed start";
  EXPECT_EQ(pool_->Trouble(now_), "no host has room for another job");
  const int looks = cluster_.queries;
  EXPECT_EQ(Later(), "");
  EXPECT_GT(cluster_.queries, looks) << "by which hosts are known to be free again";
  cluster_.full = "";
  EXPECT_EQ(Later(), "");
  EXPECT_EQ(pool_->running(), 1);
  EXPECT_EQ(pool_->Trouble(now_), "job 1 waits in the queue");
}

TEST_F(ClusterPoolTest, WithoutAnAnswerItCancelsWhatItKnows) {
  Begin("");
  EXPECT_EQ(Later(), "");
  cluster_.controller_error = "no answer";
  pool_.reset();
  EXPECT_THAT(cluster_.cancelled, ElementsAre("1"));
}

TEST_F(ClusterPoolTest, WorkersAreKnownByJobsWhoseIdsHaveColons) {
  Begin("");
  cluster_.id_prefix = "lab:";
  EXPECT_EQ(Later(), "");
  view_.workers = {{.allocation = "lab:1:0:n", .busy = true}};
  EXPECT_EQ(Later(), "");
  ASSERT_THAT(pool_->Allocations(), SizeIs(1));
  EXPECT_EQ(pool_->Allocations()[0].workers, 1);
}

TEST_F(ClusterPoolTest, SlurmIsNeverGivenUp) {
  Begin("give_up_after = 0");
  cluster_.refusal = "denied";
  for (int i = 0; i < 30; ++i) EXPECT_EQ(Later(seconds(900)), "");
}

TEST_F(ClusterPoolTest, AJobThatVanishedHasEndedWithItsExitCode) {
  Begin("");
  EXPECT_EQ(Later(), "");
  ASSERT_EQ(pool_->running(), 1);
  cluster_.jobs.clear();
  std::ofstream(logs_ / "1.exit") << "2\n";
  EXPECT_EQ(Later(), "");
  EXPECT_THAT(pool_->Trouble(now_),
              HasSubstr("job 1 ended (FAILED, exit code 2) before its worker said hello"));
}

TEST_F(ClusterPoolTest, AJobThatNeverWasIsGoneAtTheSecondLook) {
  Begin("");
  EXPECT_EQ(Later(), "");
  cluster_.jobs.clear();
  EXPECT_EQ(Later(), "");
  EXPECT_EQ(pool_->running(), 1) << "once may be a hiccup";
  EXPECT_EQ(Later(), "");
  EXPECT_EQ(pool_->running(), 0);
}

TEST_F(ClusterPoolTest, AStateCanBeOneThatNeverStarts) {
  Begin("");
  EXPECT_EQ(Later(), "");
  cluster_.jobs.at(0).state = "Eqw";
  EXPECT_EQ(Later(), "");
  EXPECT_THAT(cluster_.cancelled, ElementsAre("1"));
  EXPECT_THAT(pool_->Trouble(now_), HasSubstr("job 1 would never start: Eqw"));
}

TEST_F(ClusterPoolTest, EqualJobsAreAnArrayWhereThereAreArrays) {
  Begin("");
  view_.unfinished_runs = 100;
  EXPECT_EQ(Later(), "");
  ASSERT_THAT(cluster_.submitted, SizeIs(1));
  EXPECT_THAT(cluster_.submitted[0], HasSubstr("#$ -t 1-2\n"));
}

TEST_F(ClusterPoolTest, WithoutArraysEveryJobIsSubmittedByItself) {
  Begin("", "hosts = [\"a:2\"]\n");
  view_.unfinished_runs = 100;
  EXPECT_EQ(Later(), "");
  EXPECT_THAT(cluster_.submitted, SizeIs(2));
  EXPECT_EQ(pool_->running(), 2);
}

}  // namespace
}  // namespace gauntlet::slurm
