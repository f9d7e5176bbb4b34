#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST_F(CommandLine, MasterStartsNoWorkersAndSaysWhereTheyConnect) {
  std::string bind;
  bool insecure = true;
  campaigns_.during = [&](const SessionOptions& options) {
    bind = options.bind;
    insecure = options.insecure;
    options.on_serving({{"tcp://10.0.0.7:5555"}, true});
  };
  EXPECT_EQ(Run({"master", "flocking", "--bind", "tcp://0.0.0.0:5555", "--dir", Path("c")}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 0);
  EXPECT_EQ(bind, "tcp://0.0.0.0:5555");
  EXPECT_FALSE(insecure);
  EXPECT_THAT(err_.str(), HasSubstr("workers connect to tcp://10.0.0.7:5555, encrypted; start them with: "
                                    "gauntlet-worker --dir " +
                                    Path("c")));
  EXPECT_THAT(err_.str(), Not(HasSubstr("INSECURE")));
}

TEST_F(CommandLine, PlaintextIsSaidEvenWhenQuietAndOnLoopback) {
  campaigns_.during = [](const SessionOptions& options) {
    options.on_serving({{"tcp://10.0.0.7:5555"}, !options.insecure});
  };
  EXPECT_EQ(
      Run({"master", "flocking", "--bind", "tcp://0.0.0.0:*", "--insecure", "--quiet", "--dir", Path("c")}),
      kExitDone);
  EXPECT_THAT(err_.str(), HasSubstr("INSECURE: whoever reaches tcp://10.0.0.7:5555"));
  EXPECT_EQ(Run({"master", "flocking", "--bind", "tcp://127.0.0.1:*", "--quiet", "--dir", Path("c")}),
            kExitDone);
  EXPECT_THAT(err_.str(), IsEmpty());
  EXPECT_EQ(
      Run({"master", "flocking", "--bind", "tcp://127.0.0.1:*", "--insecure", "--quiet", "--dir", Path("c")}),
      kExitDone);
  EXPECT_THAT(err_.str(), HasSubstr("INSECURE"));
  EXPECT_EQ(Run({"resume", "c", "--insecure", "--quiet"}), kExitDone);
  EXPECT_THAT(err_.str(), HasSubstr("INSECURE"));
}

TEST_F(CommandLine, PlaintextIsSaidInRedOnATerminal) {
  campaigns_.during = [](const SessionOptions& options) {
    options.on_serving({{"tcp://10.0.0.7:5555"}, false});
  };
  err_is_terminal_ = true;
  EXPECT_EQ(
      Run({"master", "flocking", "--bind", "tcp://0.0.0.0:*", "--insecure", "--quiet", "--dir", Path("c")}),
      kExitDone);
  EXPECT_THAT(err_.str(), testing::ContainsRegex("^\x1b\\[1;31mgauntlet: INSECURE: [^\x1b]*\x1b\\[0m$"));
}

TEST_F(CommandLine, AnAddressThatNobodyCouldConnectToIsRefusedBeforeAnythingBegins) {
  for (const char* bad : {"tcp://127.0.0.1:99999", "tcp://127.0.0.1:-1", "tcp://localhost:*", "tcp://[::1]:*",
                          "tcp://nohost.invalid:*", "inproc://x"}) {
    EXPECT_EQ(Run({"master", "flocking", "--bind", bad, "--dir", Path("c")}), kExitUsage);
    EXPECT_THAT(err_.str(), AllOf(HasSubstr(bad), HasSubstr("it must be tcp://ADDRESS:PORT")));
    EXPECT_EQ(Run({"resume", directory_.string(), "--bind", bad}), kExitUsage);
    EXPECT_THAT(err_.str(), AllOf(HasSubstr(bad), HasSubstr("it must be tcp://ADDRESS:PORT")));
  }
  EXPECT_EQ(std::pair(campaigns_.starts, campaigns_.resumes), std::pair(0, 0));
}

TEST_F(CommandLine, MasterResumesOnlyWhenThereIsACampaignAndItIsAskedTo) {
  const std::vector<std::string> arguments = {"master", "flocking",          "--bind",  "tcp://127.0.0.1:*",
                                              "--dir",  directory_.string(), "--resume"};
  EXPECT_EQ(Run(arguments), kExitDone);
  EXPECT_EQ(std::pair(campaigns_.starts, campaigns_.resumes), std::pair(1, 0));
  Write("campaign.db", "");
  EXPECT_EQ(Run(arguments), kExitDone);
  EXPECT_EQ(std::pair(campaigns_.starts, campaigns_.resumes), std::pair(1, 1));
  EXPECT_EQ(Run({arguments.begin(), arguments.end() - 1}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("gauntlet resume"));
  EXPECT_EQ(Run({"resume", "c", "--bind", "tcp://127.0.0.1:*"}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 0);
  EXPECT_EQ(Run({"resume", "c", "--bind", "tcp://127.0.0.1:*", "--workers", "3"}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 3);
}

TEST_F(CommandLine, MasterNeedsAnEndpoint) {
  ExpectUsageError({"master", "flocking"}, HasSubstr("--bind"));
  ExpectUsageError({"master", "flocking", "--bind", "tcp://127.0.0.1:*", "--resume"}, HasSubstr("--dir"));
}

TEST_F(CommandLine, StatusShowsWhatRunsWhereAndWhyNothingDoes) {
  campaigns_.status =
      R"({"state": "running", "master": {"host": "n1", "pid": 7, "epoch": 2, "encrypted": true},
                "generation": 3, "generations": 50, "runs_done": 1234, "runs_running": 1, "runs_queued": 5,
                "runs_per_second": 12.5, "why_nothing_runs": null, "worker_list": [
                 {"worker": "ab@n2", "state": "running", "silent_seconds": 0.2,
                  "runs": [{"run": 812, "lease": "100000002", "attempt": 2, "state": "running", "seconds": 1.5},
                           {"run": 813, "lease": "100000003", "attempt": 1, "state": "waiting", "seconds": 1.5}]},
                 {"worker": "cd@n3", "state": "idle", "silent_seconds": 0.4, "runs": []}]})";
  EXPECT_EQ(Run({"status", "c"}), kExitDone);
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("master 7 on n1 (start number 2), encrypted"),
                                HasSubstr("generation 3/50, 1,234 runs done, 1 running, 5 waiting"),
                                HasSubstr("812 (1.5 s, attempt 2), 813 (next)"), HasSubstr("idle")));
  EXPECT_EQ(Run({"status", "c", "--json"}), kExitDone);
  EXPECT_EQ(out_.str(), campaigns_.status);
  campaigns_.status =
      R"({"state": "stopped", "master": null, "why_nothing_runs": "no master serves the campaign",
                "worker_list": []})";
  EXPECT_EQ(Run({"watch", "c"}), kExitDone) << "without a master it ends at once";
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("c: stopped"), HasSubstr("nothing runs: no master serves")));
}

TEST_F(CommandLine, StopAsksAndWaitsForTheMasterToEnd) {
  EXPECT_EQ(Run({"stop", "c"}), kExitDone);
  EXPECT_THAT(err_.str(), HasSubstr("nothing to stop"));
  EXPECT_EQ(campaigns_.stopped, "");
  campaigns_.lives = 3;
  EXPECT_EQ(Run({"stop", "c"}), kExitDone);
  EXPECT_EQ(campaigns_.stopped, "c");
  EXPECT_THAT(err_.str(), HasSubstr("stopped"));
}

}  // namespace
}  // namespace gauntlet
