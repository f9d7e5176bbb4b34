// The short one of the tests on a real Slurm.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/plugin/plugin_files.h"
#include "tests/slurm/cluster/slurm_cluster.h"

namespace gauntlet::testing_support {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST_F(SlurmTest, ASubmittedSearchEndsLikeALocalOneAndLeavesNothing) {
  StartCluster({"--nodes", "2", "--cpus", "4"});
  const SmallCampaign campaign;
  const std::string hash = LocalHash(campaign);
  // What an enclosing job has set must not leak into what is submitted.
  setenv("SBATCH_PARTITION", "no-such-partition", 1);
  setenv("SLURM_JOB_ID", "99999", 1);

  const ProcessResult dry = [&] {
    std::vector<std::string> arguments = SubmitArguments(campaign, "job", {"constraint=gpu9000"});
    arguments.push_back("--dry-run");
    return Gauntlet(arguments);
  }();
  EXPECT_EQ(dry.exit_code, 2);
  EXPECT_THAT(dry.out, AllOf(HasSubstr("#SBATCH --constraint=gpu9000"), HasSubstr("resume " + dir())));
  EXPECT_THAT(dry.err, AllOf(HasSubstr("a job of workers could not start"), HasSubstr("nvalid feature"),
                             HasSubstr("sinfo -o '%N %f'")));
  EXPECT_FALSE(std::filesystem::exists(dir()));

  const ProcessResult result = Gauntlet(SubmitArguments(campaign, "here", {"max_allocations=3"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(StateHash(dir()), hash);
  EXPECT_TRUE(QueueEmpties());
  const std::vector<std::string> all = QueueLines({"--states=all"});
  EXPECT_THAT(all, Contains(HasSubstr("gauntlet-flocking-")));
  EXPECT_THAT(all, SizeIs(testing::Le(3U)));
  unsetenv("SBATCH_PARTITION");
  unsetenv("SLURM_JOB_ID");

  // Names that Slurm and the shell read each in their own way.
  for (const std::string name : {"it's \"50%\" odd", "it's \"50%\" \\ odd"}) {
    const std::string odd = scratch_ / name;
    std::vector<std::string> arguments = SubmitArguments(campaign, "here", {"max_allocations=1"});
    std::ranges::replace(arguments, dir(), odd);
    const ProcessResult submitted = Gauntlet(arguments);
    EXPECT_EQ(submitted.exit_code, 0) << submitted.err;
    EXPECT_EQ(StateHash(odd), hash);
    EXPECT_TRUE(QueueEmpties());
    int logs = 0;
    for (const auto& log : std::filesystem::directory_iterator(odd + "/log"))
      logs += log.path().filename().string().starts_with("worker") ? 1 : 0;
    EXPECT_GE(logs, 1) << odd;
  }
  std::vector<std::string> broken = SubmitArguments(campaign, "here");
  std::ranges::replace(broken, dir(), scratch_ / "two\nlines");
  const ProcessResult refused = Gauntlet(broken);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("a job script cannot hold a line break"));
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "two\nlines"));
}

// The master reads its lines here.
TEST_F(SlurmTest, AStreamOfCasesTakesItsWorkersFromSlurm) {
  StartCluster({"--nodes", "1", "--cpus", "4"});
  std::ofstream(scratch_ / "lines") << R"({"id": "a", "case": {}})"
                                    << "\n"
                                    << R"({"id": "b", "case": {}})"
                                    << "\n";
  const std::string command = fmt::format(
      "exec {} evaluate flocking --stdin --quiet --dir {} --slurm bind=tcp://127.0.0.1:* --slurm "
      "max_allocations=1 < {}",
      GauntletPath(), dir(), scratch_ / "lines");
  const ProcessResult first = RunProcess({"/bin/sh", "-c", command});
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, AllOf(HasSubstr(R"({"id":"a","line":1)"), HasSubstr(R"({"id":"b","line":2)")));
  EXPECT_TRUE(QueueEmpties());
  const ProcessResult again = RunProcess({"/bin/sh", "-c", command});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, first.out) << "from the store";
  EXPECT_TRUE(QueueEmpties());
}

// Each step asks for jobs of its own.
TEST_F(SlurmTest, AnExaminationTakesItsWorkersFromSlurm) {
  const auto examine = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"examine", "flocking", "--budget", "1200",
                                          "--dir",   dir(),      "-o",       scratch_ / "page.html",
                                          "--json",  "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Gauntlet(arguments);
  };
  const ProcessResult here = examine({});
  ASSERT_EQ(here.exit_code, 0) << here.err;
  std::filesystem::remove_all(dir());
  StartCluster({"--nodes", "1", "--cpus", "2"});
  const ProcessResult there = examine({"--slurm", "bind=tcp://127.0.0.1:*", "--slurm", "max_allocations=1",
                                       "--slurm", "workers_per_allocation=2"});
  EXPECT_EQ(there.exit_code, 0) << there.err;
  EXPECT_EQ(there.out, here.out);
  EXPECT_TRUE(QueueEmpties());
}

// It was begun on this machine; then its workers are jobs, which the next master takes up without being told.
TEST_F(SlurmTest, AQuestionGoesOnWithTheJobsThatItHad) {
  ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "1", "--quiet", "--dir", dir()}).exit_code, 0);
  StartCluster({"--nodes", "1", "--cpus", "2"});
  const auto ask = [&](const std::vector<std::string>& workers) {
    std::vector<std::string> question = {"confirm", dir(), "1", "--replicates", "20000", "--no-progress"};
    question.insert(question.end(), workers.begin(), workers.end());
    return StartGauntlet(question);
  };
  const std::string answers = scratch_ / "c/confirm";
  const auto has_a_worker = [&] {
    std::error_code none;
    for (const auto& answer : std::filesystem::directory_iterator(answers, none)) {
      const auto status =
          nlohmann::json::parse(Gauntlet({"status", answer.path(), "--json"}).out, nullptr, false);
      if (status.is_object() && status.value("state", "") == "running" && status.value("workers", 0) == 1)
        return true;
    }
    return false;
  };
  std::unique_ptr<Process> here = ask({"--workers", "1"});
  ASSERT_TRUE(Eventually(has_a_worker, 2 * kPatience)) << here->Err();
  here.reset();
  std::unique_ptr<Process> killed =
      ask({"--slurm", "bind=tcp://127.0.0.1:*", "--slurm", "max_allocations=1"});
  ASSERT_TRUE(Eventually(has_a_worker, 2 * kPatience)) << killed->Err();
  killed.reset();
  EXPECT_THAT(QueueLines(), SizeIs(1));
  const std::unique_ptr<Process> next = ask({});
  ASSERT_TRUE(Eventually(has_a_worker, 2 * kPatience)) << next->Err();
  next->Signal(SIGINT);
  EXPECT_EQ(next->Wait().exit_code, 3) << next->Err();
  EXPECT_THAT(next->Err(), HasSubstr("workers from Slurm"));
  EXPECT_TRUE(QueueEmpties());
  EXPECT_THAT(QueueLines({"--states=all"}), SizeIs(1)) << "no other was needed";
}

// Master and workers on other nodes have the plug-in from the campaign's directory.
TEST_F(SlurmTest, ASubmittedSearchWithAPluginEndsLikeALocalOneWithoutItsLibrary) {
  StartCluster({"--nodes", "2", "--cpus", "4"});
  const SmallCampaign campaign = SmallPlugin(scratch_);
  const std::string hash = LocalHash(campaign);
  const ProcessResult submitted = Gauntlet(SubmitArguments(campaign, "job", {"max_allocations=3"}));
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  std::filesystem::remove(scratch_ / "twins.so");
  EXPECT_TRUE(
      StatusBecomes([](const nlohmann::json& status) { return status.value("state", "") == "finished"; }));
  EXPECT_EQ(StateHash(dir()), hash);
  EXPECT_EQ(Show(dir())["runs_failed"], 0);
  EXPECT_TRUE(QueueEmpties());
}

constexpr const char* kStudy = R"(
name = "small"
[part.evolved]
kind = "evolve"
experiment = "flocking"
seeds = "1..2"
set.search.population = 6
set.search.generations = 3
[part.again]
kind = "evaluate"
from = "evolved"
[compare.severity]
title = "evolved, as found and again"
first = "again"
second = "evolved"
)";

TEST_F(SlurmTest, ASubmittedStudyEndsLikeALocalOneAndLeavesNothing) {
  StartCluster({"--nodes", "2", "--cpus", "4"});
  const std::string file = scratch_ / "small.toml";
  std::ofstream(file) << kStudy;
  const auto study = [&](const std::string& dir, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"study", file, "--dir", dir, "--json", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Gauntlet(arguments);
  };
  const auto figures = [](const ProcessResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out, nullptr, false)["figures"];
  };
  const nlohmann::json local = figures(study(scratch_ / "local", {}));
  const std::vector<std::string> submit = {"--submit", "--slurm", "bind=tcp://127.0.0.1:*"};
  const auto with = [&](const std::string& master) {
    std::vector<std::string> arguments = submit;
    arguments.insert(arguments.end(), {"--master", master});
    return arguments;
  };
  EXPECT_EQ(figures(study(scratch_ / "here", with("here"))), local);
  EXPECT_TRUE(QueueEmpties());

  const std::string dir = scratch_ / "job";
  const ProcessResult submitted = study(dir, with("job"));
  ASSERT_EQ(submitted.exit_code, 0) << submitted.err;
  EXPECT_THAT(submitted.out, HasSubstr("\"job\""));
  const ProcessResult twice = Gauntlet({"resume", dir});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("is the campaign's master already"));
  EXPECT_TRUE(Eventually([] { return QueueLines().empty(); }, std::chrono::seconds(120)));
  EXPECT_EQ(figures(Gauntlet({"resume", dir, "--json", "--quiet"})), local);
  EXPECT_THAT(study(dir, submit).err, HasSubstr("was submitted before; go on with"));
}

}  // namespace
}  // namespace gauntlet::testing_support
