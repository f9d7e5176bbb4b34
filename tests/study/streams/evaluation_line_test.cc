#include "study/streams/evaluation_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

class EvaluationLineTest : public testing::Test {
 protected:
  EvaluationLine Read(const std::string& text) {
    LineError wrong;
    auto line = reader_.Read(text, wrong);
    EXPECT_TRUE(line) << wrong.message;
    return line.value_or(EvaluationLine{});
  }
  std::string Refused(const std::string& text) {
    wrong_ = {};
    EXPECT_FALSE(reader_.Read(text, wrong_)) << text;
    return wrong_.message;
  }

  const Experiment experiment_ =
      testing_support::Flocking({"search.algorithm=stream", "search.replicates=2"});
  EvaluationLineReader reader_{experiment_};
  LineError wrong_;
};

TEST_F(EvaluationLineTest, SaysWhatIsSimulated) {
  const EvaluationLine line = Read(
      R"({"id": "a", "case": {"obstacles": [{"x": 1, "y": 2, "length": 1, "width": 0.2}]},)"
      R"( "set": {"controller_parameters.turn_rate": 0.5}, "seed": 18446744073709551615, "replicates": 7})");
  EXPECT_EQ(line.id, "a");
  EXPECT_EQ(line.asked.test_case.obstacles.at(0).y, 2.0);
  EXPECT_EQ(line.asked.seed, 18446744073709551615U);
  EXPECT_EQ(line.asked.replicates, 7U);
  ASSERT_NE(line.asked.settings, nullptr);
  EXPECT_EQ(line.asked.settings->controller_parameters.at("turn_rate"), 0.5);
}

TEST_F(EvaluationLineTest, WhatIsNotSaidIsTheExperiments) {
  const EvaluationLine line = Read(R"({"case": {}, "set": {}})");
  EXPECT_EQ(line.id, "");
  EXPECT_EQ(line.asked.settings, nullptr);
  EXPECT_EQ(line.asked.seed, std::nullopt);
  EXPECT_EQ(line.asked.replicates, 2U);
}

TEST_F(EvaluationLineTest, TheSameContentHasTheSameText) {
  const std::string first = Read(R"({"id":"a","case":{},"seed":3,"set":{"physics":"box2d"}})").content;
  EXPECT_EQ(
      Read(R"( {"set": {"physics": "box2d"}, "seed": "3", "case": {}, "replicates": 2, "id": "b"})").content,
      first);
  EXPECT_NE(Read(R"({"id":"a","case":{},"seed":4,"set":{"physics":"box2d"}})").content, first);
  EXPECT_NE(Read(R"({"id":"a","case":{"name":"other"},"seed":3,"set":{"physics":"box2d"}})").content, first);
}

TEST_F(EvaluationLineTest, AStoredLineIsReadBack) {
  const EvaluationLine line = Read(R"({"case":{},"seed":3,"replicates":4,"set":{"physics":"box2d"}})");
  const StreamedCase back =
      reader_.Restore({.individual = 1, .content = line.content}, line.asked.test_case).value();
  EXPECT_EQ(back.seed, 3U);
  EXPECT_EQ(back.replicates, 4U);
  ASSERT_NE(back.settings, nullptr);
  EXPECT_TRUE(*back.settings == *line.asked.settings);
}

TEST_F(EvaluationLineTest, BadLinesAreToldWhatWouldBeRight) {
  const struct {
    const char* line;
    const char* message;
  } bad[] = {
      {"", "unexpected end of input"},
      {"[1]", "the line is [1], expected an object"},
      {R"({"case": NaN})", "invalid literal"},
      {R"({"case": {"side_x": 1e999}})", "beyond the range"},
      {R"({"case": {}, "case": {}})", "given twice"},
      {R"({"case": {}, "sed": 1})", "did you mean 'set'"},
      {R"({"id": "", "case": {}})", "id is \"\", expected a text of 1 to 200 bytes"},
      {R"({"id": 7, "case": {}})", "id is 7"},
      {R"({})", "which case?"},
      {R"({"case": {}, "file": "x.json"})", "which case?"},
      {R"({"file": "no-such.json"})", "no-such.json"},
      {R"({"file": "/dev/zero"})", "/dev/zero is no regular file"},
      {R"({"file": "/"})", "/ is no regular file"},
      {R"({"case": {"obstacles": 3}})", "obstacles must be a list"},
      {R"({"case": {}, "set": 3})", "set is 3"},
      {R"({"case": {}, "set": {"scenario": "foraging"}})", "scenario is the same for all lines"},
      {R"({"case": {}, "set": {"controller": "other"}})", "controller is the same for all lines"},
      {R"({"case": {}, "set": {"genome.genes": 3}})", "genome.genes is said by the case"},
      {R"({"case": {}, "set": {"search.replicates": 3}})", "says how is searched"},
      {R"({"case": {}, "set": {"controller_parameters.turn_raet": 3}})", "did you mean"},
      {R"({"case": {}, "set": {"controller_parameters.turn_rate": []}})", "turn_rate is []"},
      {R"({"case": {}, "set": {"controller_parameters.turn_rate": "much"}})", "turn_rate"},
      {R"({"case": {}, "set": {"controller_parameters.turn_rate": -1e30}})", "out of range"},
      {R"({"case": {}, "seed": -1})", "seed is -1, expected a whole number, 0 to 2^64-1"},
      {R"({"case": {}, "seed": 1.5})", "seed is 1.5"},
      {R"({"case": {}, "replicates": 0})", "replicates is 0"},
  };
  for (const auto& [line, message] : bad) EXPECT_THAT(Refused(line), HasSubstr(message)) << line;
}

TEST_F(EvaluationLineTest, ABadLineIsStillKnownByItsId) {
  Refused(R"({"id": "a", "case": {}, "replicates": 0})");
  EXPECT_EQ(wrong_.id, "a");
  EXPECT_EQ(AnswerOf(wrong_, 3).dump().substr(0, 28), R"({"id":"a","line":3,"error":")");
}

TEST_F(EvaluationLineTest, ACaseThatBreaksARuleIsRefusedByItsName) {
  Refused(R"({"case": {"obstacles": [{"x": 900, "length": 1, "width": 0.2}]}})");
  EXPECT_NE(wrong_.rule, "");
  EXPECT_EQ(AnswerOf(wrong_, 1)["rule"], wrong_.rule);
}

// Its runs would be ended as if they hung.
TEST_F(EvaluationLineTest, RunsCannotBeMadeLongerThanTheExperiments) {
  EXPECT_THAT(Refused(R"({"case": {}, "set": {"scenario_parameters.time_limit": 3600}})"),
              HasSubstr("begin with the longest"));
}

TEST(EvaluationAnswerTest, TellsMeanFitnessAndFailuresOfTheRuns) {
  const Experiment experiment = testing_support::Flocking();
  StoredRun lost;
  lost.id = 5;
  lost.seed = 18446744073709551615U;
  lost.fitness = 0.25;
  lost.metrics = {{"birds_left", 3.0}};
  lost.total_failure = true;
  lost.failure_type = 1;
  StoredRun fine = lost;
  fine.fitness = 0.75;
  fine.total_failure = false;
  fine.failure_type = -1;
  StoredRun hung = lost;
  hung.verdict = sim::Verdict::kHung;
  hung.message = "it never ended";
  const std::vector<const StoredRun*> runs = {&lost, &fine, &hung};
  const auto answer = AnswerOf(experiment, "a", 9, 4, runs);
  EXPECT_EQ(answer["fitness"], 0.5);
  EXPECT_EQ(answer["failures"], 1);
  EXPECT_EQ(answer["individual"], 4);
  EXPECT_EQ(answer["runs"][0]["seed"], "18446744073709551615");
  EXPECT_EQ(answer["runs"][0]["metrics"]["birds_left"], 3.0);
  EXPECT_EQ(answer["runs"][1]["failure"]["type"], nullptr);
  EXPECT_EQ(answer["runs"][2]["message"], "it never ended");
  EXPECT_EQ(AnswerOf(experiment, "", 1, 1, {})["id"], nullptr);
  EXPECT_EQ(AnswerOf(experiment, "", 1, 1, {})["fitness"], nullptr);
}

}  // namespace
}  // namespace gauntlet
