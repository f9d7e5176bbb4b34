#include "slurm/pool_policy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace gauntlet::slurm {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr TimePoint kStart = TimePoint{} + std::chrono::hours(1);

PoolLimits SmallPool() {
  PoolLimits limits;
  limits.max_allocations = 4;
  limits.max_queued = 2;
  limits.workers_per_allocation = 2;
  return limits;
}

JobStatus Job(const std::string& id, const std::string& state, const std::string& node = "",
              const std::string& reason = "") {
  return {.id = id, .name = "w", .state = state, .phase = PhaseOf(state), .reason = reason, .nodes = node};
}

class PoolPolicyTest : public testing::Test {
 protected:
  // Submits what the policy wants; returns the new jobs' ids.
  std::vector<std::string> Grow(int runs) {
    std::vector<std::string> jobs;
    const Decisions decisions = policy_.Decide({.unfinished_runs = runs}, now_);
    for (int i = 0; i < decisions.submit; ++i) {
      jobs.push_back(std::to_string(++last_job_));
      policy_.Submitted(jobs.back(), now_);
    }
    return jobs;
  }
  void Connect(const std::string& job, const std::string& node = "node1") {
    policy_.Observed({Job(job, "RUNNING", node)}, now_);
    policy_.Workers(job, 2, 2, now_);
  }
  std::string Trouble() const { return policy_.Trouble(now_); }

  PoolPolicy policy_{SmallPool()};
  TimePoint now_ = kStart;
  int last_job_ = 0;
};

TEST_F(PoolPolicyTest, GrowsByTheBacklogUpToTheCapAndNotBeyond) {
  EXPECT_EQ(Grow(100).size(), 2U) << "two may wait";
  EXPECT_EQ(Grow(100).size(), 0U);
  policy_.Workers("1", 2, 2, now_);
  EXPECT_EQ(Grow(100).size(), 1U);
  policy_.Workers("2", 2, 2, now_);
  policy_.Workers("3", 2, 2, now_);
  EXPECT_EQ(Grow(100).size(), 1U);
  policy_.Workers("4", 2, 2, now_);
  EXPECT_EQ(Grow(100).size(), 0U) << "four is the cap";
}

TEST_F(PoolPolicyTest, AsksForNoMoreThanTheRunsCanUse) {
  EXPECT_EQ(Grow(0).size(), 0U);
  EXPECT_EQ(Grow(2).size(), 1U) << "two runs fill one allocation of two workers";
  EXPECT_EQ(Grow(2).size(), 0U);
  EXPECT_EQ(Grow(3).size(), 1U);
}

TEST_F(PoolPolicyTest, GivesBackWhatIsIdleTooLongAndWhatStillWaitsForNothing) {
  Grow(4);
  Connect("1");
  policy_.Workers("1", 2, 0, now_);
  now_ += seconds(299);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 4}, now_).cancel, IsEmpty());
  now_ += seconds(1);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 0}, now_).cancel, ElementsAre("1"));
  now_ += seconds(299);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 0}, now_).cancel, IsEmpty());
  now_ += seconds(1);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 0}, now_).cancel, ElementsAre("2"));
}

TEST_F(PoolPolicyTest, TheMomentBetweenTwoGenerationsCancelsNothing) {
  Grow(4);
  for (int i = 0; i < 1000; ++i) {
    now_ += seconds(1);
    EXPECT_THAT(policy_.Decide({.unfinished_runs = i % 2}, now_).cancel, IsEmpty());
  }
}

TEST_F(PoolPolicyTest, AJobThatFailsSoonAfterItsHelloHasFailedToStart) {
  Grow(2);
  Connect("1", "node2");
  now_ += seconds(5);
  policy_.Workers("1", 0, 0, now_);
  EXPECT_EQ(Trouble(), "");
  policy_.Observed({Job("1", "FAILED", "node2", "NonZeroExitCode")}, now_);
  EXPECT_EQ(Trouble(),
            "1 start has failed: job 1 on node2 ended (FAILED, NonZeroExitCode) soon after its start; the "
            "next try is in 16 s");
}

TEST_F(PoolPolicyTest, ADrainIsNoFailureHoweverSoon) {
  Grow(2);
  Connect("1");
  now_ += seconds(5);
  policy_.Workers("1", 0, 0, now_);
  policy_.Observed({Job("1", "COMPLETED", "node1")}, now_);
  EXPECT_EQ(Trouble(), "");
  EXPECT_THAT(Grow(2), ElementsAre("2"));
}

TEST_F(PoolPolicyTest, AJobThatRunsOnWithoutItsWorkerIsGivenUp) {
  Grow(2);
  Connect("1");
  now_ += seconds(1000);
  policy_.Workers("1", 0, 0, now_);
  policy_.Observed({Job("1", "RUNNING", "node1")}, now_);
  now_ += seconds(119);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 2}, now_).cancel, IsEmpty());
  policy_.Workers("1", 0, 0, now_);
  now_ += seconds(1);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 2}, now_).cancel, ElementsAre("1"));
}

TEST_F(PoolPolicyTest, WorkEndsTheIdleTime) {
  Grow(2);
  Connect("1");
  policy_.Workers("1", 2, 0, now_);
  now_ += seconds(200);
  policy_.Workers("1", 2, 1, now_);
  policy_.Workers("1", 2, 0, now_);
  now_ += seconds(200);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 1}, now_).cancel, IsEmpty());
}

TEST_F(PoolPolicyTest, ReplacesAnAllocationThatEndedAfterItWorked) {
  Grow(2);
  Connect("1");
  now_ += seconds(100);
  policy_.Workers("1", 0, 0, now_);
  policy_.Observed({Job("1", "PREEMPTED", "node1")}, now_);
  EXPECT_THAT(Grow(2), ElementsAre("2")) << "at once: that was no failed start";
  EXPECT_EQ(Trouble(), "job 2 waits in the queue");
}

TEST_F(PoolPolicyTest, FailedStartsBackOffAndSayWhyInSlurmsWords) {
  Grow(2);
  policy_.Observed({Job("1", "FAILED", "node3", "NonZeroExitCode")}, now_);
  EXPECT_EQ(Trouble(),
            "1 start has failed: job 1 on node3 ended (FAILED, NonZeroExitCode) before its worker said "
            "hello: its log is log/worker-JOB.log in the campaign's directory; when there is none, the node "
            "does not see that directory, which must be on a file system shared with the compute nodes "
            "(--dir); the next try is in 16 s");
  EXPECT_THAT(Grow(2), IsEmpty());
  now_ += seconds(15);
  EXPECT_THAT(Grow(100), ElementsAre("2")) << "one shows whether the cause is gone";
  policy_.Observed({Job("2", "FAILED", "node2")}, now_);
  now_ += seconds(29);
  EXPECT_THAT(Grow(2), IsEmpty()) << "the delay doubles";
  now_ += seconds(1);
  EXPECT_THAT(Grow(2), ElementsAre("3"));
  Connect("3");
  EXPECT_EQ(Trouble(), "");
  EXPECT_EQ(Grow(100).size(), 2U) << "a hello ends the suspicion";
}

TEST_F(PoolPolicyTest, OneBadNodeDoesNotHoldBackTheOthersForever) {
  Grow(4);
  Connect("1", "node1");
  policy_.Observed({Job("1", "RUNNING", "node1"), Job("2", "FAILED", "node2")}, now_);
  now_ += seconds(15);
  EXPECT_THAT(Grow(100), ElementsAre("3")) << "job 1 works on meanwhile";
}

TEST_F(PoolPolicyTest, LeavesOutANodeWhoseWorkersKeepFailing) {
  for (int failure = 0; failure < 2; ++failure) {
    now_ += seconds(1000);
    const std::vector<std::string> jobs = Grow(2);
    ASSERT_EQ(jobs.size(), 1U);
    policy_.Observed({Job(jobs[0], "FAILED", "node3")}, now_);
  }
  now_ += seconds(1000);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 2}, now_).exclude_nodes, ElementsAre("node3"));
}

TEST_F(PoolPolicyTest, AStartThatTakesTooLongIsCancelledAndCounts) {
  Grow(2);
  policy_.Observed({Job("1", "RUNNING", "node2")}, now_);
  now_ += seconds(119);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 2}, now_).cancel, IsEmpty());
  now_ += seconds(1);
  const Decisions decisions = policy_.Decide({.unfinished_runs = 2}, now_);
  EXPECT_THAT(decisions.cancel, ElementsAre("1"));
  EXPECT_EQ(decisions.submit, 0);
  EXPECT_EQ(Trouble(),
            "1 start has failed: job 1 on node2 has run for 120 s without a word from its worker; the next "
            "try is in 16 s");
}

TEST_F(PoolPolicyTest, AJobThatNeverStartsIsCancelledWithItsReason) {
  Grow(2);
  policy_.Observed({Job("1", "PENDING", "", "PartitionNodeLimit")}, now_);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 2}, now_).cancel, ElementsAre("1"));
  EXPECT_EQ(Trouble(),
            "1 start has failed: job 1 would never start: PartitionNodeLimit; the next try is in 16 s");
}

TEST_F(PoolPolicyTest, AWaitingJobIsLeftAloneAndItsReasonIsTold) {
  Grow(2);
  policy_.Observed({Job("1", "PENDING", "", "Priority")}, now_);
  now_ += std::chrono::hours(48);
  policy_.Observed({Job("1", "PENDING", "", "Priority")}, now_);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 2}, now_).cancel, IsEmpty());
  EXPECT_EQ(Trouble(), "job 1 waits in the queue (Priority)");
}

TEST_F(PoolPolicyTest, AsksSlurmAtMostOncePerInterval) {
  Grow(2);
  int queries = 0;
  for (int second = 0; second < 100; ++second) {
    now_ += seconds(1);
    if (!policy_.Decide({.unfinished_runs = 2}, now_).query) continue;
    ++queries;
    policy_.Observed({Job("1", "PENDING")}, now_);
  }
  EXPECT_EQ(queries, 10);
}

TEST_F(PoolPolicyTest, AControllerThatDoesNotAnswerChangesNothing) {
  Grow(2);
  Connect("1");
  for (int i = 0; i < 60; ++i) {
    now_ += seconds(10);
    policy_.QueryFailed("connect failure", now_);
    EXPECT_THAT(policy_.Decide({.unfinished_runs = 2}, now_).cancel, IsEmpty());
  }
  EXPECT_EQ(policy_.allocations().size(), 1U);
  EXPECT_EQ(Trouble(), "Slurm does not answer: connect failure");
}

TEST_F(PoolPolicyTest, MissingOnceIsAHiccupMissingTwiceIsTheEnd) {
  Grow(2);
  Connect("1");
  policy_.Observed({}, now_);
  EXPECT_EQ(policy_.allocations().size(), 1U);
  policy_.Observed({}, now_);
  EXPECT_EQ(policy_.allocations().size(), 0U);
}

TEST_F(PoolPolicyTest, AdoptedJobsCountFromTheFirst) {
  policy_.Adopt(Job("90", "RUNNING", "node1"), now_);
  policy_.Adopt(Job("91", "PENDING"), now_);
  EXPECT_EQ(Grow(4).size(), 0U);
  EXPECT_EQ(Grow(100).size(), 1U);
}

TEST_F(PoolPolicyTest, StoppingCancelsEverythingOnceAndAsksForNothing) {
  Grow(100);
  policy_.Stop();
  const Decisions decisions = policy_.Decide({.unfinished_runs = 100}, now_);
  EXPECT_THAT(decisions.cancel, ElementsAre("1", "2"));
  EXPECT_EQ(decisions.submit, 0);
  EXPECT_THAT(policy_.Decide({.unfinished_runs = 100}, now_).cancel, IsEmpty());
}

// A cluster that does what it likes: whatever happens, the pool never holds more than it may, asks seldom,
// and once the cluster behaves it comes to full strength.
RC_GTEST_PROP(PoolPolicyProperty, KeepsItsLimitsAndRecovers, ()) {
  const PoolLimits limits = SmallPool();
  PoolPolicy policy(limits);
  TimePoint now = kStart;
  int last_job = 0;
  std::vector<JobStatus> cluster;
  std::vector<std::string> cancelled;
  TimePoint last_query = kStart - std::chrono::hours(1);

  const auto step = [&](bool behaves) {
    now += seconds(behaves ? 5 : *rc::gen::inRange(0, 60));
    for (JobStatus& job : cluster) {
      const int event = behaves ? 0 : *rc::gen::inRange(0, 6);
      if (job.state == "PENDING" && (event == 0 || event == 1)) {
        job = Job(job.id, "RUNNING", "node" + std::to_string(1 + std::stoi(job.id) % 3));
      } else if (job.state == "RUNNING" && event == 5) {
        job.state = "FAILED";
        job.phase = JobPhase::kEnded;
        policy.Workers(job.id, 0, 0, now);
      }
      if (job.state == "RUNNING" && (event == 0 || event == 2)) policy.Workers(job.id, 2, 2, now);
    }
    const Decisions decisions = policy.Decide({.unfinished_runs = 1000}, now);
    for (const std::string& job : decisions.cancel)
      std::erase_if(cluster, [&](const JobStatus& other) { return other.id == job; });
    for (int i = 0; i < decisions.submit; ++i) {
      if (!behaves && *rc::gen::inRange(0, 5) == 0) {
        policy.SubmissionFailed("no", now);
        continue;
      }
      const std::string id = std::to_string(++last_job);
      policy.Submitted(id, now);
      cluster.push_back(Job(id, "PENDING"));
    }
    if (decisions.query) {
      RC_ASSERT(now - last_query >= limits.query_interval);
      last_query = now;
      if (!behaves && *rc::gen::inRange(0, 4) == 0) {
        policy.QueryFailed("no", now);
      } else {
        policy.Observed(cluster, now);
        std::erase_if(cluster, [](const JobStatus& job) { return job.phase == JobPhase::kEnded; });
      }
    }
    int living = 0;
    int queued = 0;
    for (const Allocation& allocation : policy.allocations()) {
      if (allocation.cancelled) continue;
      ++living;
      if (allocation.phase == JobPhase::kQueued) ++queued;
    }
    RC_ASSERT(living <= limits.max_allocations);
    RC_ASSERT(queued <= limits.max_queued);
  };
  for (int i = 0; i < 60; ++i) step(false);
  for (int i = 0; i < 2000 / 5; ++i) step(true);
  int working = 0;
  for (const Allocation& allocation : policy.allocations()) working += allocation.workers > 0 ? 1 : 0;
  RC_ASSERT(working == limits.max_allocations);
}

}  // namespace
}  // namespace gauntlet::slurm
