// What happens to clusters other than Slurm's during an evolution: the result is that of an undisturbed local
// campaign, nothing is lost, and the pool comes back to strength.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/slurm/cluster/any_cluster.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr std::size_t kJobs = 4;
constexpr seconds kLongest{500};

std::map<std::string, json> Connected(const json& status) {
  std::map<std::string, json> jobs;
  for (const json& allocation : status.value("allocations", json::array())) {
    if (allocation.value("workers", 0) > 0) jobs[allocation["job"]] = allocation;
  }
  return jobs;
}

bool AtStrength(const json& status) {
  return Connected(status).size() == kJobs;
}

std::function<bool(const json&)> Troubled(const std::string& words) {
  return [words](const json& status) { return status.dump().find(words) != std::string::npos; };
}

class AnyClusterDrill : public AnyClusterTest {
 protected:
  bool Is(const std::string& kind) const { return kind == GetParam(); }
  std::vector<std::string> Arguments(const std::vector<std::string>& settings,
                                     const std::string& changes = "") {
    std::vector<std::string> all = {site_->Setting(changes), "max_allocations=4", "max_queued=4",
                                    "query_interval=1",      "start_timeout=10",  SlowWorkers(500)};
    all.insert(all.end(), settings.begin(), settings.end());
    if (hash_.empty()) hash_ = LocalHash(campaign_);
    return SubmitArguments(campaign_, "here", all);
  }
  // Full strength: one worker in each of four jobs.
  void Begin(const std::vector<std::string>& settings = {}, const std::string& changes = "") {
    master_ = StartGauntlet(Arguments(settings, changes));
    ASSERT_TRUE(StatusBecomes(AtStrength)) << master_->Err();
  }
  std::string SomeJob() const { return Connected(Status()).begin()->first; }
  void ExpectBackAtStrengthWithout(const std::string& gone) {
    EXPECT_TRUE(StatusBecomes(
        [&](const json& status) { return AtStrength(status) && Connected(status).count(gone) == 0; },
        seconds(150)));
  }
  void ExpectTheLocalResult() {
    const ProcessResult result = master_->Wait(kLongest);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(StateHash(dir()), hash_);
    EXPECT_TRUE(QueueEmpties());
  }
  // In force while the object lives, with the stand-in alone.
  void Misbehave(const std::string& how, bool begins) const {
    if (begins) std::ofstream(site_->file("state/" + how)) << "";
    if (!begins) std::filesystem::remove(site_->file("state/" + how));
  }

  SmallCampaign campaign_ = [] {
    SmallCampaign campaign;
    // A login takes a second on a busy machine.
    campaign.generations = std::string(GetParam()) == "ssh" ? 60 : 25;
    return campaign;
  }();
  std::string hash_;
  std::unique_ptr<Process> master_;
};

TEST_P(AnyClusterDrill, AJobIsCancelledAndAnotherVanishes) {
  Begin();
  const std::string cancelled = SomeJob();
  site_->Cancel(cancelled);
  ExpectBackAtStrengthWithout(cancelled);
  const std::string killed = SomeJob();
  AnyCluster::Kill(killed);
  ExpectBackAtStrengthWithout(killed);
  ExpectTheLocalResult();
}

TEST_P(AnyClusterDrill, ANodeDies) {
  Begin();
  std::string node;
  ASSERT_TRUE(StatusBecomes([&](const json& status) {
    const auto connected = Connected(status);
    if (AtStrength(status)) node = connected.begin()->second["nodes"];
    return !node.empty() &&
           std::ranges::none_of(connected, [](const auto& job) { return job.second["nodes"] == ""; });
  }));
  std::set<std::string> there;
  for (const auto& [job, allocation] : Connected(Status())) {
    if (allocation["nodes"] == node) there.insert(job);
  }
  site_->Do({"node-kill", node});
  EXPECT_TRUE(
      StatusBecomes([&](const json& status) { return Connected(status).size() == kJobs - there.size(); }));
  site_->Do({"node-start", node});
  // PBS starts tasks of arrays again, under their ids; elsewhere others come.
  EXPECT_TRUE(StatusBecomes(AtStrength, seconds(150)));
  ExpectTheLocalResult();
}

TEST_P(AnyClusterDrill, TimeLimitsAreHit) {
  // A login takes a second on a slow machine, and each job has some.
  campaign_.generations = Is("ssh") ? 140 : 60;
  Begin({Is("ssh") ? "time_limit=2:00" : "time_limit=0:40"});
  const std::map<std::string, json> before = Connected(Status());
  for (const auto& [job, allocation] : before) ExpectBackAtStrengthWithout(job);
  ExpectTheLocalResult();
  std::string ends;
  for (const auto& [job, allocation] : before) ends += ReadFile(dir() + "/log/" + job + ".exit");
  EXPECT_EQ(ends, "0\n0\n0\n0\n") << "told in time, they left";
}

TEST_P(AnyClusterDrill, StatesNobodyKnowsAreBelievedToLive) {
  const std::string shipped =
      ReadFile(std::string(GAUNTLET_SOURCE_DIR) + "/slurm/clusters/" + GetParam() + ".toml");
  std::string changes;
  if (Is("ssh")) {
    changes = "queued = [\"RUNNING\"]";
  } else {
    const std::size_t begin = shipped.find("look = '''");
    changes = shipped.substr(begin, shipped.find("'''", begin + 10) - begin);
    changes.erase(changes.find_last_not_of(" \n") + 1);
    changes += " | sed 's/|[rR]|/|hibernates|/'\n'''";
  }
  Begin({}, changes);
  ExpectTheLocalResult();
}

TEST_P(AnyClusterDrill, AfterACrashResumeTakesUpTheWorkersThatAreLeftAndASecondMasterIsRefused) {
  Begin();
  EXPECT_EQ(Gauntlet({"resume", dir(), "--no-progress"}).exit_code, 2);
  master_->Signal(SIGKILL);
  master_->Wait();
  const std::size_t jobs = site_->Jobs().size();
  EXPECT_EQ(jobs, kJobs);
  master_ = StartGauntlet({"resume", dir(), "--no-progress"});
  ASSERT_TRUE(StatusBecomes(AtStrength)) << master_->Err();
  EXPECT_EQ(site_->Jobs().size(), kJobs) << "no other was needed";
  ExpectTheLocalResult();
}

TEST_P(AnyClusterDrill, StopLeavesNothing) {
  Begin();
  master_->Signal(SIGKILL);
  master_->Wait();
  const ProcessResult stop = Gauntlet({"stop", dir()});
  EXPECT_EQ(stop.exit_code, 0) << stop.err;
  EXPECT_THAT(stop.err, HasSubstr("cancelled jobs"));
  EXPECT_TRUE(QueueEmpties());
}

INSTANTIATE_TEST_SUITE_P(, AnyClusterDrill, testing::Values("sge", "pbs", "ssh"),
                         [](const auto& parameter) { return std::string(parameter.param); });

class SchedulerDrill : public AnyClusterDrill {};

TEST_P(SchedulerDrill, IsAwayForAMinute) {
  campaign_.generations = 90;
  Begin();
  const std::string job = SomeJob();
  site_->Do({"ctl-stop"});
  const auto back = std::chrono::steady_clock::now() + seconds(60);
  EXPECT_TRUE(StatusBecomes(Troubled(" does not answer: ")));
  EXPECT_TRUE(AtStrength(Status())) << "what runs goes on";
  EXPECT_TRUE(Eventually([&] { return std::chrono::steady_clock::now() >= back; }, seconds(70)));
  site_->Do({"ctl-start"});
  EXPECT_TRUE(Eventually([&] { return site_->Jobs().size() == kJobs; }, seconds(60)));
  site_->Cancel(job);
  ExpectBackAtStrengthWithout(job);
  ExpectTheLocalResult();
}

// Four slots, of which somebody else has two: what waits is held by a person.
TEST_P(SchedulerDrill, WaitingJobsAreHeld) {
  const std::string other =
      RunProcess({"/bin/bash", "-c",
                  Is("sge") ? "echo sleep 600 | qsub -terse -N other -o /dev/null -j y -pe smp 2"
                            : "echo sleep 600 | qsub -N other -o /dev/null -j oe -l ncpus=2"})
          .out;
  master_ = StartGauntlet(Arguments({}));
  std::string waiting;
  ASSERT_TRUE(StatusBecomes([&](const json& status) {
    for (const json& allocation : status.value("allocations", json::array())) {
      if (allocation["state"] == "qw" || allocation["state"] == "Q") waiting = allocation["job"];
    }
    return Connected(status).size() == 2 && !waiting.empty();
  }));
  // PBS holds arrays as a whole.
  const std::string held = Is("pbs") ? waiting.substr(0, waiting.find('[')) + "[]" : waiting;
  const ProcessResult hold = RunProcess({"/usr/bin/env", "qhold", held});
  EXPECT_EQ(hold.exit_code, 0) << hold.err;
  EXPECT_TRUE(StatusBecomes(Troubled("job " + waiting + " would never start: "))) << master_->Err();
  RunProcess({"/usr/bin/env", "qdel", other.substr(0, other.find('\n'))});
  ExpectTheLocalResult();
}

TEST_P(SchedulerDrill, TheQueueIsFull) {
  if (Is("sge")) {
    // An array counts as one job.
    const std::string full =
        "echo sleep 60 | qsub -N other -o /dev/null -j y; "
        "qconf -sconf | sed 's/^max_u_jobs .*/max_u_jobs 1/' >\"$1\" && qconf -Mconf \"$1\"";
    const ProcessResult set = RunProcess({"/bin/bash", "-c", full, "full", scratch_ / "global"});
    ASSERT_EQ(set.exit_code, 0) << set.err << set.out;
  } else {
    site_->Do({"stop"});
    site_->Do({"start", "--nodes", "2", "--slots", "2", "--max-queued", "2"});
  }
  master_ = StartGauntlet(Arguments({"max_allocations=3", "max_queued=3"}));
  EXPECT_TRUE(StatusBecomes(Troubled(Is("sge") ? "job rejected" : "would exceed"))) << master_->Err();
  if (Is("sge")) {
    const std::string wide = "sed -i 's/^max_u_jobs .*/max_u_jobs 0/' \"$1\" && qconf -Mconf \"$1\"";
    EXPECT_EQ(RunProcess({"/bin/bash", "-c", wide, "wide", scratch_ / "global"}).exit_code, 0);
  } else {
    site_->Do({"stop"});
    site_->Do({"start", "--nodes", "2", "--slots", "2"});
  }
  ExpectTheLocalResult();
}

INSTANTIATE_TEST_SUITE_P(, SchedulerDrill, testing::Values("sge", "pbs"),
                         [](const auto& parameter) { return std::string(parameter.param); });

class StandInDrill : public AnyClusterDrill {};

TEST_P(StandInDrill, MisbehavesInEveryWay) {
  for (const auto& [how, words] : {std::pair{"qsub_rubbish", " instead of a job id"},
                                   {"qsub_hangs", "no answer within 15000 ms"},
                                   {"qsub_no_job", "before its worker said hello"},
                                   {"qstat_fails", "PBS does not answer: "}}) {
    std::filesystem::remove_all(dir());
    Misbehave(how, true);
    master_ = StartGauntlet(Arguments({}));
    EXPECT_TRUE(StatusBecomes(Troubled(words))) << how << ": " << master_->Err();
    Misbehave(how, false);
    ExpectTheLocalResult();
  }
}

INSTANTIATE_TEST_SUITE_P(, StandInDrill, testing::Values("pbs"),
                         [](const auto& parameter) { return std::string(parameter.param); });

class SshDrill : public AnyClusterDrill {};

TEST_P(SshDrill, AHostThatRefusesIsOutAndTheOtherDoesItAll) {
  std::filesystem::remove(site_->file("beta/authorized"));
  std::vector<std::string> settings;
  master_ = StartGauntlet(Arguments(settings));
  EXPECT_TRUE(StatusBecomes([](const json& status) {
    return Connected(status).size() == 2 &&
           status.dump().find("beta is out until `gauntlet resume`: ") != std::string::npos;
  })) << master_->Err();
  EXPECT_TRUE(Eventually([&] { return !master_->Running(); }, kLongest));
  const std::string log = ReadFile(site_->file("log/beta.log"));  // before this test looks itself
  std::size_t tries = 0;
  for (std::size_t at = 0; (at = log.find("Failed publickey", at)) != std::string::npos; ++at) ++tries;
  EXPECT_EQ(tries, 1U) << log;
  ExpectTheLocalResult();
}

TEST_P(SshDrill, AHostsKeyThatChangedEndsItWhenThereIsNoOther) {
  site_->Do({"key-change", "beta"});
  site_->Do({"key-change", "alpha"});
  const ProcessResult result = Gauntlet(Arguments({}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("no host can be used; alpha is out until"),
                                HasSubstr("Host key verification failed."), HasSubstr("Go on with")));
}

INSTANTIATE_TEST_SUITE_P(, SshDrill, testing::Values("ssh"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace gauntlet::testing_support
