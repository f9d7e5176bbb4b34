// Every command of docs/any-simulator.md, and programs that do not behave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/documented_page.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

TEST(AnySimulatorPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  const TemporaryDirectory scratch;
  fs::create_directories(scratch / "examples");
  fs::copy(GAUNTLET_SOURCE_DIR "/examples/any-simulator", scratch / "examples/any-simulator");
  const DocumentedPage page = ReadPage("any-simulator.md");
  EXPECT_GE(page.commands.size(), 6U);
  const ProcessResult result = RunCommands(page, scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  ExpectQuoted(page, AsRead(result.out, scratch.path()));
}

class ProgramTest : public testing::Test {
 protected:
  // An experiment whose program is this shell script; `more` follows in [command].
  void Program(const std::string& script, const std::string& more = "") {
    std::ofstream(scratch_ / "sim.sh") << "#!/bin/sh\n" << script;
    chmod((scratch_ / "sim.sh").c_str(), 0755);
    std::ofstream(scratch_ / "my.toml") << "scenario = \"command\"\n[command]\n"
                                           "run = [\"./sim.sh\", \"{case}\", \"{out}\", \"{seed}\"]\n"
                                           "files = [\"sim.sh\"]\nmetrics = [\"items\"]\n"
                                           "fitness = \"items\"\nfailure = \"items < 3\"\nwall_limit = 20\n"
                                        << more;
  }
  ProcessResult Evolve(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {
        "evolve", scratch_ / "my.toml", "--dir", scratch_ / "c", "--quiet", "--generations",
        "2",      "--population",       "6",     "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Gauntlet(arguments);
  }

  TemporaryDirectory scratch_;
};

TEST_F(ProgramTest, ARandomOneIsCalledSoAndNobodyIsBlamed) {
  Program("echo \"{\\\"items\\\": $(date +1%N)}\"\n");
  const ProcessResult result = Evolve({"--workers", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, Not(HasSubstr("quarantine")));
  const auto shown = nlohmann::json::parse(Gauntlet({"show", scratch_ / "c", "--json"}).out);
  EXPECT_EQ(shown.at("reproducible"), "no");
  EXPECT_TRUE(shown.at("finished"));
}

TEST_F(ProgramTest, OneThatFollowsItsSeedIsReproducible) {
  Program("echo \"{\\\"items\\\": $(($3 % 7))}\"\n");
  ASSERT_EQ(Evolve().exit_code, 0);
  const auto shown = nlohmann::json::parse(Gauntlet({"show", scratch_ / "c", "--json"}).out);
  EXPECT_EQ(shown.at("reproducible"), "yes");
  const ProcessResult replayed = Gauntlet({"replay", scratch_ / "c", "3"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err << replayed.out;
  EXPECT_THAT(replayed.err, HasSubstr("gauntlet: its runs start ./sim.sh"));
}

// What is wrong is told before a campaign is made.
TEST_F(ProgramTest, ThatCannotWorkIsToldBeforeAnythingIsMade) {
  struct Wrong {
    std::string script;
    std::string more;
    std::string said;
  };
  const std::vector<Wrong> all = {
      {"exit 1\n", "", "exit code 1"},
      {"echo nothing\n", "", "neither written out.json"},
      {"echo '{\"items\": \"many\"}'\n", "", "'items' = \"many\" is no finite number"},
      {"echo '{\"items\": NaN}'\n", "", "nor printed a line that is a JSON object"},
      {"kill -SEGV $$\n", "", "signal 11"},
      {"echo cannot place; exit 1\n", "[[command.refused]]\npattern = \"cannot place\"\n",
       "the program refuses this case: cannot place"},
      {"", "probe = [\"false\"]\n", "the command's probe ended with exit code 1"},
      {"", "setup = \"exit 3\"\n", "setup"},
  };
  for (const Wrong& wrong : all) {
    Program(wrong.script, wrong.more);
    const ProcessResult result = Evolve();
    EXPECT_EQ(result.exit_code, 2) << wrong.said;
    EXPECT_THAT(result.err, HasSubstr(wrong.said));
    EXPECT_FALSE(fs::exists(scratch_ / "c")) << wrong.said;
  }
}

TEST_F(ProgramTest, ThatIsMissingOrNoProgramIsNamed) {
  Program("");
  for (const auto& [run, said] :
       {std::pair("no-such-program", "no-such-program"), {"./data.txt", "data.txt"}}) {
    std::ofstream(scratch_ / "data.txt") << "data";
    std::ofstream(scratch_ / "my.toml") << "scenario = \"command\"\n[command]\nrun = [\"" << run
                                        << "\"]\nfiles = [\"data.txt\"]\nmetrics = [\"items\"]\n"
                                           "fitness = \"items\"\nfailure = \"items < 3\"\n";
    const ProcessResult result = Evolve();
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(said));
  }
}

TEST_F(ProgramTest, WhatMeansNothingHereIsRefusedByName) {
  Program("echo '{\"items\": 1}'\n");
  for (const char* set : {"noise.proximity.gaussian=0.1", "faults=1:wheels@5", "physics=box2d",
                          "genome.moving=0.5", "genome.lights=1"}) {
    const ProcessResult result = Evolve({"--set", set});
    EXPECT_EQ(result.exit_code, 2) << set;
    EXPECT_THAT(result.err, HasSubstr(std::string(set).substr(0, std::string(set).find('='))));
  }
}

// A campaign keeps its program; a mended one is held against what the first has left.
TEST_F(ProgramTest, ACorpusIsCheckedWithAMendedProgram) {
  Program("echo \"{\\\"items\\\": $(($(grep -c length \"$1\") > 0 ? 0 : 9))}\"\n");
  ASSERT_EQ(Evolve().exit_code, 0);
  const std::string campaign = scratch_ / "c";
  ASSERT_EQ(Gauntlet({"minimise", campaign, "1", "--quiet"}).exit_code, 0);
  const ProcessResult kept = Gauntlet({"corpus", "add", campaign, "1", "--to", scratch_ / "corpus"});
  ASSERT_EQ(kept.exit_code, 0) << kept.err;
  EXPECT_THAT(kept.out, HasSubstr(".command"));
  const auto verdict = [&] {
    const ProcessResult checked =
        Gauntlet({"check", scratch_ / "corpus", "--plugin", scratch_ / "my.toml", "--json"});
    return nlohmann::json::parse(checked.out).at("cases").at(0).at("verdict").get<std::string>();
  };
  EXPECT_EQ(verdict(), "fail");
  Program("echo '{\"items\": 9}'\n");
  EXPECT_EQ(verdict(), "pass");
}

}  // namespace
}  // namespace gauntlet::testing_support
