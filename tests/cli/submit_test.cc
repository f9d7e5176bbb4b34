// Covers: cli/commands/submit_command.cc, cli/submitted_campaign.cc, slurm/slurm_campaign.cc
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/command_line.h"
#include "cli/options/sweep.h"
#include "slurm/job_script.h"
#include "tests/support/fake_campaigns.h"
#include "tests/support/fake_slurm.h"
#include "tests/support/local_socket.h"

namespace gauntlet {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class Submit : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("gauntlet-submit-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(root_);
    setenv("XDG_CONFIG_HOME", root_.c_str(), 1);
    cluster_.next_id = 12;
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  ExitCode Run(std::vector<std::string> arguments) {
    out_.str("");
    err_.str("");
    CommandContext context{.out = out_, .err = err_, .campaigns = campaigns_};
    context.slurm = [this] { return cluster_.MakeClient(); };
    return RunCommandLine(arguments, context);
  }
  std::string dir() const { return root_ / "c"; }
  // Of the campaign's jobs, once its master's job was submitted.
  std::string JobPrefix() const {
    const std::string& name = cluster_.jobs.at(0).name;
    EXPECT_THAT(name, ::testing::EndsWith("master"));
    return name.substr(0, name.rfind("master"));
  }

  std::filesystem::path root_;
  testing_support::FakeSlurm cluster_;
  testing_support::FakeCampaigns campaigns_;
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(Submit, MakesTheCampaignAndItsMastersJob) {
  EXPECT_EQ(Run({"submit", "flocking", "--dir", dir(), "--slurm", "partition=short"}), kExitDone)
      << err_.str();
  EXPECT_THAT(cluster_.tested, SizeIs(2));
  ASSERT_THAT(cluster_.submitted, SizeIs(1));
  EXPECT_THAT(cluster_.submitted[0], AllOf(HasSubstr("resume " + dir() + " --as-job"), HasSubstr("--requeue"),
                                           HasSubstr("#SBATCH --partition=short")));
  EXPECT_THAT(campaigns_.slurm, HasSubstr("partition = \"short\""));
  EXPECT_THAT(campaigns_.prepared, SizeIs(1));
}

TEST_F(Submit, ReadsTheUsersFileThenTheExperimentThenTheCommandLine) {
  std::filesystem::create_directories(root_ / "gauntlet");
  std::ofstream(root_ / "gauntlet" / "slurm.toml") << "account = \"a\"\nqos = \"b\"\nmemory = \"1G\"\n";
  std::ofstream(root_ / "e.toml") << "scenario = \"flocking\"\n[slurm]\nqos = \"c\"\nmemory = \"2G\"\n";
  EXPECT_EQ(Run({"submit", root_ / "e.toml", "--dir", dir(), "--slurm", "memory=3G"}), kExitDone)
      << err_.str();
  EXPECT_THAT(campaigns_.slurm,
              AllOf(HasSubstr("account = \"a\""), HasSubstr("qos = \"c\""), HasSubstr("memory = \"3G\"")));
  EXPECT_EQ(Run({"submit", "flocking", "--dir", dir() + "2", "--set", "slurm.qos=x"}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: --set slurm.qos=x: settings of Slurm are given with --slurm KEY=VALUE\n");
}

TEST_F(Submit, ADryRunPrintsScriptsAndAnswersAndChangesNothing) {
  EXPECT_EQ(Run({"submit", "flocking", "--dir", dir(), "--dry-run"}), kExitDone);
  cluster_.refusal = "allocation failure: Invalid account or account/partition combination specified";
  EXPECT_EQ(Run({"submit", "flocking", "--dir", dir(), "--dry-run"}), kExitUsage);
  EXPECT_THAT(out_.str(), HasSubstr("Invalid account"));
  EXPECT_EQ(err_.str(),
            "gauntlet: the master's job could not start: allocation failure: Invalid account or "
            "account/partition combination specified; name yours: --slurm account=NAME (`sacctmgr show "
            "associations user=$USER` lists them)\n");
  EXPECT_EQ(Run({"submit", "flocking", "--dir", dir()}), kExitUsage);
  EXPECT_THAT(cluster_.submitted, IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(dir()));
}

// As many runs side by side as without `cores`, each with its cores.
TEST_F(Submit, ACommandThatUsesSeveralCoresAsksForThem) {
  std::ofstream(root_ / "e.toml")
      << "scenario = \"command\"\n[command]\nrun = [\"true\"]\nmetrics = [\"items\"]\n"
         "fitness = \"items\"\nfailure = \"items < 3\"\ncores = 3\n";
  EXPECT_EQ(
      Run({"submit", root_ / "e.toml", "--dir", dir(), "--dry-run", "--slurm", "workers_per_allocation=2"}),
      kExitDone)
      << err_.str();
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("--cpus-per-task=6"), HasSubstr("--slots 6")));
}

TEST_F(Submit, AnAddressThatNoMasterCouldListenOnIsRefusedBeforeAnythingIsMade) {
  for (const std::string bad : {"tcp://0.0.0.0:99999", "tcp://localhost:*", "inproc://x"}) {
    EXPECT_EQ(Run({"submit", "flocking", "--dir", dir(), "--slurm", "bind=" + bad}), kExitUsage);
    EXPECT_THAT(err_.str(), HasSubstr("cannot listen on '" + bad + "'"));
  }
  const testing_support::ListeningSocket taken;
  const std::string in_use = "bind=tcp://127.0.0.1:" + std::to_string(taken.port());
  EXPECT_EQ(Run({"submit", "flocking", "--dir", dir(), "--master", "here", "--slurm", in_use}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("Address already in use"));
  EXPECT_FALSE(std::filesystem::exists(dir()));
  EXPECT_THAT(cluster_.submitted, IsEmpty());
}

// Of commands whose master stays here.
TEST_F(Submit, JobsAreTheWorkersOfACommandThatAsksForThem) {
  std::filesystem::create_directories(root_ / "gauntlet");
  std::ofstream(root_ / "gauntlet" / "slurm.toml") << "account = \"a\"\n";
  std::ofstream(root_ / "e.toml") << "scenario = \"flocking\"\n[slurm]\nqos = \"c\"\n";
  campaigns_.report.summary.searches.resize(1);
  campaigns_.report.summary.searches[0].search = "genetic";
  bool has_pool = false;
  campaigns_.during = [&](const SessionOptions& session) { has_pool = session.make_pool() != nullptr; };
  EXPECT_EQ(Run({"evolve", root_ / "e.toml", "--dir", dir(), "--slurm", "memory=3G"}), kExitDone)
      << err_.str();
  EXPECT_THAT(err_.str(), HasSubstr(", workers from Slurm, in "));
  EXPECT_TRUE(has_pool);
  EXPECT_EQ(campaigns_.workers, 0);
  EXPECT_THAT(campaigns_.slurm, AllOf(HasSubstr("account = \"a\""), HasSubstr("qos = \"c\""),
                                      HasSubstr("memory = \"3G\""), HasSubstr("master = \"here\"")));
  EXPECT_THAT(cluster_.tested, SizeIs(1)) << "the workers' job";

  EXPECT_EQ(Run({"evolve", "flocking", "--slurm", "memory=3G", "--workers", "2"}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: --slurm goes without --workers: workers are jobs\n");
  EXPECT_EQ(Run({"evolve", "flocking", "--slurm", "master=job"}), kExitUsage);
  EXPECT_EQ(err_.str(),
            "gauntlet: --slurm master=job: the master stays here, unless 'submit' makes it a job\n");
  EXPECT_EQ(Run({"examine", "flocking", "--dry-run", "--slurm", "max_allocations=3", "--slurm",
                 "workers_per_allocation=4"}),
            kExitDone)
      << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("with 12 workers"));
  std::ofstream(root_ / "lab.toml") << "like = \"ssh\"\nhosts = [\"a:2\", \"b:2\"]\n";
  EXPECT_EQ(Run({"examine", "flocking", "--dry-run", "--slurm", "cluster=" + (root_ / "lab.toml").string(),
                 "--slurm", "account=", "--slurm", "workers_per_allocation=2"}),
            kExitDone)
      << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("with 4 workers")) << "for more the hosts have no room";
  EXPECT_EQ(Run({"margin", "flocking", "--vary", "noise.wheels.uniform=0..1", "--on", "random:20", "--slurm",
                 "partitoin=x"}),
            kExitUsage);
  EXPECT_EQ(err_.str(),
            "gauntlet: --slurm partitoin=x: unknown Slurm setting 'partitoin'; did you mean 'partition'?\n");
  cluster_.refusal = "invalid partition specified: x";
  EXPECT_EQ(Run({"probability", "flocking", "--slurm", "partition=x"}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("a job of workers could not start: invalid partition specified: x"));
  EXPECT_EQ(campaigns_.starts, 1);
}

TEST_F(Submit, ResumeGivesTheMasterToSlurmAgainUnlessOneIsThere) {
  ASSERT_EQ(Run({"submit", "flocking", "--dir", dir()}), kExitDone);
  cluster_.Set("12", "NODE_FAIL");
  EXPECT_EQ(Run({"resume", dir()}), kExitDone) << err_.str();
  EXPECT_THAT(cluster_.submitted, SizeIs(2));
  EXPECT_EQ(Run({"resume", dir()}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: job 13 (PENDING) is the campaign's master already; see: gauntlet status " +
                            (root_ / "c").string() + "\n");
  EXPECT_THAT(cluster_.submitted, SizeIs(2));
}

TEST_F(Submit, ResumeMakesItLongerBeforeItsMasterIsSubmitted) {
  ASSERT_EQ(Run({"submit", "flocking", "--dir", dir()}), kExitDone);
  cluster_.Set("12", "COMPLETED");
  EXPECT_EQ(Run({"resume", dir(), "--generations", "80"}), kExitDone) << err_.str();
  EXPECT_THAT(campaigns_.extended, ElementsAre("search.generations=80"));
  EXPECT_EQ(err_.str(),
            "gauntlet: " + (root_ / "c").string() + " goes on: search.generations from 50 to 80\n");
  EXPECT_THAT(cluster_.submitted, SizeIs(2));
  cluster_.Set("13", "COMPLETED");
  campaigns_.error = InvalidInput("--set search.generations=1: shorter");
  EXPECT_EQ(Run({"resume", dir(), "--generations", "1"}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: --generations 1: shorter\n");
  EXPECT_THAT(cluster_.submitted, SizeIs(2));
}

TEST_F(Submit, ATemplateIsARegularFileOrALinkToOne) {
  const std::string shipped = root_ / "mine.sbatch";
  std::ofstream(shipped) << slurm::kWorkerTemplate;
  std::filesystem::create_symlink(shipped, root_ / "link.sbatch");
  const std::string link = "worker_template=" + (root_ / "link.sbatch").string();
  EXPECT_EQ(Run({"submit", "flocking", "--dir", dir(), "--slurm", link}), kExitDone) << err_.str();
  EXPECT_THAT(campaigns_.slurm, HasSubstr("worker_template = \"" + shipped + "\""));

  const std::string pipe = root_ / "pipe.sbatch";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string key : {"worker_template", "master_template"}) {
    for (const auto& [file, kind] :
         {std::pair(pipe, "a named pipe"), std::pair(std::string("/dev/zero"), "a device"),
          std::pair(root_.string(), "a directory")}) {
      EXPECT_EQ(Run({"submit", "flocking", "--dir", root_ / "other", "--slurm", key + "=" + file}),
                kExitUsage);
      EXPECT_THAT(err_.str(), AllOf(HasSubstr("slurm." + key), HasSubstr(file + " is " + kind)));
      // Of a campaign that exists.
      std::ofstream(dir() + "/slurm.toml") << "tag = \"x\"\n" << key << " = \"" << file << "\"\n";
      EXPECT_EQ(Run({"resume", dir()}), kExitUsage);
      EXPECT_THAT(err_.str(), HasSubstr(file + " is " + kind));
    }
  }
}

TEST_F(Submit, StopCancelsWhatIsLeft) {
  ASSERT_EQ(Run({"submit", "flocking", "--dir", dir()}), kExitDone);
  cluster_.Set("12", "COMPLETED");
  cluster_.Add("13", JobPrefix() + "w1", "RUNNING");
  cluster_.Add("14", JobPrefix() + "w2", "COMPLETED");
  cluster_.Add("15", "somebody-else", "RUNNING");
  EXPECT_EQ(Run({"stop", dir()}), kExitDone);
  EXPECT_THAT(cluster_.cancelled, ElementsAre("13"));
}

TEST_F(Submit, StatusListsTheJobsWithSlurmsWordsWhetherAMasterLivesOrNot) {
  ASSERT_EQ(Run({"submit", "flocking", "--dir", dir()}), kExitDone);
  const std::string master = JobPrefix() + "master";
  campaigns_.status =
      R"json({"state": "running", "why_nothing_runs": null, "pool_trouble": "job 8 waits in the queue (Priority)",
                "allocations": [
                 {"job": "7_1", "state": "RUNNING", "reason": "", "nodes": "n3", "workers": 2, "cancelled": false},
                 {"job": "8", "state": "PENDING", "reason": "Priority", "nodes": "", "workers": 0,
                  "cancelled": false}], "worker_list": []
})json";
  EXPECT_EQ(Run({"status", dir()}), kExitDone);
  EXPECT_EQ(out_.str(), (root_ / "c").string() +
                            ": running\n"
                            "fewer workers than could be used: job 8 waits in the queue (Priority)\n"
                            "\n"
                            "  job  state    reason    node  workers\n"
                            "  7_1  RUNNING            n3          2\n"
                            "  8    PENDING  Priority              0\n");
  campaigns_.status =
      R"({"state": "stopped", "why_nothing_runs": "no master serves the campaign", "worker_list": []})";
  cluster_.jobs.clear();
  cluster_.Add("13", master, "PENDING", "Resources");
  EXPECT_EQ(Run({"status", dir()}), kExitDone);
  EXPECT_EQ(out_.str(), (root_ / "c").string() +
                            ": stopped\n"
                            "nothing runs: job 13, which is to be the master, is PENDING (Resources)\n"
                            "\n"
                            "  job        state    reason     node  workers\n"
                            "  13 master  PENDING  Resources              0\n");
}

TEST_F(Submit, ASweepHasASearchForEachCombination) {
  EXPECT_EQ(Run({"submit", "flocking", "--dir", dir(), "--sweep", "search.population=4,6", "--sweep",
                 "search.crossover=uniform,single-point", "--seeds", "3..5"}),
            kExitDone)
      << err_.str();
  ASSERT_THAT(campaigns_.prepared, SizeIs(12));
  EXPECT_EQ(campaigns_.prepared[0].settings, "search.population=4, search.crossover=uniform, seed 3");
  EXPECT_EQ(campaigns_.prepared[11].settings, "search.population=6, search.crossover=single-point, seed 5");
  EXPECT_EQ(campaigns_.prepared[11].experiment.search.population, 6);
  EXPECT_EQ(campaigns_.prepared[11].experiment.seed, 5U);
}

}  // namespace
}  // namespace gauntlet
