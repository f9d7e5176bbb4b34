// A study as a person runs it: searches, re-simulations and the report by one command, killed on the way.
// Covers: cli/commands/study_command.cc, cli/study_run.cc, study/study_analysis.cc, study/study_campaigns.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;

constexpr const char* kSmallStudy = R"(
name = "small"
description = "two evolutions against random cases"
published = "small.csv"

[part.evolved]
kind = "evolve"
experiment = "flocking"
seeds = "1..2"
set.search.population = 6
set.search.generations = 4
[part.random]
kind = "random"
experiment = "flocking"
cases = 40
[part.empty]
kind = "empty"
experiment = "flocking"
replicates = 3
[part.again]
kind = "evaluate"
from = "evolved"
[part.improved]
kind = "evaluate"
from = "evolved"
set.controller = "flocking-improved"
[part.worst]
kind = "evaluate"
from = "random:worst:10"

[compare.severity]
title = "evolved against random"
first = "again"
second = "random:all"
expect = "less"
[compare.removal]
title = "original against improved"
first = "again"
second = "improved"
[count.failures]
title = "total failures"
first = "worst"
second = "empty"
what = "failures"
metric = "total_failure"
at_least = 1
expect = "greater"
[types.types]
title = "types"
first = "again"
second = "random"
[peak.peak]
title = "types by generation"
part = "evolved"

[note.why]
text = "the thesis has a hundred"
)";

constexpr const char* kPublished =
    "section,quantity,condition,value,figure,rule,note\n"
    "1.1,generated / compared / evaluations,evolved,12 / 12 / 48,severity.first.budget,same,\n"
    "1.2,compared,evolved,100,severity.first.n,between 100 100,why\n"
    "1.3,robots,an example,6,,,\n";

class StudyTest : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(scratch_ / "small.toml") << kSmallStudy;
    std::ofstream(scratch_ / "small.csv") << kPublished;
  }
  std::vector<std::string> Command(const std::string& dir) const {
    return {"study", scratch_ / "small.toml", "--dir", scratch_ / dir, "--json", "--quiet", "--workers", "2"};
  }
  // The report without what depends on the clock and the directory.
  static json Timeless(const std::string& text) {
    json report = json::parse(text, nullptr, false);
    for (const char* key : {"search_seconds", "evaluation_seconds", "directory"}) report.erase(key);
    for (json& part : report["parts"]) {
      EXPECT_GT(part["cpu_seconds"].get<double>(), 0.0);
      part.erase("cpu_seconds");
    }
    return report;
  }
  TemporaryDirectory scratch_;
};

TEST_F(StudyTest, HoldsPublishedFiguresAgainstItsOwn) {
  const ProcessResult run = Gauntlet(Command("s"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  const json& results = report["results"];
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0]["verdict"], "agrees");
  EXPECT_EQ(results[0]["ours"], "12 / 12 / 48");
  EXPECT_EQ(results[1]["verdict"], "differs");
  EXPECT_EQ(results[1]["note"], "the thesis has a hundred");
  EXPECT_EQ(results[2]["verdict"], "not computed");
  EXPECT_EQ(report["claims"].size(), 2U);
  const json& figures = report["figures"];
  EXPECT_EQ(figures["severity.second.n"], 40);
  EXPECT_EQ(figures["failures.first.of"], 10);
  EXPECT_EQ(figures["failures.second.of"], 3);
  EXPECT_EQ(figures["removal.second.n"], 12);

  // Its campaigns are campaigns: compare finds what the study has found.
  const std::string again = scratch_ / "s/evaluations";
  const ProcessResult compared = Gauntlet({"compare", again + ":search:1," + again + ":search:2",
                                           (scratch_ / "s/searches") + ":search:3", "--json"});
  ASSERT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_EQ(json::parse(compared.out)["a"], figures["severity.a"]);
  EXPECT_EQ(Gauntlet({"replay", again, "1"}).exit_code, 0);

  const ProcessResult resumed = Gauntlet({"resume", scratch_ / "s", "--json", "--quiet"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(resumed.out, run.out);
  const ProcessResult page = Gauntlet({"study", scratch_ / "small.toml", "--dir", scratch_ / "s",
                                       "--markdown", scratch_ / "page.md", "--quiet"});
  EXPECT_EQ(page.exit_code, 0) << page.err;
}

TEST_F(StudyTest, EndsTheSameWhateverMomentItIsKilledAt) {
  const ProcessResult whole = Gauntlet(Command("whole"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  sim::RandomStream random(23, sim::StreamPurpose::kTest);
  for (int kill = 0; kill < 6; ++kill) {
    const std::unique_ptr<Process> study = StartGauntlet(Command("killed"));
    Eventually([&] { return !study->Running(); }, RandomTime(random, std::chrono::milliseconds(900)));
    study->Signal(SIGKILL);
    study->Wait();
  }
  const ProcessResult last = Gauntlet(Command("killed"));
  ASSERT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(Timeless(last.out), Timeless(whole.out));
}

TEST_F(StudyTest, KeepsToItsDirectory) {
  ASSERT_EQ(Gauntlet(Command("s")).exit_code, 0);
  std::ofstream(scratch_ / "small.csv", std::ios::app) << "1.4,more,of,7,severity.first.n,,\n";
  const ProcessResult more = Gauntlet(Command("s"));
  EXPECT_EQ(more.exit_code, 0) << more.err;
  EXPECT_EQ(json::parse(more.out)["results"].size(), 4U) << "what is computed may change";
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = kSmallStudy;
    text.replace(text.find(from), from.size(), to);
    std::ofstream(scratch_ / "small.toml") << text;
    const ProcessResult result = Gauntlet(Command("s"));
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_EQ(refused("generations = 4", "generations = 5"),
            "gauntlet: " + (scratch_ / "s/searches") +
                " was begun with other parts or settings than the study has now: name another --dir\n");
  EXPECT_EQ(refused("worst:10", "worst:11"),
            "gauntlet: " + (scratch_ / "s/evaluations") +
                " was begun with other parts or settings than the study has now: name another --dir\n");
  EXPECT_EQ(refused("name = \"small\"", "name = \"other\""),
            "gauntlet: " + (scratch_ / "s") + " holds the study 'small': name another --dir\n");
  const ProcessResult stop = Gauntlet({"stop", scratch_ / "s"});
  EXPECT_EQ(stop.exit_code, 0);
  EXPECT_EQ(stop.err,
            "gauntlet: no master serves " + (scratch_ / "s/evaluations") + ": there is nothing to stop\n");
  const ProcessResult unsubmitted = Gauntlet({"study", scratch_ / "small.toml", "--slurm", "partition=x"});
  EXPECT_EQ(unsubmitted.exit_code, 2);
  EXPECT_EQ(unsubmitted.err, "gauntlet: --master and --slurm are for --submit\n");
  const std::string none = scratch_ / "none.toml";
  EXPECT_EQ(
      Gauntlet({"study", scratch_ / "small.toml", "--submit", "--dry-run", "--slurm", "cluster=" + none}).err,
      "gauntlet: cluster = " + none + ": cannot open " + none + ": No such file or directory\n");
  EXPECT_EQ(Gauntlet({"show", scratch_ / "s"}).err,
            "gauntlet: " + (scratch_ / "s") + " holds a study: its campaigns are " +
                (scratch_ / "s/searches") + " and " + (scratch_ / "s/evaluations") +
                ", its report is given by 'gauntlet resume " + (scratch_ / "s") + "'\n");
  std::filesystem::create_directories(scratch_ / "full/of-things");
  const ProcessResult full = Gauntlet(Command("full"));
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_EQ(full.err, "gauntlet: " + (scratch_ / "full") +
                          " holds no study, but of-things: name a directory that is new or empty\n");
  const ProcessResult longer = Gauntlet({"resume", scratch_ / "s", "--generations", "9"});
  EXPECT_EQ(longer.exit_code, 2);
  EXPECT_EQ(longer.err, "gauntlet: " + (scratch_ / "s") +
                            " holds a study: its file says how long its searches are, and its workers are of "
                            "this machine or of a cluster\n");
}

TEST_F(StudyTest, ADryRunMakesNothing) {
  std::vector<std::string> command = Command("s");
  command.emplace_back("--dry-run");
  const ProcessResult dry = Gauntlet(command);
  ASSERT_EQ(dry.exit_code, 0) << dry.err;
  const json forecast = json::parse(dry.out);
  EXPECT_EQ(forecast["runs"], 2 * 24 + 40 + 3 + 12 + 12 + 10);
  EXPECT_GT(forecast["seconds"].get<double>(), 0.0);
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "s"));
}

}  // namespace
}  // namespace gauntlet::testing_support
