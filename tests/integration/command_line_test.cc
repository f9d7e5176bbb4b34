// The command line as scripts rely on it: exit codes, one JSON document on stdout, replay, evaluate.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/integration/campaign_database.h"
#include "tests/integration/campaign_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::HasSubstr;

void WriteFile(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

// One finished campaign for all tests that only read.
class FinishedCampaignTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryDirectory;
    ASSERT_EQ(Gauntlet(EvolveArguments(SmallCampaign{}, Dir(), 2)).exit_code, 0);
  }
  static void TearDownTestSuite() { delete scratch_; }
  static std::string Dir() { return *scratch_ / "c"; }

  static TemporaryDirectory* scratch_;
};
TemporaryDirectory* FinishedCampaignTest::scratch_ = nullptr;

TEST_F(FinishedCampaignTest, ShowAccountsForEveryRun) {
  const json shown = Show(Dir());
  EXPECT_EQ(shown["experiment"], "flocking");
  EXPECT_EQ(shown["seed"], "7");
  EXPECT_EQ(shown["runs_done"], 8 * 4);
  EXPECT_EQ(shown["runs_failed"], 0);
  EXPECT_EQ(shown["generation"], 4);
  EXPECT_TRUE(shown["finished"].get<bool>());
  ASSERT_EQ(shown["population"].size(), 8u);
  double sum = 0.0;
  double best = 10.0;
  for (const json& member : shown["population"]) {
    EXPECT_EQ(member["genome"].size(), 8u);
    EXPECT_FALSE(member["runs"].empty());
    sum += member["fitness"].get<double>();
    best = std::min(best, member["fitness"].get<double>());
  }
  EXPECT_NEAR(shown["mean_fitness"].get<double>(), sum / 8, 1e-12);
  EXPECT_EQ(shown["best_fitness"].get<double>(), best);
}

// F/F and I/F of the thesis: a population against two controllers.
TEST_F(FinishedCampaignTest, EvaluateSimulatesAPopulationAgainWithFreshSeedsAndCompareReadsIt) {
  const std::string original = *scratch_ / "f-f";
  const std::string improved = *scratch_ / "i-f";
  const ProcessResult first = Gauntlet({"evaluate", "flocking", "--from", Dir() + "," + Dir() + ":final",
                                        "--dir", original, "--json", "--quiet"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const json cases = json::parse(first.out)["cases"];
  ASSERT_EQ(cases.size(), 2 * 8U);
  std::set<std::string> seeds;
  for (const json& one : cases) seeds.insert(one["runs"][0]["seed"].get<std::string>());
  EXPECT_EQ(seeds.size(), cases.size()) << "also of cases that are the same";
  for (const std::string& seed : Query(Dir(), "SELECT seed FROM runs")) EXPECT_FALSE(seeds.contains(seed));
  ASSERT_EQ(Gauntlet({"evaluate", "flocking", "--from", Dir(), "--set", "controller=flocking-improved",
                      "--dir", improved, "--quiet"})
                .exit_code,
            0);
  const ProcessResult compared = Gauntlet({"compare", original, improved, "--json"});
  ASSERT_EQ(compared.exit_code, 0) << compared.err;
  const json comparison = json::parse(compared.out);
  EXPECT_EQ(comparison["n1"], 16);
  EXPECT_EQ(comparison["n2"], 8);
  EXPECT_EQ(comparison["sets"][0]["unit"], "evolution");
  EXPECT_EQ(comparison["sets"][0]["units"], 2);
  EXPECT_EQ(Gauntlet({"replay", improved, "1"}).exit_code, 0);
  EXPECT_EQ(Gauntlet({"resume", original}).err,
            "gauntlet: " + (*scratch_ / "f-f") + " is finished, nothing was left to do\n");
}

TEST_F(FinishedCampaignTest, CompareReadsSubsetsOfCampaigns) {
  const ProcessResult result =
      Gauntlet({"compare", Dir(), Dir() + ":all", "--metric", "birds_left", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json comparison = json::parse(result.out);
  EXPECT_EQ(comparison["n1"], 8);
  EXPECT_EQ(comparison["n2"], 8 * 4);
  EXPECT_EQ(comparison["sets"][0]["unit"], "evolution");
  EXPECT_EQ(comparison["notes"], json::array());

  const std::string other = *scratch_ / "other";
  ASSERT_EQ(Gauntlet({"random", "foraging", "--cases", "2", "--set", "scenario_parameters.time_limit=10",
                      "--dir", other, "--quiet"})
                .exit_code,
            0);
  const ProcessResult refused = Gauntlet({"compare", Dir(), other});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_EQ(refused.err, "gauntlet: scenario: " + (*scratch_ / "c") + " has flocking, " +
                             (*scratch_ / "other") +
                             " has foraging: not like for like; --mixed compares them nevertheless\n");
  const ProcessResult mixed = Gauntlet({"compare", Dir(), other, "--mixed", "--json"});
  ASSERT_EQ(mixed.exit_code, 0) << mixed.err;
  EXPECT_EQ(json::parse(mixed.out)["notes"].dump(), "[\"not like for like: scenario: " + (*scratch_ / "c") +
                                                        " has flocking, " + (*scratch_ / "other") +
                                                        " has foraging\"]");
}

TEST_F(FinishedCampaignTest, EveryStoredRunReproducesItsHash) {
  for (int run = 1; run <= 32; run += 5) {
    const ProcessResult replayed = Gauntlet({"replay", Dir(), std::to_string(run)});
    EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  }
}

TEST_F(FinishedCampaignTest, ReplayDrawsTheRun) {
  const std::string svg = *scratch_ / "run.svg";
  const std::string csv = *scratch_ / "run.csv";
  ASSERT_EQ(Gauntlet({"replay", Dir(), "1", "--svg", svg, "--csv", csv}).exit_code, 0);
  std::ifstream svg_file(svg);
  std::string text((std::istreambuf_iterator<char>(svg_file)), {});
  std::ifstream csv_file(csv);
  std::string header;
  std::getline(csv_file, header);
  EXPECT_EQ(header, "tick,time_s,robot,x,y,heading,speed");
}

TEST(CommandLineTest, RandomKeepsAllCases) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  const ProcessResult result =
      Gauntlet({"random", "flocking", "--cases", "12", "--dir", dir, "--workers", "2", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json shown = Show(dir);
  EXPECT_EQ(shown["population"].size(), 12u);
  EXPECT_EQ(shown["runs_done"], 12);
}

TEST(CommandLineTest, AProcessorWithoutTheInstructionsGetsASentence) {
  const std::string old = "exec qemu-x86_64 -cpu core2duo \"$0\" --version";
  if (RunProcess({"/bin/sh", "-c", "command -v qemu-x86_64"}).exit_code != 0) {
    GTEST_SKIP() << "there is no qemu-x86_64 (Debian: qemu-user) to be an old processor";
  }
  for (const std::string& program : {testing_support::GauntletPath(), testing_support::WorkerPath()}) {
    const ProcessResult result = RunProcess({"/bin/sh", "-c", old, program});
    EXPECT_EQ(result.exit_code, 2) << program;
    EXPECT_THAT(result.err, HasSubstr("this processor lacks instructions"));
  }
}

TEST(EvaluateTest, SimulatesValidCasesAndRefusesTheOthersByRule) {
  const TemporaryDirectory scratch;
  WriteFile(
      scratch / "open.json",
      R"({"name": "open", "obstacles": [{"x": 0.5, "y": -1, "length": 1, "width": 0.2, "orientationDeg": 30}]})");
  WriteFile(scratch / "closed.json",
            R"({"name": "closed", "obstacles": [{"length": 9, "width": 0.3, "orientationDeg": 135}]})");
  WriteFile(scratch / "broken.json", "{\"name\": \"broken\",\n  \"obstacles\": [{\"x\": }]}");
  const ProcessResult result = Gauntlet(
      {"evaluate", "flocking", "--case", scratch / "open.json", "--case", scratch / "closed.json", "--case",
       scratch / "broken.json", "--replicates", "3", "--json", "--dir", scratch / "c", "--workers", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json document = json::parse(result.out, nullptr, false);
  ASSERT_FALSE(document.is_discarded()) << result.out;
  ASSERT_EQ(document["cases"].size(), 3u);
  const json& open = document["cases"][0];
  EXPECT_TRUE(open["refused"].is_null());
  ASSERT_EQ(open["runs"].size(), 3u);
  EXPECT_NE(open["runs"][0]["seed"], open["runs"][1]["seed"]);
  EXPECT_GE(open["fitness"].get<double>(), 0.0);
  EXPECT_EQ(document["cases"][1]["refused"], "no-path");
  EXPECT_TRUE(document["cases"][1]["fitness"].is_null());
  EXPECT_EQ(document["cases"][2]["error"].get<std::string>(),
            (scratch / "broken.json") + ":2:23: unexpected '}'; expected '[', '{', or a literal");
}

TEST(EvaluateTest, ExitsWith2WhenEveryCaseIsRefused) {
  const TemporaryDirectory scratch;
  WriteFile(scratch / "closed.json",
            R"({"obstacles": [{"length": 9, "width": 0.3, "orientationDeg": 135}]})");
  const ProcessResult result = Gauntlet({"evaluate", "flocking", "--case", scratch / "closed.json", "--json",
                                         "--dir", scratch / "c", "--workers", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(json::parse(result.out, nullptr, false)["cases"][0]["refused"], "no-path");
}

// Files of the thesis' author (released with the thesis; not part of this repository).
TEST(EvaluateTest, RealArgosFilesAreSimulatedOrRefusedByRule) {
  const char* given = std::getenv("GAUNTLET_ARGOS_CASES");
  const std::string folder =
      given != nullptr ? given : std::string(GAUNTLET_SOURCE_DIR) + "/../shared/data/argos-cases";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "the author's .argos files are not here (set GAUNTLET_ARGOS_CASES to their folder)";
  }
  const TemporaryDirectory scratch;
  std::vector<std::string> arguments = {"evaluate",    "flocking",  "--json", "--dir",
                                        scratch / "c", "--workers", "2"};
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".argos") continue;
    arguments.insert(arguments.end(), {"--case", entry.path().string()});
    ++files;
  }
  const ProcessResult result = Gauntlet(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json document = json::parse(result.out, nullptr, false);
  ASSERT_EQ(document["cases"].size(), files);
  int simulated = 0;
  for (const json& one : document["cases"]) {
    if (one["refused"].is_null()) {
      EXPECT_TRUE(one["error"].is_null()) << one;
      EXPECT_TRUE(one["fitness"].is_number()) << one;
      ++simulated;
    } else {
      EXPECT_THAT(one["refused"].get<std::string>(),
                  testing::AnyOf("start-blocked", "goal-blocked", "no-path", "contained-obstacle",
                                 "no-room-to-spawn"));
    }
  }
  fmt::print("{} of {} files simulated, {} refused\n", simulated, files,
             files - static_cast<std::size_t>(simulated));
  EXPECT_GT(simulated, 0);
}

// The result hashes of each file's runs, by the file.
std::map<std::string, std::vector<std::string>> HashesByFile(const std::vector<std::string>& files,
                                                             const std::string& dir) {
  std::vector<std::string> arguments = {"evaluate", "flocking", "--replicates", "2", "--json",
                                        "--dir",    dir,        "--case"};
  arguments.insert(arguments.end(), files.begin(), files.end());
  const ProcessResult result = Gauntlet(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::map<std::string, std::vector<std::string>> hashes;
  const json document = json::parse(result.out, nullptr, false);
  for (const json& one : document["cases"]) {
    for (const json& run : one["runs"]) hashes[one["file"]].push_back(run["hash"]);
  }
  return hashes;
}

TEST(EvaluateTest, WhatACaseGivesDoesNotDependOnItsPlaceInTheList) {
  const TemporaryDirectory scratch;
  std::vector<std::string> files;
  for (const double x : {-1.0, 0.0, 1.0}) {
    files.push_back(scratch / fmt::format("wall{}.json", files.size()));
    WriteFile(files.back(),
              fmt::format(R"({{"obstacles": [{{"x": {}, "y": 0.5, "length": 1, "width": 0.2}}]}})", x));
  }
  const auto together = HashesByFile(files, scratch / "together");
  EXPECT_EQ(together.size(), 3U);
  EXPECT_EQ(HashesByFile({files[2], files[0], files[1]}, scratch / "turned"), together);
  EXPECT_EQ(HashesByFile({files[1]}, scratch / "alone").at(files[1]), together.at(files[1]));
  EXPECT_NE(together.at(files[0])[0], together.at(files[0])[1]) << "replicates have seeds of their own";
  EXPECT_THAT(Gauntlet({"show", scratch / "together"}).out,
              testing::AllOf(HasSubstr("wall0.json"), HasSubstr("wall1.json"), HasSubstr("wall2.json")));
}

TEST(CommandLineTest, NextCommandsCanBePastedAsTheyStand) {
  const TemporaryDirectory scratch;
  const std::string program = scratch / "my tools/gauntlet";
  std::filesystem::create_directory(scratch / "my tools");
  std::filesystem::create_symlink(GauntletPath(), program);
  const std::string dir = scratch / "it's 50% done";
  SmallCampaign small;
  small.generations = 1;
  small.population = 4;
  std::vector<std::string> arguments = EvolveArguments(small, dir, 1);
  arguments.insert(arguments.begin(), program);
  const ProcessResult evolved = RunProcess(arguments);
  ASSERT_EQ(evolved.exit_code, 0) << evolved.err;
  std::istringstream lines(evolved.out.substr(evolved.out.find("Next commands to try\n")));
  int commands = 0;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    const ProcessResult pasted =
        RunProcess({"/bin/sh", "-c", fmt::format("cd '{}' && {}", scratch / "my tools", line)});
    EXPECT_EQ(pasted.exit_code, 0) << line << "\n" << pasted.err;
    ++commands;
  }
  EXPECT_EQ(commands, 3);
}

TEST(CommandLineTest, ATreeThatWasMovedHasItsOwnExperiments) {
  namespace fs = std::filesystem;
  const TemporaryDirectory scratch;
  const fs::path programs = fs::path(scratch / "1/2/3/4/5/6");
  const fs::path experiments =
      (programs / fs::relative(fs::path(GAUNTLET_SOURCE_DIR) / "experiments", GAUNTLET_BINARY_DIR))
          .lexically_normal();
  fs::create_directories(programs);
  fs::create_directories(experiments);
  fs::copy_file(GauntletPath(), programs / "gauntlet");
  fs::copy_file(fs::path(GAUNTLET_SOURCE_DIR) / "experiments/flocking.toml", experiments / "mine.toml");
  const ProcessResult listed =
      RunProcess({(programs / "gauntlet").string(), "list", "experiments", "--json"});
  ASSERT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out, testing::AllOf(HasSubstr("mine"), testing::Not(HasSubstr("foraging"))));
}

}  // namespace
}  // namespace gauntlet::testing_support
