#include "slurm/ssh_hosts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/support/process.h"

namespace gauntlet::slurm {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

constexpr const char* kScript = "#!/bin/bash\n# gauntlet-ab12-w1 \nexec sleep 60\n";

// Hosts that are this machine, behind an ssh that notes whom it calls and fails as a file says.
class SshHostsTest : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(scratch_ / "ssh") << "#!/bin/bash\ncd " << scratch_.path()
                                    << "\necho \"$1\" >>calls\n"
                                       "echo Welcome to $1; echo gauntlet:begin; echo gauntlet:end\n"
                                       "if [ -e \"fail-$1\" ]; then cat \"fail-$1\" >&2; exit 255; fi\n"
                                       "if [ -e meet ]; then touch \"at-$1\"\n"
                                       "  for i in {1..500}; do [ $(ls at-* | wc -l) = 2 ] && break\n"
                                       "  sleep 0.02; done; [ $i -lt 500 ] || exit 1; fi\n"
                                       "exec bash -c \"$2\"\n";
    std::filesystem::permissions(scratch_ / "ssh", std::filesystem::perms::owner_all);
    cluster_ = *ReadCluster(
        "hosts = [\"" + alpha_ + ":2\", \"" + beta_ + "\"]\nconnect = '" + scratch_ / "ssh" + " \"$@\"'\n",
        "lab.toml");
  }
  void TearDown() override {
    SshHosts all(cluster_, 1);
    std::vector<std::string> ids;
    const Result<std::vector<JobStatus>> left = all.Queue("");
    ASSERT_TRUE(left.ok()) << left.error().message;
    for (const JobStatus& job : *left) ids.push_back(job.id);
    EXPECT_TRUE(all.Cancel(ids).ok());
  }
  void Fail(const std::string& host, const std::string& words) const {
    std::ofstream(scratch_ / ("fail-" + host)) << words << "\n";
  }
  void Mend(const std::string& host) const { std::filesystem::remove(scratch_ / ("fail-" + host)); }
  long Calls(const std::string& host) const {
    std::ifstream in(scratch_ / "calls");
    long calls = 0;
    for (std::string line; std::getline(in, line);) calls += line == host ? 1 : 0;
    return calls;
  }

  testing_support::TemporaryDirectory scratch_;
  // Other tests have other hosts, for their jobs are on this machine too.
  const std::string alpha_ = "alpha" + std::to_string(getpid());
  const std::string beta_ = "beta" + std::to_string(getpid());
  Cluster cluster_;
};

TEST_F(SshHostsTest, StartsFindsAndEndsJobs) {
  SshHosts hosts(cluster_, 1);
  const Result<std::string> job = hosts.Submit(kScript, {});
  ASSERT_TRUE(job.ok()) << job.error().message;
  SshHosts another(cluster_, 1);
  const std::vector<JobStatus> jobs = *another.Queue("gauntlet-ab12-");
  ASSERT_THAT(jobs, SizeIs(1));
  EXPECT_EQ(jobs[0].id, *job);
  EXPECT_EQ(jobs[0].name, "gauntlet-ab12-w1");
  EXPECT_EQ(jobs[0].phase, JobPhase::kRunning);
  EXPECT_EQ(jobs[0].nodes, alpha_) << "which had the most room";
  EXPECT_THAT(*another.Queue("gauntlet-cd34-"), IsEmpty());
  const std::string reused = job->substr(0, job->find('.')) + ".1@" + alpha_;
  ASSERT_TRUE(another.Cancel({reused}).ok());
  EXPECT_THAT(*another.Queue("gauntlet-ab12-"), SizeIs(1)) << "another process that has the number now";
  ASSERT_TRUE(another.Cancel({*job, "no job", "1.2@gamma"}).ok());
  EXPECT_TRUE(testing_support::Eventually([&] { return another.Queue("gauntlet-ab12-")->empty(); },
                                          std::chrono::seconds(10)));
}

TEST_F(SshHostsTest, FillsTheHostsAndThenHasNoRoom) {
  SshHosts hosts(cluster_, 1);
  EXPECT_EQ(hosts.room(), 3);
  std::vector<std::string> nodes;
  for (int i = 0; i < 3; ++i) {
    const std::string job = *hosts.Submit(kScript, {});
    nodes.push_back(job.substr(job.find('@') + 1));
  }
  EXPECT_THAT(nodes, testing::UnorderedElementsAre(alpha_, alpha_, beta_));
  EXPECT_THAT(*hosts.Queue(""), SizeIs(3));
  const Result<std::string> more = hosts.Submit(kScript, {});
  EXPECT_EQ(more.error().kind, ErrorKind::kInUse);
  EXPECT_EQ(more.error().message, "no host has room for another job");
  EXPECT_EQ(SshHosts(cluster_, 2).room(), 2) << "a job takes two slots, of a small host all";
}

class SshRefusal : public SshHostsTest, public testing::WithParamInterface<const char*> {};

TEST_P(SshRefusal, IsTakenForAnAnswer) {
  Fail(alpha_, GetParam());
  SshHosts hosts(cluster_, 1);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(hosts.Queue("").ok());
  EXPECT_THAT(*hosts.Submit(kScript, {}), HasSubstr("@" + beta_));
  EXPECT_THAT(
      hosts.Submit(kScript, {}).error().message,
      AllOf(StartsWith("no host has room for another job; " + alpha_ + " is out until `gauntlet resume`: "),
            HasSubstr(std::string(GetParam()).substr(0, 10))));
  EXPECT_EQ(Calls(alpha_), 1);
  Fail(beta_, "me@beta: Permission denied (publickey).");
  EXPECT_TRUE(hosts.Queue("").ok()) << "what ran is still believed to run";
  const Result<std::string> none = hosts.Submit(kScript, {});
  EXPECT_EQ(none.error().kind, ErrorKind::kNotFound);
  EXPECT_THAT(
      none.error().message,
      HasSubstr("; " + beta_ + " is out until `gauntlet resume`: me@beta: Permission denied (publickey)."));
  Mend(alpha_);
  EXPECT_THAT(hosts.Queue("").ok(), true);
  EXPECT_EQ(Calls(alpha_), 1);
  SshHosts after_resume(cluster_, 1);
  EXPECT_THAT(*after_resume.Submit(kScript, {}), HasSubstr("@" + alpha_));
  Mend(beta_);
}

INSTANTIATE_TEST_SUITE_P(, SshRefusal,
                         testing::Values("me@alpha: Permission denied (publickey).",
                                         "Host key verification failed.",
                                         "ssh: Could not resolve hostname alpha: Name or service not known"));

TEST_F(SshHostsTest, AHostThatDoesNotAnswerKeepsItsJobsAndComesBack) {
  SshHosts hosts(cluster_, 1);
  const std::string job = *hosts.Submit(kScript, {});
  ASSERT_THAT(job, HasSubstr("@" + alpha_));
  Fail(alpha_, "ssh: connect to host alpha port 22: Connection timed out");
  const std::vector<JobStatus> jobs = *hosts.Queue("");
  ASSERT_THAT(jobs, SizeIs(1));
  EXPECT_EQ(jobs[0].reason, "its host does not answer");
  EXPECT_THAT(*hosts.Submit(kScript, {}), HasSubstr("@" + beta_));
  EXPECT_THAT(hosts.Submit(kScript, {}).error().message,
              HasSubstr(alpha_ + " does not answer: ssh: connect"));
  Mend(alpha_);
  ASSERT_TRUE(hosts.Queue("").ok());
  EXPECT_THAT(*hosts.Submit(kScript, {}), HasSubstr("@" + alpha_));
}

TEST_F(SshHostsTest, HostsAreAskedAtTheSameTime) {
  std::ofstream(scratch_ / "meet") << "";
  EXPECT_TRUE(SshHosts(cluster_, 1).Queue("").ok()) << "each waits until the other is asked";
  std::filesystem::remove(scratch_ / "meet");
}

// A shell that was killed leaves its worker; a daemon in a job is no job of its own.
TEST_F(SshHostsTest, WhatAJobStartedBelongsToIt) {
  SshHosts hosts(cluster_, 1);
  const std::string script =
      "#!/bin/bash\n# gauntlet-ab12-w1 \nread -r stat </proc/$$/stat\nset -- ${stat##*) }\n"
      "export GAUNTLET_BATCH_JOB=$$.${20}@$GAUNTLET_HOST\n"
      "setsid sleep 60 &\nsleep 60 & wait\n";
  const std::string job = *hosts.Submit(script, {});
  const auto shown = [&] {
    const Result<std::vector<JobStatus>> jobs = hosts.Queue("gauntlet-ab12-");
    std::string ids;
    for (const JobStatus& one : jobs ? *jobs : std::vector<JobStatus>()) ids += one.id + "\n";
    return ids;
  };
  EXPECT_EQ(shown(), job + "\n");
  kill(std::stoi(job), SIGKILL);
  EXPECT_TRUE(testing_support::Eventually([&] { return !testing_support::Alive(std::stoi(job)); },
                                          std::chrono::seconds(10)));
  EXPECT_EQ(shown(), job + "\n") << "what is left of it";
  ASSERT_TRUE(hosts.Cancel({job}).ok());
  EXPECT_TRUE(testing_support::Eventually([&] { return shown().empty(); }, std::chrono::seconds(10)));
}

TEST_F(SshHostsTest, AJobThatEndsAtOnceWasStartedAllTheSame) {
  SshHosts hosts(cluster_, 1);
  const Result<std::string> job = hosts.Submit("#!/bin/bash\n# gauntlet-ab12-w1 \nexit 3\n", {});
  EXPECT_THAT(*job, testing::EndsWith("@" + alpha_));
  EXPECT_TRUE(
      testing_support::Eventually([&] { return hosts.Queue("")->empty(); }, std::chrono::seconds(10)));
}

TEST_F(SshHostsTest, AScriptThatTheHostCannotTakeIsRefused) {
  SshHosts hosts(cluster_, 1);
  const Result<std::string> job = hosts.Submit(kScript + std::string(200'000, '#'), {});
  EXPECT_EQ(job.error().kind, ErrorKind::kInvalidInput) << "a failed start";
  EXPECT_THAT(job.error().message, HasSubstr("less than 131072"));
  EXPECT_TRUE(hosts.Submit(kScript, {}).ok()) << "the host has answered";
}

TEST_F(SshHostsTest, ProcessesThatEndDuringALookDoNotMatter) {
  SshHosts hosts(cluster_, 1);
  const std::string busy = "#!/bin/bash\n# gauntlet-ab12-w1 \nwhile :; do env true & env true & wait; done\n";
  const std::string job = *hosts.Submit(busy, {});
  for (int i = 0; i < 20; ++i) {
    const Result<std::vector<JobStatus>> jobs = hosts.Queue("");
    ASSERT_TRUE(jobs.ok()) << jobs.error().message;
    ASSERT_THAT(*jobs, SizeIs(1));
    EXPECT_EQ(jobs->front().reason, "");
  }
}

TEST_F(SshHostsTest, AGreetingIsNeitherARefusalNorAnAnswer) {
  Fail(alpha_,
       "bash: /etc/profile.d/x.sh: Permission denied\ngauntlet:begin\nConnection closed by 10.0.0.1 port 22");
  SshHosts hosts(cluster_, 1);
  EXPECT_TRUE(hosts.Queue("").ok());
  ASSERT_TRUE(hosts.Submit(kScript, {}).ok());
  EXPECT_THAT(hosts.Submit(kScript, {}).error().message,
              HasSubstr(alpha_ + " does not answer: Connection closed by 10.0.0.1 port 22"));
  Mend(alpha_);
  ASSERT_TRUE(hosts.Queue("").ok());
  EXPECT_THAT(*hosts.Submit(kScript, {}), HasSubstr("@" + alpha_));
}

TEST_F(SshHostsTest, ManyKeysAreARefusalAndANameServerThatIsAwayIsNot) {
  Fail(alpha_,
       "Received disconnect from 10.0.0.1 port 22:2: Too many authentication failures\nDisconnected from "
       "10.0.0.1");
  Fail(beta_, "ssh: Could not resolve hostname beta: Temporary failure in name resolution");
  SshHosts hosts(cluster_, 1);
  EXPECT_THAT(hosts.Queue("").error().message,
              AllOf(HasSubstr(alpha_ + " is out until `gauntlet resume`: Received disconnect"),
                    HasSubstr(beta_ + " does not answer: ssh: Could not resolve")));
  Fail(beta_, "me@beta: Permission denied (publickey).");
  EXPECT_EQ(hosts.Queue("").error().kind, ErrorKind::kNotFound) << "nobody is left";
  Mend(alpha_);
  Mend(beta_);
}

TEST_F(SshHostsTest, NobodyThereIsAnError) {
  Fail(alpha_, "ssh: connect to host alpha port 22: Connection refused");
  Fail(beta_, "ssh: connect to host beta port 22: No route to host");
  EXPECT_THAT(
      SshHosts(cluster_, 1).Queue("").error().message,
      AllOf(StartsWith("no host answers; " + alpha_ + " does not answer: "), HasSubstr("No route to host")));
  Mend(alpha_);
  Mend(beta_);
}

}  // namespace
}  // namespace gauntlet::slurm
