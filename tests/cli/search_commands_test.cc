// evolve and random with several searches, and what --dry-run says of them.
// Covers: cli/options/sweep.cc
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "proto/run_codec.h"
#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class SearchCommands : public CommandLine {};

TEST_F(SearchCommands, EvolveServesASearchForEachCombinationInOneCampaign) {
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c"), "--generations", "3", "--sweep",
                 "search.mutation_probability=0.02,0.1", "--seeds", "1..3"}),
            kExitDone)
      << err_.str();
  EXPECT_EQ(campaigns_.starts, 1);
  ASSERT_THAT(campaigns_.searches, SizeIs(6));
  EXPECT_EQ(campaigns_.searches[0].settings, "search.mutation_probability=0.02, seed 1");
  EXPECT_EQ(campaigns_.searches[5].settings, "search.mutation_probability=0.1, seed 3");
  for (const SearchPlan& search : campaigns_.searches) EXPECT_EQ(search.experiment.search.generations, 3);
  EXPECT_EQ(campaigns_.searches[5].experiment.seed, 3U);
  EXPECT_EQ(campaigns_.searches[5].experiment.search.mutation_probability, 0.1);
  EXPECT_EQ(Messages(), "gauntlet: 100 runs in 4.0 s (25.0/s; master 0 us of CPU per run)\n");
}

TEST_F(SearchCommands, RandomSweepsTheScenario) {
  EXPECT_EQ(Run({"random", "flocking", "--dir", Path("c"), "--cases", "9", "--sweep",
                 "scenario_parameters.birds=5,7", "--seeds", "4,8"}),
            kExitDone)
      << err_.str();
  ASSERT_THAT(campaigns_.searches, SizeIs(4));
  EXPECT_EQ(campaigns_.searches[3].settings, "scenario_parameters.birds=7, seed 8");
  EXPECT_EQ(campaigns_.searches[3].experiment.search.algorithm, "random");
  EXPECT_EQ(campaigns_.searches[3].experiment.search.parameters.at("cases"), 9.0);
}

TEST_F(SearchCommands, ADrawnSeedIsThatOfAllSearches) {
  EXPECT_EQ(Run({"evolve", "flocking", "--dir", Path("c"), "--seed", "random", "--sweep",
                 "search.population=4,6,8"}),
            kExitDone);
  ASSERT_THAT(campaigns_.searches, SizeIs(3));
  const std::uint64_t seed = campaigns_.searches[0].experiment.seed;
  EXPECT_THAT(campaigns_.searches,
              Each(Field(&SearchPlan::experiment, Field(&Experiment::seed, ::testing::Eq(seed)))));
}

// The worker program is a script with one answer.
class DryRun : public SearchCommands {
 protected:
  void SetUp() override {
    SearchCommands::SetUp();
    sim::RunResult result;
    result.cpu_seconds = 0.5;
    sim::SetHashes(result);
    const std::string answer = Write("answer", proto::EncodeRunResult(result));
    const std::string worker = Write("worker", "#!/bin/sh\ncat > /dev/null\ncat '" + answer + "'\n");
    std::filesystem::permissions(worker, std::filesystem::perms::owner_all);
    setenv("GAUNTLET_WORKER", worker.c_str(), 1);
  }
  void TearDown() override {
    unsetenv("GAUNTLET_WORKER");
    SearchCommands::TearDown();
  }
  void ExpectNothingMade() const {
    EXPECT_EQ(campaigns_.starts, 0);
    EXPECT_FALSE(std::filesystem::exists(Path("c")));
  }
};

TEST_F(DryRun, SaysWhatAnEvolutionWouldCost) {
  ASSERT_EQ(Run({"evolve", "flocking", "--dir", Path("c"), "--seeds", "1..3", "--workers", "2", "--dry-run"}),
            kExitDone)
      << err_.str();
  EXPECT_EQ(out_.str(),
            "flocking: a dry run, nothing was made\n"
            "\n"
            "  searches      3\n"
            "  runs          3,000\n"
            "  test cases    at most 354 different\n"
            "  time          about 12 min 30 s with 2 workers (11 of the first runs took 500 ms each here; "
            "later ones may differ)\n"
            "  no obstacles  0 of 5 runs fail\n"
            "  disk          about 1.8 MB\n");
  EXPECT_THAT(err_.str(), IsEmpty());
  ExpectNothingMade();
}

TEST_F(DryRun, SaysItAsJson) {
  ASSERT_EQ(Run({"random", "flocking", "--dir", Path("c"), "--cases", "40", "--seeds", "5,6", "--workers",
                 "4", "--dry-run", "--json"}),
            kExitDone)
      << err_.str();
  const nlohmann::json json = nlohmann::json::parse(out_.str());
  EXPECT_EQ(json["searches"].size(), 2U);
  EXPECT_EQ(json["searches"][1]["seed"], "6");
  EXPECT_EQ(json["runs"], 80);
  EXPECT_EQ(json["cases"], 80);
  EXPECT_EQ(json["cases_exact"], true);
  EXPECT_EQ(json["workers"], 4);
  EXPECT_EQ(json["seconds"], 10.0);
  EXPECT_GT(json["bytes"], 0);
  ExpectNothingMade();
}

TEST_F(DryRun, LooksAtTheCasesOfEvaluate) {
  const std::string file =
      Write("wall.json", R"({"obstacles": [{"x": 0.5, "y": -1, "length": 1.6, "width": 0.2}]})");
  ASSERT_EQ(
      Run({"evaluate", "flocking", "--case", file, "--replicates", "30", "--dir", Path("c"), "--dry-run"}),
      kExitDone)
      << err_.str();
  EXPECT_EQ(out_.str(),
            "flocking: a dry run, nothing was made\n"
            "\n"
            "  searches    1\n"
            "  runs        30\n"
            "  test cases  1\n"
            "  time        about 7.5 s with 2 workers (11 of the first runs took 500 ms each here; later "
            "ones may differ)\n"
            "  disk        about 112 kB\n");
  ExpectNothingMade();
}

TEST_F(DryRun, RefusesWhatTheCommandWouldRefuse) {
  ExpectUsageError({"evolve", "flocking", "--dry-run", "--workers", "0"}, HasSubstr("--workers 0"));
  Write("campaign.db", "");
  ExpectUsageError({"evolve", "flocking", "--dry-run", "--dir", directory_.string()},
                   "gauntlet: " + directory_.string() +
                       " holds a campaign already; go on with it by `gauntlet resume " + directory_.string() +
                       "`, or choose another directory\n");
}

}  // namespace
}  // namespace gauntlet
