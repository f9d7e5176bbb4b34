// Wrong settings, unwilling clusters, crashes and strangers, on a real Slurm.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>

#include "tests/slurm/cluster/slurm_cluster.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using std::chrono::seconds;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

class SlurmTrouble : public SlurmTest {
 protected:
  void SetUp() override {
    SlurmTest::SetUp();
    if (IsSkipped()) return;
    StartCluster({"--nodes", "2", "--cpus", "2"});
  }
  static SmallCampaign Long() {
    SmallCampaign campaign;
    campaign.generations = 40;
    return campaign;
  }
};

TEST_F(SlurmTrouble, ImpossibleRequestsAreFoundBeforeAnythingIsSubmitted) {
  struct Case {
    std::string setting;
    std::string words;
    std::string step;
  };
  for (const Case& wrong :
       {Case{"memory=100T", "node configuration is not available", "lower memory"},
        Case{"workers_per_allocation=64", "node configuration is not available", "workers_per_allocation"},
        Case{"partition=nosuch", "nvalid partition", "sinfo -s"}}) {
    const ProcessResult result = Gauntlet(SubmitArguments({}, "job", {wrong.setting}));
    EXPECT_EQ(result.exit_code, 2) << wrong.setting;
    EXPECT_THAT(result.err,
                AllOf(HasSubstr("could not start"), HasSubstr(wrong.words), HasSubstr(wrong.step)));
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(dir()));
  }
  EXPECT_THAT(QueueLines({"--states=all"}), IsEmpty());
}

TEST_F(SlurmTrouble, WithoutSlurmsCommandsOrItsControllerItSaysWhatToDo) {
  std::vector<std::string> command = {GauntletPath()};
  for (const std::string& argument : SubmitArguments({}, "job")) command.push_back(argument);
  const ProcessResult without = RunProcess(command, {"PATH=/nowhere"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.err, AllOf(HasSubstr("there is no sbatch in PATH"), HasSubstr("login node")));
  cluster_->Do({"ctl-stop"});
  const ProcessResult silent = RunProcess(command);
  EXPECT_EQ(silent.exit_code, 2);
  EXPECT_THAT(silent.err, AllOf(HasSubstr("ontact slurm controller"), HasSubstr("scontrol ping")));
  EXPECT_FALSE(std::filesystem::exists(dir()));
}

TEST_F(SlurmTrouble, AFullQueueIsToldInSlurmsWords) {
  cluster_.reset();
  StartCluster({"--nodes", "1", "--cpus", "2", "--set", "MaxJobCount=3"});
  std::unique_ptr<Process> master =
      StartGauntlet(SubmitArguments(Long(), "here", {"max_allocations=1", SlowWorkers(500)}));
  ASSERT_TRUE(StatusBecomes([](const json& status) { return status.value("workers", 0) == 1; }))
      << master->Err();
  // Until there is no room; jobs that have ended count too, for some minutes.
  Slurm({"sh", "-c", "while timeout 3 sbatch --hold --output=/dev/null --wrap=true; do :; done"});
  const std::string job = Status().at("allocations").at(0).at("job");
  Slurm({"scancel", job});
  EXPECT_TRUE(StatusBecomes([](const json& status) {
    const json& why = status.value("why_nothing_runs", json());
    return why.is_string() &&
           why.get<std::string>().find("temporarily unable to accept job") != std::string::npos &&
           why.get<std::string>().find("queue is full") != std::string::npos;
  }));
  EXPECT_EQ(Gauntlet({"stop", dir()}).exit_code, 0);
  EXPECT_EQ(master->Wait().exit_code, 3);

  std::vector<std::string> another = SubmitArguments({}, "job");
  *std::find(another.begin(), another.end(), dir()) += "2";
  const ProcessResult refused = Gauntlet(another);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("Resource temporarily unavailable"), HasSubstr("queue is full")));
}

TEST_F(SlurmTrouble, ADirectoryThatNodesCannotSeeIsTold) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may mount";
  // The master sees a file system of its own.
  const std::string mount = scratch_ / "private";
  std::filesystem::create_directory(mount);
  std::string command;
  std::vector<std::string> arguments = SubmitArguments(Long(), "here");
  *std::find(arguments.begin(), arguments.end(), dir()) = mount + "/c";
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  const std::string watch =
      " >/dev/null 2>&1 & master=$!; for i in $(seq 600); do " + GauntletPath() + " status " + mount +
      "/c 2>/dev/null | grep 'does not see' && break; sleep 0.1; done; kill $master; wait";
  const ProcessResult result =
      RunProcess({"/usr/bin/env", "unshare", "--mount", "sh", "-c",
                  "mount -t tmpfs none " + mount + " && { " + GauntletPath() + command + watch + "; }"});
  EXPECT_THAT(result.out, AllOf(HasSubstr("before its worker said hello"),
                                HasSubstr("shared with the compute nodes"), HasSubstr("--dir")))
      << result.err;
  EXPECT_TRUE(QueueEmpties());
}

TEST_F(SlurmTrouble, StopCancelsTheCampaignsJobsAndNoOthers) {
  Slurm({"scontrol", "update", "PartitionName=main", "State=DOWN"});
  ASSERT_EQ(Gauntlet(SubmitArguments(Long(), "job")).exit_code, 0);
  std::vector<std::string> jobs = QueueLines();
  ASSERT_THAT(jobs, SizeIs(1));
  EXPECT_TRUE(StatusBecomes([](const json& status) {
    const json& why = status.at("why_nothing_runs");
    return why.is_string() && why.get<std::string>().find("PENDING (PartitionDown)") != std::string::npos;
  }));
  EXPECT_THAT(Gauntlet({"status", dir()}).out, HasSubstr("PartitionDown"));
  EXPECT_THAT(Gauntlet({"resume", dir()}).err, HasSubstr("is the campaign's master already"));
  const std::string name = jobs[0].substr(jobs[0].rfind(' ') + 1);
  // Mine with another name; somebody else's with the campaign's.
  Slurm({"sbatch", "--job-name=gauntlet-flocking", "--output=/dev/null", "--wrap=true"});
  const bool other_user = geteuid() == 0;
  if (other_user)
    Slurm({"setpriv", "--reuid=nobody", "--regid=nogroup", "--clear-groups", "sbatch", "--chdir=/",
           "--job-name=" + name, "--output=/dev/null", "--wrap=true"});
  const ProcessResult stop = Gauntlet({"stop", dir()});
  EXPECT_EQ(stop.exit_code, 0) << stop.err;
  EXPECT_THAT(stop.err, HasSubstr("cancelled job " + jobs[0].substr(0, jobs[0].find(' '))));
  EXPECT_THAT(QueueLines({"--me"}), SizeIs(1));
  EXPECT_THAT(QueueLines(), SizeIs(other_user ? 2 : 1));
}

TEST_F(SlurmTrouble, AfterACrashResumeTakesUpTheWorkersThatAreLeft) {
  const SmallCampaign campaign = Long();
  const std::string hash = LocalHash(campaign);
  std::unique_ptr<Process> master =
      StartGauntlet(SubmitArguments(campaign, "here", {"max_allocations=2", SlowWorkers(300)}));
  ASSERT_TRUE(StatusBecomes([](const json& status) { return status.value("workers", 0) == 2; }))
      << master->Err();
  master->Signal(SIGKILL);
  master->Wait();
  const std::vector<std::string> left = QueueLines();
  EXPECT_THAT(left, SizeIs(2));
  const ProcessResult resumed = Gauntlet({"resume", dir(), "--no-progress"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(StateHash(dir()), hash);
  EXPECT_TRUE(QueueEmpties());
  EXPECT_THAT(QueueLines({"--states=all"}), SizeIs(2)) << "no other was needed";
}

TEST_F(SlurmTrouble, StopAfterACrashLeavesNothing) {
  std::unique_ptr<Process> master = StartGauntlet(SubmitArguments(Long(), "here", {SlowWorkers(300)}));
  ASSERT_TRUE(StatusBecomes([](const json& status) { return status.value("workers", 0) > 0; }));
  master->Signal(SIGKILL);
  master->Wait();
  const ProcessResult stop = Gauntlet({"stop", dir()});
  EXPECT_EQ(stop.exit_code, 0) << stop.err;
  EXPECT_THAT(stop.err, HasSubstr("cancelled job"));
  EXPECT_TRUE(QueueEmpties());
}

TEST_F(SlurmTrouble, TheBatchScriptsForThoseWhoWantNoMagicServeACampaign) {
  SmallCampaign campaign;
  const std::string hash = LocalHash(campaign);
  const std::string scripts = GAUNTLET_SOURCE_DIR "/slurm/by-hand";
  const std::string path = std::string("PATH=") + GAUNTLET_BINARY_DIR + ":" + std::getenv("PATH");
  Slurm({path, "GAUNTLET_BIND=tcp://127.0.0.1:*", "sbatch", "--output=/dev/null", scripts + "/master.sbatch",
         dir(), "flocking", "--seed", "7", "--population", "8", "--generations", "4"});
  Slurm({path, "sbatch", "--output=/dev/null", "--cpus-per-task=1", "--array=1-2", scripts + "/worker.sbatch",
         dir()});
  EXPECT_TRUE(StatusBecomes([](const json& status) { return status.value("state", "") == "finished"; }));
  EXPECT_EQ(StateHash(dir()), hash);
  EXPECT_TRUE(QueueEmpties()) << "the master lets its workers go";
}

TEST_F(SlurmTrouble, TheBundlesProgramsSubmitAndServe) {
  const SmallCampaign campaign;
  const std::string bundle = scratch_ / "bundle";
  const ProcessResult made =
      RunProcess({GAUNTLET_SOURCE_DIR "/release/make_bundle", GAUNTLET_BINARY_DIR, bundle});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  std::vector<std::string> command = SubmitArguments(campaign, "job");
  command.insert(command.begin(), bundle + "/bin/gauntlet");
  const ProcessResult submitted = RunProcess(command);
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  EXPECT_TRUE(StatusBecomes([](const json& status) { return status.value("state", "") == "finished"; }));
  EXPECT_EQ(StateHash(dir()), LocalHash(campaign));
  EXPECT_TRUE(QueueEmpties());
}

TEST_F(SlurmTrouble, ASweepEndsLikeItsSearchesAlone) {
  SmallCampaign campaign;
  std::vector<std::string> arguments = SubmitArguments(campaign, "here");
  const auto seed = std::find(arguments.begin(), arguments.end(), "--seed");
  arguments.erase(seed, seed + 2);
  for (const char* argument : {"--sweep", "search.mutation_probability=0.05,0.3", "--seeds", "7..8"})
    arguments.emplace_back(argument);
  const ProcessResult result = Gauntlet(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("search.mutation_probability=0.3, seed 8"));
  const json shown = Show(dir());
  ASSERT_EQ(shown.at("searches").size(), 4U);
  EXPECT_EQ(shown["searches"][0]["state_hash"], LocalHash(campaign));
  EXPECT_TRUE(QueueEmpties());
}

TEST_F(SlurmTrouble, ASweepGoesOnOnALocalPoolAfterACrash) {
  SmallCampaign campaign;
  std::vector<std::string> arguments = SubmitArguments(campaign, "here", {SlowWorkers(200)});
  const auto seed = std::find(arguments.begin(), arguments.end(), "--seed");
  arguments.erase(seed, seed + 2);
  arguments.insert(arguments.end(), {"--seeds", "7,8"});
  std::unique_ptr<Process> master = StartGauntlet(arguments);
  ASSERT_TRUE(StatusBecomes([](const json& status) { return status.value("runs_done", 0) >= 10; }))
      << master->Err();
  master->Signal(SIGKILL);
  master->Wait();
  EXPECT_EQ(Gauntlet({"stop", dir()}).exit_code, 0);
  const json before = Show(dir());
  EXPECT_EQ(before.at("finished"), false);
  const ProcessResult resumed = Gauntlet({"resume", dir(), "--workers", "2", "--quiet"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(Show(dir()).at("searches").at(0).at("state_hash"), LocalHash(campaign));
}

}  // namespace
}  // namespace gauntlet::testing_support
