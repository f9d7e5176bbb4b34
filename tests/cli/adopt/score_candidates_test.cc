#include "cli/adopt/score_candidates.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ScoreCandidatesTest : public testing::Test {
 protected:
  TrialRun Run(const std::string& name, const std::string& out, const std::string& csv = "") {
    TrialRun run;
    run.folder = scratch_ / name;
    run.out = out;
    std::filesystem::create_directory(run.folder);
    if (!csv.empty()) std::ofstream(run.folder + "/s.csv") << csv;
    std::ofstream(run.folder + "/" + kTrajectoryFile)
        << "time,robot,kind,x,y,heading\n0,a,e-puck,0,0,0\n1,a,e-puck," << csv.size() << ",0,0\n";
    return run;
  }

  testing_support::TemporaryDirectory scratch_;
};

TEST_F(ScoreCandidatesTest, LinesPrintedOnceThenFilesThenLinesPrintedOften) {
  const TrialRun first = Run("1", "tick 1\ntick 2\nseed 4: items (x): 12.5 of fb12\n", "clock,items\n5,3\n");
  const TrialRun other = Run("2", "tick 1\ntick 3\nseed 4: items (x): 9 of fb12\n", "clock,items\n5,4\n");
  std::vector<std::string> sources;
  for (const ScoreCandidate& found : FindScores(first, other, first, {"s.csv", "missing"}))
    sources.push_back(found.from);
  EXPECT_THAT(sources,
              ElementsAre(R"(log:^seed [-+.0-9eE]+: items \(x\): ([-+.0-9eE]+) of fb12$)", "csv:s.csv:2",
                          "log:^tick ([-+.0-9eE]+)$",
                          // What never varies comes last.
                          R"(log:^seed ([-+.0-9eE]+): items \(x\): [-+.0-9eE]+ of fb12$)", "csv:s.csv:1"));
  EXPECT_EQ(FindScores(first, other, first, {}, 1).size(), 1U);
}

TEST_F(ScoreCandidatesTest, AColumnOfAFileWithoutNamesIsNotTakenForAnother) {
  const TrialRun run = Run("1", "", "1\t20\t5\n2\t19\t6\n");
  std::vector<std::string> sources;
  for (const ScoreCandidate& found : FindScores(run, run, run, {"s.csv"})) sources.push_back(found.from);
  EXPECT_THAT(sources, ElementsAre("csv:s.csv:3", "csv:s.csv:2", "csv:s.csv:1"));
}

TEST_F(ScoreCandidatesTest, OneThatIsNamedHasItsValues) {
  const TrialRun first = Run("1", "items 1\n", "a\n1\n");
  const TrialRun other = Run("2", "items 2\n", "a\n10\n");
  const auto log = ScoreNamed("log:items (\\d)", first, other, first);
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(log->other_seed, 2.0);
  const auto measure = ScoreNamed("trajectory:displacement", first, other, first);
  ASSERT_TRUE(measure.ok()) << measure.error().message;
  EXPECT_EQ(measure->first, 4.0);
  EXPECT_EQ(measure->other_seed, 5.0);
  EXPECT_THAT(ScoreNamed("log:other (\\d)", first, other, first).error().message,
              HasSubstr("nothing that it printed"));
  EXPECT_THAT(ScoreNamed("trajectory:altitude", first, other, first).error().message, HasSubstr("altitude"));
  EXPECT_THAT(ScoreNamed("tea:leaves", first, other, first).error().message,
              HasSubstr("is none of log:PATTERN"));
}

}  // namespace
}  // namespace gauntlet
