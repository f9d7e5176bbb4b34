#include "slurm/cluster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "slurm/job_script.h"
#include "slurm/slurm_client.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace gauntlet::slurm {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

std::string ErrorOf(const std::string& text) {
  const Result<Cluster> cluster = ReadCluster(text, "lab.toml");
  return cluster.ok() ? "" : cluster.error().message;
}

TEST(FindCluster, KnowsWhatIsShipped) {
  for (const char* name : {"slurm", "sge", "pbs"}) {
    const Result<Cluster> cluster = FindCluster(name);
    ASSERT_TRUE(cluster.ok()) << cluster.error().message;
    EXPECT_FALSE(cluster->states.empty());
    EXPECT_EQ(cluster->give_up_after, std::string(name) == "slurm" ? 0 : 20);
  }
  EXPECT_EQ(
      FindCluster("pbd").error().message,
      "unknown shipped cluster 'pbd'; did you mean 'pbs'? (a cluster file is given by its path: ./lab.toml)");
  EXPECT_EQ(FindCluster("ssh").error().message,
            "cluster = ssh: hosts is missing: hosts = [\"node7:16\", ...]");
  EXPECT_THAT(FindCluster("./no-such.toml").error().message, HasSubstr("cluster = ./no-such.toml: "));
}

TEST(ReadCluster, BeginsWithAnotherAndChangesSomeRows) {
  const Result<Cluster> cluster = ReadCluster(
      "like = \"pbs\"\nended = [\"C\"]\nname = \"Torque\"\ndirectives.array = '#PBS -t 1-@VALUE@'\n", "t");
  ASSERT_TRUE(cluster.ok()) << cluster.error().message;
  EXPECT_EQ(cluster->submit, "qsub \"$@\"");
  EXPECT_EQ(cluster->directives.at("array"), "#PBS -t 1-@VALUE@");
  EXPECT_EQ(PhaseOf("C", *cluster), JobPhase::kEnded);
  EXPECT_EQ(PhaseOf("Q", *cluster), JobPhase::kQueued);
  EXPECT_EQ(PhaseOf("hibernates", *cluster), JobPhase::kUnknown) << "believed to live";
}

TEST(ReadCluster, AdvisesOnTheWordsOfItsScheduler) {
  const Cluster lab = *ReadCluster("like = \"slurm\"\n[advice]\n\"no licence.\" = \"ask Ann\"\n", "lab.toml");
  EXPECT_EQ(NextStep("sbatch refused: no licence.", lab), "; ask Ann");
  EXPECT_THAT(NextStep("Invalid account", lab), HasSubstr("sacctmgr")) << "Slurm's stay";
  EXPECT_EQ(NextStep("Invalid account", *FindCluster("pbs")), "");
}

TEST(ReadCluster, NeedsNothingButHosts) {
  const Result<Cluster> cluster = ReadCluster("hosts = [\"node7:16\", \"me@b.example.org\"]", "lab.toml");
  ASSERT_TRUE(cluster.ok()) << cluster.error().message;
  ASSERT_EQ(cluster->hosts.size(), 2U);
  EXPECT_EQ(cluster->hosts[0].name, "node7");
  EXPECT_EQ(cluster->hosts[0].slots, 16);
  EXPECT_EQ(cluster->hosts[1].slots, 1);
  EXPECT_THAT(cluster->connect, HasSubstr("BatchMode=yes"));
}

TEST(ReadCluster, SaysWhatIsMissingOrWrong) {
  const std::string own = "name = \"Lab\"\nsubmit = 'put'\nlook = 'list'\n";
  EXPECT_EQ(ErrorOf(own), "lab.toml: cancel is missing, or a shipped cluster to begin with: like = \"sge\"");
  EXPECT_EQ(ErrorOf("like = \"sge\"\ncancel = 'qdel'"), "lab.toml: cancel lacks \"$@\"");
  EXPECT_EQ(ErrorOf("like = \"sge\"\nscript = '#!/bin/bash'"), "lab.toml: script lacks @JOB_NAME@");
  EXPECT_EQ(ErrorOf("like = \"sge\"\nscript = '@JOB_NAME@ @DIRECTIVES@'"), "lab.toml: script lacks @RUN@");
  EXPECT_EQ(ErrorOf("like = \"sge\"\ntask_id = '@JOB@'"), "lab.toml: task_id lacks @TASK@");
  EXPECT_EQ(ErrorOf("like = \"sge\"\ntask_id = ''"),
            "lab.toml: give both task_id and directives.array, or neither");
  EXPECT_EQ(ErrorOf("like = \"sge\"\nsubmit = 'qsub'"), "lab.toml: submit lacks \"$@\"") << "for exclude";
  EXPECT_EQ(ErrorOf("like = \"sge\"\ndirectives.memory = '-l mem'"),
            "lab.toml: directives.memory lacks @VALUE@");
  EXPECT_EQ(ErrorOf("like = \"sge\"\njob_id = 'job'"),
            "lab.toml: job_id = 'job' has no group in brackets, which is the id");
  EXPECT_THAT(ErrorOf("like = \"sge\"\njob_id = '('"), HasSubstr("job_id = '(' is no regular expression"));
  EXPECT_EQ(
      ErrorOf("like = \"sgi\""),
      "unknown shipped cluster 'sgi'; did you mean 'sge'? (a cluster file is given by its path: ./lab.toml)");
  EXPECT_EQ(ErrorOf("like = \"sge\"\nsubmitt = 'a'"),
            "lab.toml:2:1: unknown key of a cluster file 'submitt'; did you mean 'submit'?");
  EXPECT_EQ(
      ErrorOf("like = \"sge\"\ndirectives.memori = '-l @VALUE@'"),
      "lab.toml:2:12: unknown key of a cluster file 'directives.memori'; did you mean 'directives.memory'?");
  EXPECT_THAT(ErrorOf("like = \"sge\"\nqueue = ['qw']"), HasSubstr("did you mean 'queued'?"));
  EXPECT_THAT(ErrorOf("like = \"sge\"\nzzz = 1"), HasSubstr("known: like, hosts, never_starts, queued, "));
  EXPECT_EQ(ErrorOf("like = \"sge\"\nqueued = 'qw'"),
            "lab.toml:2:1: queued is text, expected a list of texts");
  EXPECT_EQ(ErrorOf("like = \"sge\"\ngive_up_after = -1"),
            "lab.toml:2:1: give_up_after = -1 is out of range, allowed 0 to 1000000");
  EXPECT_EQ(ErrorOf("like = \"sge\"\nhosts = [\"a\"]"),
            "lab.toml: hosts have no scheduler: leave out hosts, or like");
  EXPECT_EQ(ErrorOf("hosts = [\"a\"]\nlike = \"ssh\""), "");
  EXPECT_THAT(ErrorOf("hosts = [\"a\"]\nconnect = ''"), HasSubstr("lab.toml: connect is missing"));
  EXPECT_EQ(ErrorOf("like = \"sge\"\ntask_id = ''\ndirectives.array = ''"), "") << "a site without arrays";
  EXPECT_EQ(ErrorOf("hosts = [\"a\", \"a:3\"]"), "lab.toml:1:1: hosts has a twice");
  EXPECT_THAT(ErrorOf("like = \"sge\"\n[advice]\n\"\" = \"x\""),
              HasSubstr("unknown key of a cluster file 'advice.'"));
  EXPECT_EQ(ErrorOf("hosts = \"a\""), "lab.toml:1:1: hosts is text, expected a list of texts");
  for (const char* host : {"-oProxyCommand=x", "a:0", "a b", "a:b", ""})
    EXPECT_THAT(ErrorOf(std::string("hosts = [\"") + host + "\"]"), HasSubstr("give NAME or NAME:SLOTS"))
        << host;
}

WorkerJob AJob(const std::string& log_directory, const std::string& worker) {
  return {
      .name = "gauntlet-ab12-w1", .worker = worker, .access_file = "/a b", .log_directory = log_directory};
}

TEST(ClusterScript, SaysWhatTheSiteAsksForInItsOwnWords) {
  const Cluster sge = *FindCluster("sge");
  WorkerJob job = AJob("/my logs", "/opt/worker");
  job.slots = 4;
  job.array = 3;
  JobRequest request;
  request.partition = "all.q";
  request.time_limit = "00:30:00";
  request.extra = {"-m e"};
  request.setup = "module load zeromq";
  const Result<std::string> script = WorkerScript(sge.script, job, request, sge);
  ASSERT_TRUE(script.ok()) << script.error().message;
  for (const char* line :
       {"#$ -N gauntlet-ab12-w1\n", "#$ -q all.q\n", "#$ -m e\n", "#$ -pe smp 4\n", "#$ -t 1-3\n",
        "#$ -l h_rt=1800\n", "\nmodule load zeromq\n", "exec >>'/my logs'/worker-\"$job\".log",
        "/opt/worker --access '/a b' --slots 4 --allocation \"$job:0:$(uname -n)\"", "$((1800 - 120))"})
    EXPECT_THAT(*script, HasSubstr(line));
  EXPECT_THAT(*script, Not(testing::ContainsRegex("@[A-Z]+@")));
  request.qos = "high";
  EXPECT_EQ(WorkerScript(sge.script, job, request, sge).error().message,
            "slurm.qos = high: Grid Engine has no directive for it in its cluster file");
  const Cluster pbs = *FindCluster("pbs");
  request.qos = "";
  EXPECT_THAT(*WorkerScript(pbs.script, job, request, pbs), HasSubstr("#PBS -J 1-3\n"));
}

// What a job does that has none of Slurm's help.
TEST(ClusterScript, LeavesItsExitCodeWhateverEndsIt) {
  const testing_support::TemporaryDirectory logs;
  const Cluster ssh = *ReadCluster("hosts = [\"a\"]", "lab.toml");
  const auto run = [&](const std::string& worker, const std::string& time_limit, const std::string& before) {
    JobRequest request;
    request.time_limit = time_limit;
    request.setup = before;
    const std::string script =
        *WorkerScript(ssh.script, AJob(logs.path(), "bash -c '" + worker + "' --"), request, ssh);
    testing_support::RunProcess({"/usr/bin/env", "GAUNTLET_BATCH_JOB=7", "/bin/bash", "-c", script});
    std::string codes;
    for (const auto& file : std::filesystem::directory_iterator(logs.path())) {
      if (file.path().extension() != ".exit") continue;
      std::ifstream in(file.path());
      codes.append(std::istreambuf_iterator<char>(in), {});
      std::filesystem::remove(file.path());
    }
    return codes;
  };
  EXPECT_EQ(run("exit 0", "1", ""), "0\n");
  EXPECT_EQ(run("exit 2", "1", ""), "2\n");
  EXPECT_EQ(run("kill -9 $$", "1", ""), "137\n");
  EXPECT_EQ(run("trap \"exit 5\" TERM; sleep 60 & wait", "0:02", ""), "5\n") << "told at the time limit";
  // timeout(1) that is told before it waits for its child leaves the child alone.
  const std::string waits = "until grep -q \"^State:.S\" /proc/$PPID/status; do :; done; ";
  EXPECT_EQ(
      run("trap \"exit 6\" TERM; " + waits + "kill -USR2 $PARENT; sleep 60 & wait", "1", "export PARENT=$$"),
      "6\n")
      << "as Grid Engine tells it";
}

class OwnClusterTest : public testing::Test {
 protected:
  // A scheduler of three commands.
  Result<Cluster> Own(const std::string& submit, const std::string& look,
                      const std::string& cancel = "true \"$@\"") {
    return ReadCluster("name = \"Lab\"\nsubmit = '" + submit + "'\nlook = '" + look + "'\ncancel = '" +
                           cancel + "'\njob_id = 'job (\\d+)'\nscript = '@JOB_NAME@ @DIRECTIVES@ @RUN@'\n" +
                           "running = [\"R\"]\n",
                       "lab.toml");
  }
  std::string Read(const std::string& name) const {
    std::ifstream in(scratch_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  testing_support::TemporaryDirectory scratch_;
};

TEST_F(OwnClusterTest, ThreeCommandsAreEnough) {
  CommandLineSlurm client(*Own("cat >" + scratch_ / "script" + "; echo your job 12 waits",
                               "echo \"12|R|n1||g-w1\"; echo \"13|?|||other\"",
                               "echo \"$@\" >" + scratch_ / "ended"));
  EXPECT_EQ(*client.Submit("the script", {}), "12");
  EXPECT_EQ(Read("script"), "the script");
  EXPECT_EQ(*client.TestOnly("s", {}), "") << "there is none";
  const Result<std::vector<JobStatus>> jobs = client.Queue("g-");
  ASSERT_TRUE(jobs.ok()) << jobs.error().message;
  ASSERT_EQ(jobs->size(), 1U);
  EXPECT_EQ(jobs->front().phase, JobPhase::kRunning);
  EXPECT_EQ(jobs->front().nodes, "n1");
  EXPECT_TRUE(client.Cancel({"12", "7 x"}).ok());
  EXPECT_EQ(Read("ended"), "12 7 x\n");
}

TEST_F(OwnClusterTest, RubbishIsQuoted) {
  CommandLineSlurm client(*Own("echo welcome", "echo who knows"));
  EXPECT_EQ(client.Submit("", {}).error().message, "echo answered 'welcome' instead of a job id");
  EXPECT_EQ(client.Queue("g-").error().message,
            "echo printed 'who knows', which is not of the form id|state|node|reason|name");
}

TEST_F(OwnClusterTest, NamesThatAreCutAreNoticed) {
  CommandLineSlurm client(*Own("echo job 12", "echo \"12|R|n1||gauntlet-f\""));
  ASSERT_TRUE(client.Submit("", {}).ok());
  EXPECT_EQ(
      client.Queue("gauntlet-flocking-1").error().message,
      "echo gives job 12 the name 'gauntlet-f', not gauntlet-flocking-1...: `look` has to print whole names");
}

TEST_F(OwnClusterTest, ALookThatFailsIsNoEmptyQueue) {
  CommandLineSlurm in_a_pipe(*Own("echo job 1", "{ echo no server >&2; exit 3; } | cat"));
  EXPECT_THAT(in_a_pipe.Queue("g-").error().message, HasSubstr("no server"));
  CommandLineSlurm absent(*Own("no-such-qsub", "no-such-qstat | cat"));
  EXPECT_EQ(absent.Queue("g-").error().message,
            "there is no no-such-qstat in PATH: is Lab installed on this machine?");
  EXPECT_EQ(absent.Submit("", {}).error().kind, ErrorKind::kNotFound);
}

// With all that it started.
TEST_F(OwnClusterTest, ACommandThatHangsIsEnded) {
  CommandLineSlurm client(*Own("sleep 600 & echo $! >" + scratch_ / "pid" + "; wait", "true"),
                          milliseconds(300));
  EXPECT_EQ(client.Submit("", {}).error().message, "cannot call sleep: no answer within 300 ms");
  EXPECT_TRUE(testing_support::Eventually([&] { return !testing_support::Alive(std::stoi(Read("pid"))); },
                                          std::chrono::seconds(10)));
}

}  // namespace
}  // namespace gauntlet::slurm
