// Covers: proto/json_text.cc
#include "proto/case_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/master/dispatch/sample_runs.h"

namespace gauntlet::proto {
namespace {

using testing::HasSubstr;

std::string CaseError(const std::string& text) {
  const Result<sim::TestCase> parsed = ParseCaseJson(text, "case.json");
  if (parsed) return "parsed";
  EXPECT_EQ(parsed.error().kind, ErrorKind::kInvalidInput);
  return parsed.error().message;
}

TEST(CaseJsonTest, AnObstacleMayMoveAndShine) {
  const Result<sim::TestCase> read = ParseCaseJson(
      R"({"obstacles": [{"x": 1, "y": 0, "length": 1, "width": 0.2, "light": "red",
                         "motion": {"speed": 0.02, "path": [{"x": 1, "y": 2}, {"x": -1}]}},
                        {"x": 2, "length": 1, "width": 0.2}]})",
      "case.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->obstacles[0].light, sim::Color::kRed);
  EXPECT_EQ(read->obstacles[0].speed, 0.02);
  EXPECT_EQ(read->obstacles[0].path, (std::vector<sim::Vec2>{{1.0, 2.0}, {-1.0, 0.0}}));
  EXPECT_TRUE(read->obstacles[1].Plain());
  EXPECT_EQ(CaseError(R"({"obstacles": [{"light": "mauve"}]})"),
            "case.json: obstacles[0].light: 'mauve' is no colour of lights; known: black, red, green, blue, "
            "yellow, white, magenta, cyan, orange");
  EXPECT_EQ(CaseError(R"({"obstacles": [{"motion": {"speeed": 1}}]})"),
            "case.json: obstacles[0].motion: unknown key 'speeed'; did you mean 'speed'?");
}

TEST(CaseJsonTest, ACaseSurvivesTheRoundTrip) {
  const sim::TestCase test_case = SampleSpec().test_case;
  const std::string text = WriteCaseJson(test_case);
  const Result<sim::TestCase> parsed = ParseCaseJson(text, "case.json");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  EXPECT_EQ(parsed->obstacles, test_case.obstacles);
  EXPECT_EQ(parsed->name, test_case.name);
  EXPECT_EQ(parsed->robots, test_case.robots);
  EXPECT_EQ(parsed->spawn_area->min, test_case.spawn_area->min);
  EXPECT_EQ(WriteCaseJson(*parsed), text);
  EXPECT_THAT(text, HasSubstr("\"orientation_deg\""));
}

TEST(CaseJsonTest, ALineageSurvivesTheRoundTrip) {
  CaseDocument document{SampleSpec().test_case, CaseLineage{}};
  CaseLineage& lineage = *document.lineage;
  lineage.made_by = "minimise";
  lineage.failing = "total_failure";
  lineage.parent = document.test_case;
  lineage.parent.name = "run 812";
  lineage.steps = {{"as it is", {1, 2}, {5, 5, {0.57, 1.0}}},
                   {"without obstacle 1", {2}, {10, 10, {0.72, 1.0}}}};
  lineage.verified = {29, 30, {0.83, 0.99}};
  const std::string text = WriteCaseDocument(document);
  const Result<CaseDocument> read = ParseCaseDocument(text, "case.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_TRUE(read->lineage.has_value());
  EXPECT_EQ(read->lineage->parent.name, "run 812");
  EXPECT_EQ(read->lineage->steps[1].obstacles, std::vector<int>{2});
  EXPECT_EQ(read->lineage->verified.failures, 29);
  EXPECT_EQ(WriteCaseDocument(*read), text);
  EXPECT_EQ(ParseCaseJson(text, "case.json")->obstacles, document.test_case.obstacles);
  EXPECT_EQ(CaseError(R"({"lineage": {"parent": {"lineage": {}}}})"),
            "case.json: lineage.parent: unknown key 'lineage'; known: name, side_x, side_y, wall_thickness, "
            "obstacles, spawn_area, robots, start_poses, center_x, center_y");
  EXPECT_EQ(CaseError(R"({"lineage": {"verified": {"interval": [1]}}})"),
            "case.json: lineage.verified.interval must be a list of two numbers, not a list");
}

RC_GTEST_PROP(CaseJsonProperty, EveryGeneComesBackBitForBit,
              (double x, double y, double length, double width)) {
  sim::TestCase test_case;
  test_case.obstacles.push_back({x, y, length, width, 359.0});
  RC_ASSERT(ParseCaseJson(WriteCaseJson(test_case), "f")->obstacles == test_case.obstacles);
}

TEST(CaseJsonTest, WhatIsNotGivenHasItsDefault) {
  const Result<sim::TestCase> parsed = ParseCaseJson("{}", "case.json");
  EXPECT_EQ(parsed->side_x, 6.0);
  EXPECT_EQ(parsed->wall_thickness, 0.1);
  EXPECT_TRUE(parsed->obstacles.empty());
  EXPECT_FALSE(parsed->robots.has_value());
}

TEST(CaseJsonTest, TakesBothSpellingsQuotedNumbersAndNull) {
  const Result<sim::TestCase> parsed = ParseCaseJson(
      "\xEF\xBB\xBF{\"sideX\": \"7.5\", \"side_y\": 8, \"robots\": \"12\", \"wallThickness\": null,\n"
      "\"name\": \"\\u00fc\\ud83d\\ude00\", \"obstacles\": [{\"orientationDeg\": 45}]}",
      "case.json");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  EXPECT_EQ(parsed->side_x, 7.5);
  EXPECT_EQ(parsed->side_y, 8.0);
  EXPECT_EQ(parsed->robots, 12);
  EXPECT_EQ(parsed->wall_thickness, 0.1);
  EXPECT_EQ(parsed->name, "\xC3\xBC\xF0\x9F\x98\x80");
  EXPECT_EQ(parsed->obstacles.at(0).orientation_deg, 45.0);
}

TEST(CaseJsonTest, MalformedTextIsRefusedWithLineAndColumn) {
  EXPECT_EQ(CaseError(""), "case.json:1:1: unexpected end of input; expected '[', '{', or a literal");
  EXPECT_EQ(CaseError("{\n  \"side_x\" 5\n}"), "case.json:2:12: unexpected number literal; expected ':'");
  EXPECT_EQ(CaseError("{\"side_x\": 5,\n}"), "case.json:2:1: unexpected '}'; expected string literal");
  EXPECT_EQ(CaseError("{\"name\": \"\xC3\xBC\", x}"), "case.json:1:15: invalid literal");
  EXPECT_EQ(CaseError("{\"obstacles\": [{}\n{}]}"), "case.json:2:1: unexpected '{'; expected ']'");
  EXPECT_EQ(CaseError("{\"side_x\": 05}"), "case.json:1:13: unexpected number literal; expected '}'");
  EXPECT_EQ(CaseError("{\"side_x\": 1e999}"), "case.json: side_x: a number beyond the range of a double");
  EXPECT_EQ(CaseError("{\"name\": \"abc"), "case.json:1:14: invalid string: missing closing quote");
  EXPECT_EQ(CaseError("{} {}"), "case.json:1:4: unexpected '{'; expected end of input");
  EXPECT_EQ(CaseError("{\"name\": \"\xFF\"}"), "case.json:1:11: invalid string: ill-formed UTF-8 byte");
  EXPECT_EQ(CaseError("{\"name\": \"\\ud800\"}"),
            "case.json:1:17: invalid string: surrogate U+D800..U+DBFF must be followed by U+DC00..U+DFFF");
  EXPECT_EQ(CaseError("{\"side_x\": 1,\n \"side_x\": 2}"), "case.json: side_x is given twice");
  EXPECT_EQ(CaseError("{\"side_x\": 1, \"sideX\": 2}"), "case.json: side_x is given under two spellings");
  EXPECT_EQ(CaseError(std::string(100, '[')), "case.json: nested deeper than 64 levels");
}

TEST(CaseJsonTest, StartPosesGiveTheNumberOfRobots) {
  const Result<sim::TestCase> parsed =
      ParseCaseJson(R"({"start_poses": [{"x": 1, "y": -0.25, "heading": 0.1}, {}]})", "case.json");
  ASSERT_TRUE(parsed.ok()) << parsed.error().message;
  EXPECT_EQ(parsed->robots, 2);
  ASSERT_EQ(parsed->start_poses.size(), 2U);
  EXPECT_EQ(parsed->start_poses[0].position, sim::Vec2(1.0, -0.25));
  EXPECT_EQ(parsed->start_poses[0].heading, 0.1);
  EXPECT_EQ(WriteCaseJson(*ParseCaseJson(WriteCaseJson(*parsed), "again.json")), WriteCaseJson(*parsed));
  EXPECT_EQ(CaseError("{\"start_poses\": [{\"x\": 1, \"z\": 2}]}"),
            "case.json: start_poses[0]: unknown key 'z'; known: x, y, heading");
}

TEST(CaseJsonTest, AnUnknownKeyIsRefusedWithTheNearestKnownOne) {
  EXPECT_EQ(CaseError("{\"obstacles\": [{\"x\": 1},\n  {\"lenght\": 2}]}"),
            "case.json: obstacles[1]: unknown key 'lenght'; did you mean 'length'?");
  EXPECT_EQ(CaseError("{\"quux\": 1}"),
            "case.json: unknown key 'quux'; known: name, side_x, side_y, wall_thickness, obstacles, "
            "spawn_area, robots, start_poses, center_x, center_y, lineage");
}

TEST(CaseJsonTest, AWrongTypeIsRefusedWhereItStands) {
  EXPECT_EQ(CaseError("{\"obstacles\": [{\"x\":\n \"abc\"}]}"),
            "case.json: obstacles[0].x must be a finite number, not the text \"abc\"");
  EXPECT_EQ(CaseError("{\"obstacles\": {}}"), "case.json: obstacles must be a list [ ... ], not an object");
  EXPECT_EQ(CaseError("{\"obstacles\": [[]]}"),
            "case.json: obstacles[0] must be an object { ... }, not a list");
  EXPECT_EQ(CaseError("{\"name\": 3}"), "case.json: name must be a text in double quotes, not 3");
  EXPECT_EQ(CaseError("{\"robots\": 1.5}"),
            "case.json: robots must be a whole number of at most 2147483647, not 1.5");
  EXPECT_EQ(CaseError("{\"robots\": 99999999999}"),
            "case.json: robots must be a whole number of at most 2147483647, not 99999999999");
  EXPECT_EQ(CaseError("{\"side_x\": true}"), "case.json: side_x must be a finite number, not true");
  EXPECT_EQ(CaseError("{\"side_x\": \"NaN\"}"),
            "case.json: side_x must be a finite number, not the text \"NaN\"");
  EXPECT_EQ(CaseError("[1]"), "case.json: the document must be an object { ... }, not a list");
  EXPECT_EQ(CaseError("{\"obstacles\": [null]}"),
            "case.json: obstacles[0] must be an object { ... }, not null");
}

TEST(CaseJsonTest, ANameThatNoRunMayHaveIsRefused) {
  EXPECT_EQ(CaseError("{\"name\": \"" + std::string(4097, 'x') + "\"}"),
            "case.json: name has 4097 bytes, 4096 are possible");
}

RC_GTEST_PROP(CaseJsonProperty, AnyBytesAreReadOrRefused, (const std::string& noise)) {
  const auto at = *rc::gen::inRange<std::size_t>(0, 200);
  std::string text = WriteCaseJson(SampleSpec().test_case);
  text.replace(std::min(at, text.size()), noise.size(), noise);
  const Result<sim::TestCase> parsed = ParseCaseJson(text, "f");
  if (!parsed.ok()) RC_ASSERT(parsed.error().message.starts_with("f:"));
}

}  // namespace
}  // namespace gauntlet::proto
