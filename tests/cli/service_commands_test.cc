#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::IsEmpty;

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
  EXPECT_EQ(
      err_.str(),
      "gauntlet: workers connect to tcp://10.0.0.7:5555, encrypted; start them with: gauntlet-worker --dir " +
          Path("c") +
          "\n"
          "gauntlet: 100 runs in 4.0 s (25.0/s; master 0 us of CPU per run)\n");
}

TEST_F(CommandLine, PlaintextIsSaidEvenWhenQuietAndOnLoopback) {
  campaigns_.during = [](const SessionOptions& options) {
    options.on_serving({{"tcp://10.0.0.7:5555"}, !options.insecure});
  };
  EXPECT_EQ(
      Run({"master", "flocking", "--bind", "tcp://0.0.0.0:*", "--insecure", "--quiet", "--dir", Path("c")}),
      kExitDone);
  EXPECT_EQ(err_.str(),
            "gauntlet: INSECURE: whoever reaches tcp://10.0.0.7:5555 can read this campaign and feed it "
            "results; nothing is encrypted or checked\n");
  EXPECT_EQ(Run({"master", "flocking", "--bind", "tcp://127.0.0.1:*", "--quiet", "--dir", Path("c")}),
            kExitDone);
  EXPECT_THAT(err_.str(), IsEmpty());
  EXPECT_EQ(
      Run({"master", "flocking", "--bind", "tcp://127.0.0.1:*", "--insecure", "--quiet", "--dir", Path("c")}),
      kExitDone);
  EXPECT_EQ(err_.str(),
            "gauntlet: INSECURE: whoever reaches tcp://10.0.0.7:5555 can read this campaign and feed it "
            "results; nothing is encrypted or checked\n");
  EXPECT_EQ(Run({"resume", "c", "--insecure", "--quiet"}), kExitDone);
  EXPECT_EQ(err_.str(),
            "gauntlet: INSECURE: whoever reaches tcp://10.0.0.7:5555 can read this campaign and feed it "
            "results; nothing is encrypted or checked\n");
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

TEST_F(CommandLine, MasterResumesOnlyWhenThereIsACampaignAndItIsAskedTo) {
  const std::vector<std::string> arguments = {"master", "flocking",          "--bind",  "tcp://127.0.0.1:*",
                                              "--dir",  directory_.string(), "--resume"};
  EXPECT_EQ(Run(arguments), kExitDone);
  EXPECT_EQ(std::pair(campaigns_.starts, campaigns_.resumes), std::pair(1, 0));
  Write("campaign.db", "");
  EXPECT_EQ(Run(arguments), kExitDone);
  EXPECT_EQ(std::pair(campaigns_.starts, campaigns_.resumes), std::pair(1, 1));
  EXPECT_EQ(Run({arguments.begin(), arguments.end() - 1}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: " + directory_.string() +
                            " holds a campaign already; go on with it by `gauntlet resume " +
                            directory_.string() + "`, or choose another directory\n");
  EXPECT_EQ(Run({"resume", "c", "--bind", "tcp://127.0.0.1:*"}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 0);
  EXPECT_EQ(Run({"resume", "c", "--bind", "tcp://127.0.0.1:*", "--workers", "3"}), kExitDone);
  EXPECT_EQ(campaigns_.workers, 3);
}

TEST_F(CommandLine, StatusShowsWhatRunsWhereAndWhyNothingDoes) {
  campaigns_.status =
      R"({"state": "running", "master": {"host": "n1", "pid": 7, "epoch": 2, "encrypted": true},
                "searches_in_words": "generation 3/50", "runs_done": 1234, "runs_running": 1, "runs_queued": 5,
                "runs_per_second": 12.5, "why_nothing_runs": null, "worker_list": [
                 {"worker": "ab@n2", "state": "running", "silent_seconds": 0.2,
                  "runs": [{"run": 812, "lease": "100000002", "attempt": 2, "state": "running", "seconds": 1.5},
                           {"run": 813, "lease": "100000003", "attempt": 1, "state": "waiting", "seconds": 1.5},
                           {"run": 814, "lease": "100000004", "attempt": 1, "state": "waiting", "seconds": 1.5},
                           {"run": 815, "lease": "100000005", "attempt": 1, "state": "waiting", "seconds": 1.5},
                           {"run": 1099511627791, "lease": "100000006", "attempt": 1, "state": "waiting",
                            "seconds": 1.5}]},
                 {"worker": "cd@n3", "state": "idle", "silent_seconds": 0.4, "runs": []}]})";
  EXPECT_EQ(Run({"status", "c"}), kExitDone);
  EXPECT_EQ(out_.str(),
            "c: running, master 7 on n1 (start number 2), encrypted\n"
            "generation 3/50, 1,234 runs done, 1 running, 5 waiting, 12.5/s\n"
            "\n"
            "  worker  state    heard  runs\n"
            "  ab@n2   running  0.2 s  812 (1.5 s, attempt 2), next 813 to 815, 2:15\n"
            "  cd@n3   idle     0.4 s  -\n");
  EXPECT_EQ(Run({"status", "c", "--json"}), kExitDone);
  EXPECT_EQ(nlohmann::ordered_json::parse(out_.str()), nlohmann::ordered_json::parse(campaigns_.status));
  campaigns_.status =
      R"({"state": "stopped", "master": null, "why_nothing_runs": "no master serves the campaign",
                "worker_list": []})";
  EXPECT_EQ(Run({"watch", "c"}), kExitDone) << "without a master it ends at once";
  EXPECT_EQ(out_.str(),
            "c: stopped\n"
            "nothing runs: no master serves the campaign\n");
}

TEST_F(CommandLine, StopAsksAndWaitsForTheMasterToEnd) {
  EXPECT_EQ(Run({"stop", "c"}), kExitDone);
  EXPECT_EQ(err_.str(), "gauntlet: no master serves c: there is nothing to stop\n");
  EXPECT_EQ(campaigns_.stopped, "");
  campaigns_.lives = 3;
  EXPECT_EQ(Run({"stop", "c"}), kExitDone);
  EXPECT_EQ(campaigns_.stopped, "c");
  EXPECT_EQ(err_.str(),
            "gauntlet: the master lets the runs that have begun end, then stops (Ctrl-C: wait no longer)\n"
            "gauntlet: stopped\n");
}

}  // namespace
}  // namespace gauntlet
