// The pool alone on a real Slurm: how it grows and shrinks. Its workers are jobs that sleep; the test says
// which of them are connected and busy.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "slurm/slurm_pool.h"
#include "tests/slurm/cluster/slurm_cluster.h"

namespace gauntlet::testing_support {
namespace {

using std::chrono::seconds;
using SteadyClock = std::chrono::steady_clock;

constexpr int kCap = 5;
constexpr seconds kIdleTimeout{5};

class ElasticPool : public SlurmTest {
 protected:
  void SetUp() override {
    SlurmTest::SetUp();
    if (IsSkipped()) return;
    StartCluster({"--nodes", "2", "--cpus", "8"});
    std::ofstream(scratch_ / "access.json") << "{}";
    slurm::SlurmPoolOptions options;
    options.limits.max_allocations = kCap;
    options.limits.max_queued = 2;
    options.limits.idle_timeout = kIdleTimeout;
    options.limits.query_interval = seconds(1);
    options.request.time_limit = "10";
    options.job_template = std::string(slurm::kWorkerTemplate);
    options.job = {.name = "gauntlet-elastic-w",
                   .worker = "sh -c 'exec sleep 300' --",
                   .access_file = scratch_ / "access.json",
                   .log_directory = scratch_.path()};
    pool_ = std::make_unique<slurm::SlurmPool>(options, std::make_unique<slurm::CommandLineSlurm>());
  }
  // Every allocation that runs has a worker, which is busy while there is work.
  void Step(int unfinished_runs) {
    PoolView view;
    view.unfinished_runs = unfinished_runs;
    for (const AllocationView& allocation : pool_->Allocations()) {
      if (allocation.state == "RUNNING" && !allocation.cancelled)
        view.workers.push_back({allocation.job + ":0:node", unfinished_runs > 0});
    }
    pool_->Observe(view, SteadyClock::now());
    EXPECT_TRUE(pool_->Supervise(SteadyClock::now()).ok());
    running_ = static_cast<int>(view.workers.size());
    most_ = std::max(most_, running_);
  }
  bool Until(int unfinished_runs, const std::function<bool()>& condition) {
    return Eventually(
        [&] {
          Step(unfinished_runs);
          return condition();
        },
        seconds(60));
  }

  std::unique_ptr<slurm::SlurmPool> pool_;
  int running_ = 0;
  int most_ = 0;
};

TEST_F(ElasticPool, ABurstGrowsToTheCapAndNoFurtherAndIdleAllocationsAllGo) {
  EXPECT_TRUE(Until(1, [&] { return running_ == 1; }));
  EXPECT_TRUE(Until(1000, [&] { return running_ == kCap; }));
  // It stays there.
  const auto later = SteadyClock::now() + seconds(5);
  EXPECT_TRUE(Until(1000, [&] { return SteadyClock::now() >= later; }));
  EXPECT_EQ(most_, kCap);
  EXPECT_LE(QueueLines().size(), static_cast<std::size_t>(kCap));

  const auto idle_since = SteadyClock::now();
  EXPECT_TRUE(Until(0, [&] { return running_ == 0; }));
  const auto shrunk = SteadyClock::now() - idle_since;
  EXPECT_GE(shrunk, kIdleTimeout);
  EXPECT_LE(shrunk, kIdleTimeout + seconds(2));
  EXPECT_TRUE(QueueEmpties());
  EXPECT_TRUE(Until(1000, [&] { return running_ == kCap; })) << "and it comes back";
}

TEST_F(ElasticPool, APartitionThatStartsNothingIsToldWithSlurmsReason) {
  Slurm({"scontrol", "update", "PartitionName=main", "State=DOWN"});
  EXPECT_TRUE(Until(100, [&] {
    return pool_->Trouble(SteadyClock::now()).find("waits in the queue (PartitionDown)") != std::string::npos;
  })) << pool_->Trouble(SteadyClock::now());
  EXPECT_EQ(QueueLines().size(), 2U) << "the backlog";
  Slurm({"scontrol", "update", "PartitionName=main", "State=UP"});
  EXPECT_TRUE(Until(100, [&] { return running_ == kCap; }));
}

}  // namespace
}  // namespace gauntlet::testing_support
