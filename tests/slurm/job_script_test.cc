#include "slurm/job_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::slurm {
namespace {

using testing::HasSubstr;
using testing::Not;

WorkerJob AWorkerJob() {
  return {.name = "gauntlet-ab12-w1",
          .worker = "/opt/gauntlet/gauntlet-worker",
          .access_file = "/work/my campaign/access.json",
          .log_directory = "/work/my campaign/log",
          .slots = 4};
}

TEST(WorkerScript, SaysWhatTheSiteAsksFor) {
  JobRequest request;
  request.partition = "main";
  request.account = "swarm";
  request.memory = "2G";
  request.time_limit = "00:30:00";
  request.extra = {"--exclusive", "--mail-type=FAIL"};
  request.setup = "module load zeromq";
  const Result<std::string> script = WorkerScript(kWorkerTemplate, AWorkerJob(), request);
  ASSERT_TRUE(script.ok()) << script.error().message;
  EXPECT_THAT(*script, testing::StartsWith("#!/bin/bash\n"));
  for (const char* line :
       {"#SBATCH --job-name=gauntlet-ab12-w1\n", "--cpus-per-task=4\n", "#SBATCH --time=00:30:00\n",
        "#SBATCH --no-requeue\n", "#SBATCH --partition=main\n", "#SBATCH --account=swarm\n",
        "#SBATCH --mem=2G\n", "#SBATCH --exclusive\n", "#SBATCH --mail-type=FAIL\n", "\nmodule load zeromq\n",
        "#SBATCH --output=\"/work/my campaign/log/worker-%j.log\"\n",
        "--access '/work/my campaign/access.json'"})
    EXPECT_THAT(*script, HasSubstr(line));
  EXPECT_THAT(*script, HasSubstr("#SBATCH --signal=B:TERM@120\n"));
  EXPECT_THAT(*script, Not(HasSubstr("--array"))) << "one is no array";
  EXPECT_THAT(*script, Not(HasSubstr("--qos"))) << "not asked for";
  EXPECT_THAT(*script, Not(testing::ContainsRegex("@[A-Z]+@")));
}

TEST(WorkerScript, AsksForEqualAllocationsAsAnArray) {
  WorkerJob job = AWorkerJob();
  job.array = 3;
  const Result<std::string> script = WorkerScript(kWorkerTemplate, job, {});
  ASSERT_TRUE(script.ok()) << script.error().message;
  EXPECT_THAT(*script, HasSubstr("#SBATCH --array=1-3\n"));
  EXPECT_THAT(*script, HasSubstr("/log/worker-%A_%a.log\"\n"));
}

TEST(WorkerScript, TheSignalComesEarlierInShortJobsButNeverAtTheirStart) {
  JobRequest request;
  request.time_limit = "1";
  const Result<std::string> script = WorkerScript(kWorkerTemplate, AWorkerJob(), request);
  ASSERT_TRUE(script.ok()) << script.error().message;
  EXPECT_THAT(*script, HasSubstr("#SBATCH --signal=B:TERM@15\n"));
}

TEST(MasterScript, QuotesItsCommand) {
  const Result<std::string> script =
      MasterScript(kMasterTemplate,
                   {.name = "m", .command = {"/opt/g", "resume", "it's here"}, .log_directory = "/l"}, {});
  ASSERT_TRUE(script.ok());
  EXPECT_THAT(*script, HasSubstr("\n/opt/g resume 'it'\\''s here' &\n"));
  EXPECT_THAT(*script, HasSubstr("#SBATCH --requeue --open-mode=append\n"));
}

TEST(WorkerScript, RefusesWhatWouldSmuggleInALine) {
  JobRequest request;
  request.account = "swarm\n#SBATCH --nodes=100";
  const Result<std::string> script = WorkerScript(kWorkerTemplate, AWorkerJob(), request);
  ASSERT_FALSE(script.ok());
  EXPECT_EQ(script.error().message, "a Slurm option cannot hold a line break: 'swarm\n#SBATCH --nodes=100'");
  WorkerJob job = AWorkerJob();
  job.name = "a\nb";
  EXPECT_FALSE(WorkerScript(kWorkerTemplate, job, {}).ok());
}

// What sbatch and slurmd make of these lines was tried with Slurm 22.05 (tests/slurm/cluster/submit_test.cc).
TEST(WorkerScript, APathMayHoldWhatSlurmAndTheShellReadDifferently) {
  WorkerJob job = AWorkerJob();
  job.log_directory = "/work/it's \"50%\" odd/log";
  job.access_file = "/work/it's \"50%\" odd/access.json";
  const Result<std::string> script = WorkerScript(kWorkerTemplate, job, {});
  ASSERT_TRUE(script.ok()) << script.error().message;
  EXPECT_THAT(*script, HasSubstr("#SBATCH --output=\"/work/it's \\\"50%%\\\" odd/log/worker-%j.log\"\n"));
  EXPECT_THAT(*script, HasSubstr("--access '/work/it'\\''s \"50%\" odd/access.json' --slots"));
  EXPECT_THAT(*script, Not(HasSubstr("--open-mode")));
}

TEST(WorkerScript, BesideABackslashSlurmFillsNothingInSoAllJobsShareALog) {
  WorkerJob job = AWorkerJob();
  job.log_directory = "/work/a\\b 5%/log";
  job.array = 3;
  const Result<std::string> script = WorkerScript(kWorkerTemplate, job, {});
  ASSERT_TRUE(script.ok()) << script.error().message;
  EXPECT_THAT(*script, HasSubstr("#SBATCH --output=\"/work/a\\\\\\\\b 5%/log/worker.log\"\n"));
  EXPECT_THAT(*script, HasSubstr("#SBATCH --open-mode=append\n"));
  const Result<std::string> master =
      MasterScript(kMasterTemplate, {.name = "m", .command = {"g"}, .log_directory = job.log_directory}, {});
  ASSERT_TRUE(master.ok());
  EXPECT_THAT(*master, HasSubstr("/log/master-job.log\"\n"));
}

TEST(WorkerScript, RefusesAPathWithALineBreak) {
  WorkerJob job = AWorkerJob();
  job.log_directory = "/work/two\nlines/log";
  EXPECT_THAT(WorkerScript(kWorkerTemplate, job, {}).error().message, HasSubstr("line break"));
  job = AWorkerJob();
  job.access_file = "/work/two\nlines/access.json";
  EXPECT_FALSE(WorkerScript(kWorkerTemplate, job, {}).ok());
}

TEST(WorkerScript, NamesWhatAnEditedTemplateLacksOrInvents) {
  Result<std::string> script = WorkerScript("#!/bin/bash\nexec @WORKER@", AWorkerJob(), {});
  ASSERT_FALSE(script.ok());
  EXPECT_EQ(script.error().message, "the job template lacks @ACCESS@");
  script = WorkerScript("@NODES@", AWorkerJob(), {});
  ASSERT_FALSE(script.ok());
  EXPECT_EQ(script.error().message, "the job template names @NODES@, which is not known");
}

TEST(WorkerScript, RefusesAnExtraThatIsNoOption) {
  JobRequest request;
  request.extra = {"exclusive"};
  EXPECT_FALSE(WorkerScript(kWorkerTemplate, AWorkerJob(), request).ok());
}

}  // namespace
}  // namespace gauntlet::slurm
