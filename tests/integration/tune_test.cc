// A tuning as a person runs it: killed on the way, scaled down, with its pictures.
// Covers: cli/commands/tune_command.cc, study/tuning.cc, study/tuning_analysis.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kCandidates = R"(
name = "small"
[tune.small]
title = "a small tuning"
experiment = "flocking"
repeats = 9
sizes = "1, 5, 50"
set.search.population = 4
set.search.generations = 3
candidates.genome.genes = "1, 8"
candidates.search.crossover = "single-point, uniform"
)";

class TuneTest : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(scratch_ / "small.toml") << kCandidates; }
  std::vector<std::string> Command(const std::string& dir, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {"tune",      "flocking", "--candidates", scratch_ / "small.toml",
                                        "--repeats", "6",        "--dir",        scratch_ / dir,
                                        "--json",    "--quiet",  "--workers",    "2"};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  static json TuningOf(const std::string& text) { return json::parse(text)["tunings"][0]; }
  TemporaryDirectory scratch_;
};

TEST_F(TuneTest, SaysWhichValuesDifferAndHowManyRepeatsAreEnough) {
  const ProcessResult run = Gauntlet(Command("t"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json tuning = TuningOf(run.out);
  const json& genes = tuning["parameters"][0];
  EXPECT_EQ(genes["key"], "genome.genes");
  EXPECT_EQ(genes["recommended"], "8");
  const json& one = genes["values"][0];
  EXPECT_EQ(one["value"], "1");
  EXPECT_EQ(one["evolutions"], 6);
  EXPECT_EQ(one["simulations"], 12);
  // One obstacle costs hardly a bird.
  EXPECT_LT(one["a"].get<double>(), 0.29);
  EXPECT_EQ(one["effect"], "large");
  EXPECT_EQ(one["exceeds"], true);
  EXPECT_LT(one["p_holm"].get<double>(), 0.05);
  EXPECT_EQ(genes["evidence"].get<std::string>(),
            "8 stays: no other value is tougher by a large A beyond chance. Easier beyond chance: 1 (A 0.03, "
            "0.00 to 0.17).");

  EXPECT_EQ(genes["values"][1]["baseline"], true);
  ASSERT_EQ(tuning["consistency"].size(), 3U);
  EXPECT_EQ(tuning["consistency"][2]["repeats"], 50);
  EXPECT_LT(tuning["consistency"][2]["max_a"].get<double>(), 0.71);
  EXPECT_EQ(tuning["enough"], 50);

  EXPECT_THAT(ReadFile(scratch_ / "t/robustness.svg"), HasSubstr("genome.genes"));
  EXPECT_THAT(ReadFile(scratch_ / "t/consistency.svg"), HasSubstr("50 repeats are enough"));
  const ProcessResult page = Gauntlet(Command("t", {"--markdown", scratch_ / "page.md"}));
  EXPECT_EQ(page.out, run.out);
  const ProcessResult other = Gauntlet(Command("t", {"--set", "search.generations=4"}));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.err,
            "gauntlet: " + (scratch_ / "t/searches") +
                " was begun with other parts or settings than the study has now: name another --dir\n");
}

TEST_F(TuneTest, EndsTheSameWhateverMomentItIsKilledAt) {
  const ProcessResult whole = Gauntlet(Command("whole"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  sim::RandomStream random(29, sim::StreamPurpose::kTest);
  for (int kill = 0; kill < 4; ++kill) {
    const std::unique_ptr<Process> tune = StartGauntlet(Command("killed"));
    Eventually([&] { return !tune->Running(); }, RandomTime(random, std::chrono::milliseconds(900)));
    tune->Signal(SIGKILL);
    tune->Wait();
  }
  // `resume` knows what was changed of the file: six repeats.
  const bool begun = std::filesystem::exists(scratch_ / "killed/study.json");
  const ProcessResult last =
      begun ? Gauntlet({"resume", scratch_ / "killed", "--json", "--quiet"}) : Gauntlet(Command("killed"));
  ASSERT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(TuningOf(last.out), TuningOf(whole.out));
}

TEST_F(TuneTest, GoesOnWithTheValuesThatWereTyped) {
  const std::vector<std::string> more = {"--try", "search.population=4,8", "--budget", "16"};
  const ProcessResult run = Gauntlet(Command("t", more));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json parameter = TuningOf(run.out)["parameters"][0];
  EXPECT_EQ(parameter["key"], "search.population");
  for (const json& value : parameter["values"]) EXPECT_EQ(value["simulations"], 16);
  EXPECT_EQ(Gauntlet({"resume", scratch_ / "t", "--json", "--quiet"}).out, run.out);
}

TEST_F(TuneTest, ADryRunMakesNothing) {
  const ProcessResult dry = Gauntlet(Command("t", {"--dry-run"}));
  ASSERT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_EQ(json::parse(dry.out)["runs"], 3 * 6 * (12 + 4));
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "t"));
}

}  // namespace
}  // namespace gauntlet::testing_support
