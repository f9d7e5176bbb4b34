#include "controllers/command/outcome.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "controllers/command/placeholders.h"
#include "tests/controllers/command/command_definitions.h"
#include "tests/support/process.h"

namespace gauntlet::controllers::command {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing_support::TemporaryDirectory;

class OutcomeTest : public testing::Test {
 protected:
  void Leave(const std::string& name, const std::string& content) {
    std::ofstream(scratch_ / name) << content;
  }
  Result<sim::RunResult> Outcome(const json& more = json::object()) {
    return OutcomeOf(DefinitionWith(more), {}, scratch_.path());
  }
  std::string Error(const json& more = json::object()) {
    const auto outcome = Outcome(more);
    return outcome.ok() ? "" : outcome.error().message;
  }

  TemporaryDirectory scratch_;
};

TEST_F(OutcomeTest, TheObjectInOutIsTaken) {
  Leave(kOutFile, "{\"items\": 4,\n \"other\": \"text\"}\n");
  Leave(kStdoutFile, "{\"items\": 9}\n");
  const auto outcome = Outcome();
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_EQ(outcome->verdict, sim::Verdict::kCompleted);
  EXPECT_EQ(outcome->fitness, 4.0);
  EXPECT_TRUE(outcome->failure.total);
  EXPECT_EQ(outcome->metrics, (std::vector<std::pair<std::string, double>>{{"items", 4.0}}));
  EXPECT_NE(outcome->hash, 0U);
}

TEST_F(OutcomeTest, WithoutItTheLastLineThatIsAnObject) {
  Leave(kStdoutFile, "{\"items\": 1}\nnoise {\n{\"items\": 7, \"ok\": true}\n[1, 2]\ndone");
  EXPECT_EQ(Outcome()->fitness, 7.0);
  EXPECT_FALSE(Outcome()->failure.total);
}

TEST_F(OutcomeTest, IsJudgedByItsRequirements) {
  Leave(kOutFile, "{\"items\": 4}\n");
  Leave("t.csv", "time,robot,x,y\n0,a,0,0\n1,a,1,0\n2,a,2,0\n3,a,1,0\n");
  sim::RunSpec spec;
  const auto judged = [&](const std::string& requirements, const json& more) {
    spec.requirements = requirements;
    return OutcomeOf(DefinitionWith(more), spec, scratch_.path());
  };
  const json trajectory = {{"trajectory", "t.csv"}};
  const auto far = judged("near = always greatest(x) < 1.5\n", trajectory);
  ASSERT_TRUE(far.ok()) << far.error().message;
  EXPECT_TRUE(far->failure.total);
  EXPECT_EQ(far->metrics.back(), (std::pair<std::string, double>("violated_at.near", 2.0)));
  EXPECT_TRUE(far->trajectory.empty());
  EXPECT_FALSE(judged("near = eventually[2,3] greatest(x) < 1.5\n", trajectory)->failure.total);
  EXPECT_FALSE(judged("some = items >= 4\n", json::object())->failure.total) << "by metrics alone";
  EXPECT_EQ(judged("near = always greatest(x) < 1.5\n", json::object()).error().message,
            "requirements: a program without a trajectory is judged by its metrics alone");
}

TEST_F(OutcomeTest, FlagsAreNumbersAndFormulasSeeWhatStandsBeforeThem) {
  Leave(kOutFile, R"({"items": 2.5, "done": true})");
  Leave(kStdoutFile, "took 12 s\n");
  const auto outcome = Outcome({{"metrics", {"items", "done"}},
                                {"metric", json::array({{{"name", "took"}, {"from", "log:took (\\d+)"}},
                                                        {{"name", "rate"}, {"formula", "items / took"}}})},
                                {"fitness", "rate + done"}});
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_EQ(outcome->fitness, 2.5 / 12.0 + 1.0);
  EXPECT_EQ(outcome->metrics.back().first, "rate");
}

TEST_F(OutcomeTest, SaysWhatIsMissingOrNoNumber) {
  EXPECT_EQ(Error(), "it has neither written out.json ({out}) nor printed a line that is a JSON object");
  Leave(kOutFile, "{\"item\": 1, \"time\": 2}");
  EXPECT_EQ(Error(), "it reports no 'items'; it reports item, time");
  Leave(kOutFile, "{\"items\": \"many\"}");
  EXPECT_EQ(Error(), "'items' = \"many\" is no finite number");
  Leave(kOutFile, "{\"items\": null}");
  EXPECT_EQ(Error(), "'items' = null is no finite number");
  Leave(kOutFile, "{\"items\": NaN}");
  EXPECT_THAT(Error(), HasSubstr("out.json holds no JSON object (NaN and Infinity"));
  Leave(kOutFile, "{\"items\": 1e999}");
  EXPECT_NE(Error(), "");
  Leave(kOutFile, "{\"items\": 0}");
  EXPECT_THAT(Error({{"fitness", "1 / items"}}), HasSubstr("with items = 0"));
}

TEST_F(OutcomeTest, TheHashCoversMetricsAndNothingElse) {
  Leave(kOutFile, R"({"items": 6, "host": "a"})");
  const std::uint64_t hash = Outcome()->hash;
  Leave(kOutFile, R"({"host": "b", "items": 6.0})");
  Leave(kStdoutFile, "another log\n");
  EXPECT_EQ(Outcome()->hash, hash);
  Leave(kOutFile, R"({"items": 7})");
  EXPECT_NE(Outcome()->hash, hash);
}

TEST_F(OutcomeTest, ATrajectoryIsPartOfIt) {
  Leave(kOutFile, R"({"items": 6})");
  Leave("t.csv", "0,a,robot,0,0,0\n1,a,robot,1,0,0\n");
  const auto outcome = Outcome({{"trajectory", "t.csv"}});
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_EQ(outcome->robots.size(), 1U);
  Leave("t.csv", "0,a,robot,0,0,0\n1,a,robot,1,0,0.5\n");
  EXPECT_NE(Outcome({{"trajectory", "t.csv"}})->hash, outcome->hash);
  EXPECT_EQ(Error({{"trajectory", "u.csv"}}), "it has left no file u.csv");
}

TEST_F(OutcomeTest, AReplayIsDrawnByMoreRowsThanCount) {
  const auto outcome = [&](bool replay) {
    sim::RunSpec spec;
    spec.record_trajectory = replay;
    return OutcomeOf(DefinitionWith({{"trajectory", "t.csv"}}), spec, scratch_.path());
  };
  Leave(kOutFile, R"({"items": 6})");
  Leave("t.csv", "0,a,robot,0,0,0\n1,a,robot,1,0,0\n");
  const auto before = outcome(true);
  EXPECT_EQ(before->trajectory.at(5).at(0).x, 0.0);
  Leave("t.csv.replay", "0,a,robot,0,0,0\n0.5,a,robot,0.4,0,0\n1,a,robot,1,0,0\n");
  EXPECT_EQ(outcome(true)->trajectory.at(5).at(0).x, 0.4);
  EXPECT_EQ(outcome(true)->hash, before->hash);
  EXPECT_EQ(outcome(true)->ticks, before->ticks);
  EXPECT_TRUE(outcome(false)->trajectory.empty());
  Leave("t.csv.replay", "0,a,robot,0,0,0\n0,b,robot,0,0,0\n");
  EXPECT_EQ(outcome(true).error().message, "its file t.csv.replay has 2 robots, t.csv has 1");
  EXPECT_TRUE(outcome(false).ok());
}

TEST_F(OutcomeTest, RefusalsAreFoundInBothOutputs) {
  const json refused = {{"refused", json::array({{{"pattern", "^cannot place"}}})}};
  EXPECT_EQ(RefusedBy(DefinitionWith(refused), scratch_.path()), std::nullopt);
  Leave(kStderrFile, "x\ncannot place robot 3\n");
  EXPECT_EQ(RefusedBy(DefinitionWith(refused), scratch_.path()), "cannot place robot 3");
  EXPECT_EQ(RefusedBy(DefinitionWith(json::object()), scratch_.path()), std::nullopt);
}

// Reading it would wait for somebody who writes.
TEST_F(OutcomeTest, ANamedPipeIsNoFileThatWasLeft) {
  for (const std::string& name : {std::string(kOutFile), std::string(kStdoutFile)})
    ASSERT_EQ(mkfifo((scratch_ / name).c_str(), 0600), 0);
  EXPECT_THAT(Error(), HasSubstr("it has neither written out.json"));
}

}  // namespace
}  // namespace gauntlet::controllers::command
