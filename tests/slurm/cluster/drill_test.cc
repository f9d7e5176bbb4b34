// What happens to clusters during an evolution, on a real Slurm: the result is that of an undisturbed local
// campaign, nothing is lost, and the pool comes back to strength.
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "tests/slurm/cluster/slurm_cluster.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr std::size_t kJobs = 4;
constexpr seconds kLongest{500};

std::set<std::string> ConnectedJobs(const json& status) {
  std::set<std::string> jobs;
  for (const json& allocation : status.value("allocations", json::array())) {
    if (allocation.value("workers", 0) > 0) jobs.insert(allocation["job"]);
  }
  return jobs;
}

bool AtStrength(const json& status) {
  return ConnectedJobs(status).size() == kJobs;
}

std::string ReadFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(in)), {});
}

class SlurmDrill : public SlurmTest {
 protected:
  struct Plan {
    int generations = 30;    // of 8 runs each
    int milliseconds = 700;  // of a run: with 4 workers a generation takes twice that
    std::string master = "here";
    std::vector<std::string> settings = {};
    std::vector<std::string> cluster = {"--nodes", "4", "--cpus", "2"};
  };
  // Full strength: one worker in each of four jobs.
  void Begin(Plan plan) {
    StartCluster(plan.cluster);
    SmallCampaign campaign;
    campaign.generations = plan.generations;
    hash_ = LocalHash(campaign);
    for (const std::string& setting :
         {std::string("max_allocations=4"), std::string("max_queued=4"), SlowWorkers(plan.milliseconds)})
      plan.settings.push_back(setting);
    const std::vector<std::string> arguments = SubmitArguments(campaign, plan.master, plan.settings);
    if (plan.master == "here") {
      master_ = StartGauntlet(arguments);
    } else {
      const ProcessResult submitted = Gauntlet(arguments);
      ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
    }
    ASSERT_TRUE(StatusBecomes(AtStrength)) << (master_ ? master_->Err() : "");
  }
  std::string SomeJob() const { return *ConnectedJobs(Status()).begin(); }
  std::string NodeOf(const std::string& job) const {
    const std::string node = Slurm({"squeue", "--noheader", "--jobs=" + job, "--format=%N"});
    return node.substr(0, node.find('\n'));
  }
  std::string MasterJob() const { return Status().at("master").at("batch_job"); }
  void ExpectBackAtStrengthWithout(const std::string& gone) {
    EXPECT_TRUE(StatusBecomes(
        [&](const json& status) { return AtStrength(status) && !ConnectedJobs(status).contains(gone); }));
  }
  void ExpectTheLocalResult() {
    if (master_) {
      const ProcessResult result = master_->Wait(kLongest);
      EXPECT_EQ(result.exit_code, 0) << result.err;
    } else {
      EXPECT_TRUE(StatusBecomes([](const json& status) { return status.value("state", "") == "finished"; },
                                kLongest));
    }
    const json shown = Show(dir());
    EXPECT_EQ(shown.value("state_hash", ""), hash_);
    EXPECT_EQ(shown.value("finished", false), true);
    EXPECT_TRUE(QueueEmpties());
  }

  std::string hash_;
  std::unique_ptr<Process> master_;
};

TEST_F(SlurmDrill, AWorkersJobIsCancelledAndSqueueIsAskedSeldom) {
  // Counts the calls of squeue that the master makes.
  const std::string tools = scratch_ / "tools";
  std::filesystem::create_directory(tools);
  const std::string squeue = Slurm({"sh", "-c", "command -v squeue"});
  std::ofstream(tools + "/squeue") << "#!/bin/sh\necho >>" << tools << "/calls\nexec "
                                   << squeue.substr(0, squeue.find('\n')) << " \"$@\"\n";
  std::filesystem::permissions(tools + "/squeue", std::filesystem::perms(0755));
  const std::string path = std::getenv("PATH");
  setenv("PATH", (tools + ":" + path).c_str(), 1);
  const auto begun = std::chrono::steady_clock::now();
  Begin({});
  setenv("PATH", path.c_str(), 1);
  const std::string job = SomeJob();
  Slurm({"scancel", job});
  ExpectBackAtStrengthWithout(job);
  ExpectTheLocalResult();
  const auto elapsed = std::chrono::steady_clock::now() - begun;
  const std::size_t calls = ReadFile(tools + "/calls").size();
  // One more when it begins, one when it ends.
  EXPECT_LE(calls, static_cast<std::size_t>(elapsed / seconds(10)) + 2);
  EXPECT_GE(calls, 2U);
}

TEST_F(SlurmDrill, ANodeDies) {
  Begin({.generations = 60, .settings = {"extra=--exclusive"}});
  const std::string job = SomeJob();
  const std::string node = NodeOf(job);
  cluster_->Do({"node-kill", node});
  EXPECT_TRUE(StatusBecomes([&](const json& status) { return !ConnectedJobs(status).contains(job); }));
  cluster_->Do({"node-start", node});
  ExpectBackAtStrengthWithout(job);
  ExpectTheLocalResult();
}

TEST_F(SlurmDrill, ANodesDaemonDiesWhileItsWorkerLivesOn) {
  Begin({.generations = 60, .settings = {"extra=--exclusive"}});
  const std::string job = SomeJob();
  const std::string node = NodeOf(job);
  cluster_->Do({"node-kill", node, "--daemon-only"});
  // Slurm takes the job for lost, and the pool replaces it while the old worker still works.
  EXPECT_TRUE(StatusBecomes([&](const json& status) {
    for (const json& allocation : status.at("allocations")) {
      if (allocation["job"] == job) return false;
    }
    return true;
  }));
  cluster_->Do({"node-start", node});
  ExpectBackAtStrengthWithout(job);
  ExpectTheLocalResult();
}

class SlurmPreemptionDrill : public SlurmDrill, public testing::WithParamInterface<const char*> {};

TEST_P(SlurmPreemptionDrill, WorkersArePreempted) {
  Begin({.generations = 60, .settings = {std::string("partition=") + GetParam()}});
  const std::set<std::string> before = ConnectedJobs(Status());
  Slurm({"sbatch", "--partition=main", "--nodes=4", "--exclusive", "--time=5", "--output=/dev/null",
         "--job-name=important", "--wrap=sleep 20"});
  EXPECT_TRUE(StatusBecomes([](const json& status) { return ConnectedJobs(status).empty(); }));
  EXPECT_TRUE(StatusBecomes([](const json& status) { return status.at("why_nothing_runs").is_string(); }));
  EXPECT_TRUE(StatusBecomes(AtStrength, seconds(180)));
  for (const std::string& job : ConnectedJobs(Status())) EXPECT_FALSE(before.contains(job));
  ExpectTheLocalResult();
}

INSTANTIATE_TEST_SUITE_P(ByRequeueAndByCancel, SlurmPreemptionDrill, testing::Values("spot", "scav"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_F(SlurmDrill, TimeLimitsAreHit) {
  Begin({.generations = 90, .settings = {"partition=short", "time_limit=1"}});
  const std::set<std::string> before = ConnectedJobs(Status());
  EXPECT_TRUE(StatusBecomes(
      [&](const json& status) {
        for (const std::string& job : before) {
          if (ConnectedJobs(status).contains(job)) return false;
        }
        return AtStrength(status);
      },
      seconds(180)));
  ExpectTheLocalResult();
}

TEST_F(SlurmDrill, TheControllerIsAwayForAMinute) {
  Begin({.generations = 90});
  const std::string job = SomeJob();
  cluster_->Do({"ctl-stop"});
  const auto back = std::chrono::steady_clock::now() + seconds(60);
  EXPECT_TRUE(StatusBecomes([](const json& status) {
    const json& trouble = status.at("pool_trouble");
    return trouble.is_string() && trouble.get<std::string>().find("Slurm does not answer") == 0;
  }));
  EXPECT_TRUE(AtStrength(Status())) << "what runs goes on";
  EXPECT_TRUE(Eventually([&] { return std::chrono::steady_clock::now() >= back; }, seconds(70)));
  cluster_->Do({"ctl-start"});
  Slurm({"scancel", job});
  ExpectBackAtStrengthWithout(job);
  ExpectTheLocalResult();
}

TEST_F(SlurmDrill, TheMastersJobIsRequeued) {
  Begin({.generations = 60, .master = "job"});
  const std::set<std::string> before = ConnectedJobs(Status());
  const std::string job = MasterJob();
  Slurm({"scontrol", "requeue", job});
  EXPECT_TRUE(StatusBecomes(
      [&](const json& status) {
        const json master = status.value("master", json());
        return master.is_object() && master.value("epoch", 0) >= 3 && AtStrength(status);
      },
      seconds(180)));
  EXPECT_EQ(MasterJob(), job);
  EXPECT_EQ(ConnectedJobs(Status()), before) << "the same workers";
  ExpectTheLocalResult();
}

TEST_F(SlurmDrill, ATwinOfTheMasterIsFenced) {
  // The master has a node of its own.
  Begin({.generations = 90,
         .master = "job",
         .settings = {"master_partition=spot"},
         .cluster = {"--nodes", "4", "--cpus", "2"}});
  const std::string job = MasterJob();
  const pid_t twin = Status().at("master").at("pid");
  cluster_->Do({"node-kill", NodeOf(job), "--daemon-only"});
  EXPECT_TRUE(StatusBecomes(
      [&](const json& status) {
        const json master = status.value("master", json());
        return master.is_object() && master.value("pid", 0) != twin && status.value("runs_done", 0) > 0;
      },
      seconds(180)));
  EXPECT_TRUE(Eventually([&] { return !Alive(twin); }, seconds(10)));
  ExpectTheLocalResult();
}

}  // namespace
}  // namespace gauntlet::testing_support
