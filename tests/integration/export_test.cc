// `export` and `show --json --runs` of real campaigns.
// Covers: report/tables/exported_tables.cc, report/tables/search_columns.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/integration/campaign_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// One small sweep for all tests.
class ExportTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<TemporaryDirectory>();
    dir_ = *scratch_ / "c";
    const ProcessResult evolved =
        Gauntlet({"evolve", "flocking", "--dir", dir_, "--population", "4", "--generations", "3", "--seeds",
                  "5,6", "--sweep", "scenario_parameters.time_limit=20,30", "--quiet"});
    ASSERT_EQ(evolved.exit_code, 0) << evolved.err;
  }
  static void TearDownTestSuite() { scratch_.reset(); }

  // The text that `export` writes with these options.
  static std::string Export(const std::string& dir, std::vector<std::string> options) {
    const std::string out = *scratch_ / "exported";
    options.insert(options.begin(), {"export", dir, "--out", out});
    const ProcessResult ended = Gauntlet(options);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    return ReadFile(out);
  }

  static std::unique_ptr<TemporaryDirectory> scratch_;
  static std::string dir_;
};
std::unique_ptr<TemporaryDirectory> ExportTest::scratch_;
std::string ExportTest::dir_;

std::size_t Lines(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

TEST_F(ExportTest, GivesEveryRunAsShowDoes) {
  const json exported = json::parse(Export(dir_, {"--format", "json"}));
  EXPECT_EQ(exported.at("finished"), true);
  EXPECT_EQ(exported.at("notes"), json::array());
  const json& runs = exported.at("runs");
  ASSERT_EQ(runs.size(), 4U * 4 * 3);
  EXPECT_EQ(runs.front().at("search_name"), "scenario_parameters.time_limit=20, seed 5");
  EXPECT_EQ(runs.front().at("scenario_parameters.time_limit"), 20);
  EXPECT_EQ(runs.front().at("simulated_time"), 20);
  EXPECT_EQ(runs.back().at("scenario_parameters.time_limit"), 30);
  EXPECT_EQ(runs.back().at("search_seed"), "6");

  const ProcessResult show = Gauntlet({"show", dir_, "--json", "--runs"});
  ASSERT_EQ(show.exit_code, 0) << show.err;
  const json shown = json::parse(show.out);
  EXPECT_EQ(shown.at("runs"), runs);
  EXPECT_EQ(shown.at("columns"), exported.at("columns"));
  EXPECT_EQ(shown.at("runs_done"), runs.size());
}

TEST_F(ExportTest, CsvHasTheSameValuesInTheSameColumns) {
  const std::string csv = Export(dir_, {"--format", "csv"});
  const json exported = json::parse(Export(dir_, {"--format", "json"}));
  EXPECT_EQ(Lines(csv), exported.at("runs").size() + 1);
  std::string names;
  for (const json& column : exported.at("columns"))
    names += (names.empty() ? "" : ",") + column.at("name").get<std::string>();
  EXPECT_EQ(csv.substr(0, csv.find('\n')), names);
  // As `compare` reads it, it is the same set of runs.
  Export(dir_, {"--format", "csv"});
  std::filesystem::rename(*scratch_ / "exported", *scratch_ / "runs.csv");
  const ProcessResult equal =
      Gauntlet({"compare", *scratch_ / "runs.csv", dir_ + ":all", "--mixed", "--json"});
  ASSERT_EQ(equal.exit_code, 0) << equal.err;
  const json comparison = json::parse(equal.out);
  EXPECT_EQ(comparison.at("a"), 0.5);
  EXPECT_NEAR(comparison.at("mean").at(0).get<double>(), comparison.at("mean").at(1).get<double>(), 1e-12);
}

TEST_F(ExportTest, CaseFilesAreWhatEvaluateTakes) {
  const std::string random = *scratch_ / "random";
  ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "3", "--set", "scenario_parameters.time_limit=20",
                      "--dir", random, "--quiet"})
                .exit_code,
            0);
  const std::string cases = *scratch_ / "cases";
  const ProcessResult ended =
      Gauntlet({"export", random, "--what", "cases", "--format", "json", "--out", cases});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "gauntlet: wrote 3 case files into " + (*scratch_ / "cases") + "\n");
  const ProcessResult evaluated =
      Gauntlet({"evaluate", "flocking", "--set", "scenario_parameters.time_limit=20", "--dir",
                *scratch_ / "evaluated", "--json", "--quiet", "--case", cases + "/case-1.json",
                cases + "/case-2.json", cases + "/case-3.json"});
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
  const std::string argos = *scratch_ / "argos";
  ASSERT_EQ(Gauntlet({"export", random, "--format", "argos", "--out", argos}).exit_code, 0);
  const ProcessResult from_argos =
      Gauntlet({"evaluate", "flocking", "--set", "scenario_parameters.time_limit=20", "--dir",
                *scratch_ / "evaluated-argos", "--quiet", "--case", argos + "/case-1.argos",
                argos + "/case-2.argos", argos + "/case-3.argos"});
  ASSERT_EQ(from_argos.exit_code, 0) << from_argos.err;
  const json population = Show(random).at("population");
  const json again = Show(*scratch_ / "evaluated").at("population");
  ASSERT_EQ(again.size(), 3U);
  const json third_time = Show(*scratch_ / "evaluated-argos").at("population");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again[i].at("genome"), population[i].at("genome"));
    EXPECT_EQ(third_time[i].at("genome"), population[i].at("genome"));
  }
}

TEST_F(ExportTest, AnArgosFileStartsItsRun) {
  const std::string run = *scratch_ / "one-run";
  const ProcessResult exported =
      Gauntlet({"export", dir_, "--format", "argos", "--run", "2", "--controller-file",
                GAUNTLET_SOURCE_DIR "/argos/example/light_flocking.argos", "--out", run});
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_EQ(exported.err,
            "gauntlet: The robot with the controller 'scenario' belongs to the scenario and stands still: "
            "give it a controller.\n"
            "gauntlet: wrote 1 case file into " +
                (*scratch_ / "one-run") + "\n");
  const std::string text = ReadFile(run + "/run-2.argos");
  const json ways = json::parse(Export(dir_, {"--format", "json", "--what", "trajectories", "--run", "2"}));
  for (const json& row : ways.at("trajectories")) {
    if (row.at("time") != 0) continue;
    EXPECT_THAT(text,
                HasSubstr("<body position=\"" + row.at("x").dump() + "," + row.at("y").dump() + ",0\""));
  }

  const ProcessResult none =
      Gauntlet({"export", dir_, "--format", "argos", "--run", "9999", "--out", run + "x"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_EQ(none.err, "gauntlet: there is no run 9999 in this campaign\n");
  const ProcessResult missing = Gauntlet({"export", dir_, "--format", "argos", "--run", "2",
                                          "--controller-file", run + "/none.argos", "--out", run + "x"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_EQ(missing.err, "gauntlet: --controller-file cannot open " + (*scratch_ / "one-run/none.argos") +
                             ": No such file or directory\n");
}

TEST_F(ExportTest, CasesAsATableHaveARowForEachObstacle) {
  const std::string csv = Export(dir_, {"--format", "csv", "--what", "cases"});
  std::size_t obstacles = 0;
  const json shown = Show(dir_);
  for (const json& search : shown.at("searches")) {
    obstacles += 8 * static_cast<std::size_t>(search.at("statistics").at("children").get<double>() + 4);
  }
  EXPECT_EQ(Lines(csv), 1 + obstacles);
}

TEST_F(ExportTest, WaysThatWereNotKeptAreSimulatedAgain) {
  const json ways = json::parse(Export(dir_, {"--format", "json", "--what", "trajectories", "--run", "2"}));
  // 10 birds and the prey, every 5 s from 0 to 20 s.
  ASSERT_EQ(ways.at("trajectories").size(), 11U * 5);
  EXPECT_EQ(ways.at("trajectories").back().at("time"), 20);
  EXPECT_EQ(ways.at("trajectories").back().at("robot"), 10);

  const std::string kept = *scratch_ / "kept";
  ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "2", "--set", "scenario_parameters.time_limit=20",
                      "--set", "store.trajectories=true", "--dir", kept, "--quiet"})
                .exit_code,
            0);
  const ProcessResult of_kept = Gauntlet(
      {"export", kept, "--what", "trajectories", "--format", "csv", "--out", *scratch_ / "kept.csv"});
  EXPECT_EQ(of_kept.exit_code, 0) << of_kept.err;
  EXPECT_EQ(of_kept.err, "gauntlet: wrote 110 rows to " + (*scratch_ / "kept.csv") + "\n");
  EXPECT_EQ(Lines(ReadFile(*scratch_ / "kept.csv")), 1U + 2 * 11 * 5);
}

}  // namespace
}  // namespace gauntlet::testing_support
