#include "proto/run_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "tests/master/dispatch/sample_runs.h"
#include "tests/sim/arena/random_genomes.h"

namespace gauntlet::proto {
namespace {

using testing::HasSubstr;

std::string CaseError(const std::string& text) {
  const Result<sim::TestCase> parsed = ParseCaseJson(text, "case.json");
  if (parsed) return "parsed";
  EXPECT_EQ(parsed.error().kind, ErrorKind::kInvalidInput);
  return parsed.error().message;
}

TEST(RunCodecTest, ARunSpecSurvivesTheRoundTrip) {
  const sim::RunSpec spec = SampleSpec();
  const std::string bytes = EncodeRunSpec(spec);
  const Result<sim::RunSpec> decoded = DecodeRunSpec(bytes);
  ASSERT_TRUE(decoded.ok());
  EXPECT_EQ(decoded->test_case.name, spec.test_case.name);
  EXPECT_EQ(decoded->test_case.obstacles, spec.test_case.obstacles);
  EXPECT_EQ(decoded->test_case.wall_thickness, 0.25);
  ASSERT_TRUE(decoded->test_case.spawn_area.has_value());
  EXPECT_EQ(decoded->test_case.spawn_area->max, sim::Vec2(1.5, 2.5));
  EXPECT_EQ(decoded->test_case.robots, 12);
  EXPECT_EQ(decoded->scenario, "flocking");
  EXPECT_EQ(decoded->scenario_parameters, spec.scenario_parameters);
  EXPECT_EQ(decoded->controller_parameters, spec.controller_parameters);
  EXPECT_EQ(decoded->seed, spec.seed);
  EXPECT_TRUE(decoded->record_trajectory);
  EXPECT_EQ(decoded->physics, sim::PhysicsKind::kRelaxation);
  EXPECT_EQ(decoded->disturbances, spec.disturbances);
  EXPECT_EQ(EncodeRunSpec(*decoded), bytes);
}

RC_GTEST_PROP(RunCodecProperty, CasesOfAllKindsOfGenesSurviveFilesAndSpecs, ()) {
  sim::RunSpec spec;
  spec.test_case.name = "all kinds";
  spec.test_case.obstacles = sim::ArbitraryGenome();
  const Result<sim::TestCase> read = ParseCaseJson(WriteCaseJson(spec.test_case), "case.json");
  RC_ASSERT(read.ok());
  RC_ASSERT(read->obstacles == spec.test_case.obstacles);
  const Result<sim::RunSpec> decoded = DecodeRunSpec(EncodeRunSpec(spec));
  RC_ASSERT(decoded.ok());
  RC_ASSERT(decoded->test_case.obstacles == spec.test_case.obstacles);
}

TEST(RunCodecTest, SeededSpecsHaveTheBytesOfWholeOnes) {
  sim::RunSpec spec = SampleSpec();
  SeededSpecs specs(spec);
  for (const std::uint64_t seed : {std::uint64_t{1}, ~std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{5}}) {
    spec.seed = seed;
    EXPECT_EQ(specs.Encode(seed), EncodeRunSpec(spec)) << seed;
  }
}

TEST(RunCodecTest, AnObstacleMayMoveAndShine) {
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
  EXPECT_THAT(CaseError(R"({"obstacles": [{"light": "mauve"}]})"),
              HasSubstr("case.json: obstacle 1: 'mauve' is no colour of lights; known: black, red,"));
  EXPECT_THAT(CaseError(R"({"obstacles": [{"motion": {"speeed": 1}}]})"), HasSubstr("speeed"));
}

TEST(RunCodecTest, AZeroIsNotADefault) {
  sim::RunSpec spec;
  spec.test_case.side_x = 0.0;
  spec.test_case.wall_thickness = 0.0;
  spec.test_case.robots = 0;
  const Result<sim::RunSpec> decoded = DecodeRunSpec(EncodeRunSpec(spec));
  EXPECT_EQ(decoded->test_case.side_x, 0.0);
  EXPECT_EQ(decoded->test_case.wall_thickness, 0.0);
  EXPECT_EQ(decoded->test_case.robots, 0);
  EXPECT_FALSE(decoded->test_case.spawn_area.has_value());
}

TEST(RunCodecTest, ARunResultSurvivesTheRoundTrip) {
  const sim::RunResult result = SampleResult(0.5);
  const std::string bytes = EncodeRunResult(result);
  const Result<sim::RunResult> decoded = DecodeRunResult(bytes);
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  EXPECT_EQ(sim::HashOf(*decoded), result.hash);
  EXPECT_EQ(decoded->annotations, result.annotations);
  EXPECT_EQ(decoded->robots.at(1).waypoints, result.robots.at(1).waypoints);
  EXPECT_EQ(decoded->metrics, result.metrics);
  EXPECT_EQ(decoded->cpu_seconds, result.cpu_seconds);
  ASSERT_EQ(decoded->trajectory.size(), 2U);
  EXPECT_EQ(decoded->trajectory[1].at(1).heading, result.trajectory[1].at(1).heading);
  EXPECT_EQ(EncodeRunResult(*decoded), bytes);
}

TEST(RunCodecTest, OddBitsOfNumbersSurvive) {
  for (const double odd : {-0.0, std::numeric_limits<double>::denorm_min(), std::nan("7"),
                           -std::numeric_limits<double>::infinity()}) {
    const sim::RunResult result = SampleResult(odd);
    const Result<sim::RunResult> decoded = DecodeRunResult(EncodeRunResult(result));
    ASSERT_TRUE(decoded.ok()) << odd << ": " << decoded.error().message;
    EXPECT_EQ(std::signbit(decoded->fitness), std::signbit(odd));
  }
}

TEST(RunCodecTest, TrajectoryAndCostDoNotChangeTheHash) {
  sim::RunResult result = SampleResult(0.5);
  result.trajectory.clear();
  result.cpu_seconds = 99.0;
  EXPECT_TRUE(DecodeRunResult(EncodeRunResult(result)).ok());
}

TEST(RunCodecTest, AResultWhoseHashDoesNotMatchIsCorrupt) {
  sim::RunResult result = SampleResult(0.5);
  result.fitness = 0.25;
  const Result<sim::RunResult> decoded = DecodeRunResult(EncodeRunResult(result));
  ASSERT_FALSE(decoded.ok());
  EXPECT_EQ(decoded.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(decoded.error().message, HasSubstr("hash"));
}

TEST(RunCodecTest, ARefusedRunMayHaveATrajectoryOfNoRobots) {
  sim::RunResult refused;
  refused.verdict = sim::Verdict::kRefused;
  refused.message = "no-room-to-spawn: 3 of 100 robots placed";
  refused.hash = sim::HashOf(refused);
  const std::string empty_trajectory("\x5a\x00", 2);  // field 11, no bytes
  const Result<sim::RunResult> decoded = DecodeRunResult(EncodeRunResult(refused) + empty_trajectory);
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  EXPECT_EQ(decoded->verdict, sim::Verdict::kRefused);
  EXPECT_TRUE(decoded->trajectory.empty());
}

TEST(RunCodecTest, UnreadableBytesAreCorrupt) {
  EXPECT_EQ(DecodeRunSpec("\xff\xff\xff").error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(DecodeRunResult("\xff\xff\xff").error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(DecodeRunResult("").error().message, HasSubstr("unknown verdict 0"));
}

RC_GTEST_PROP(RunCodecProperty, DamagedResultsAreNeverTakenForGood, ()) {
  const std::string good = EncodeRunResult(SampleResult(0.5));
  std::string bytes = good;
  const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
  bytes[at] = static_cast<char>(bytes[at] ^ *rc::gen::inRange(1, 256));
  const Result<sim::RunResult> decoded = DecodeRunResult(bytes);
  // A changed bit either does not decode or lies in what the hash does not cover.
  if (decoded.ok()) RC_ASSERT(decoded->hash == SampleResult(0.5).hash);
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
  EXPECT_EQ(CaseError(""), "case.json:1:1: expected a value, found the end of the file");
  EXPECT_EQ(CaseError("{\n  \"side_x\" 5\n}"), "case.json:2:12: expected ':', found '5'");
  EXPECT_EQ(CaseError("{\"side_x\": 5,\n}"), "case.json:2:1: expected a key in double quotes, found '}'");
  EXPECT_EQ(CaseError("{\"name\": \"\xC3\xBC\", x}"),
            "case.json:1:15: expected a key in double quotes, found 'x'");
  EXPECT_EQ(CaseError("{\"obstacles\": [{}\n{}]}"), "case.json:2:1: expected ',' or ']', found '{'");
  EXPECT_EQ(CaseError("{\"side_x\": 05}"), "case.json:1:12: '05' is not a number as JSON writes it");
  EXPECT_EQ(CaseError("{\"side_x\": 1e999}"), "case.json:1:12: 1e999 is beyond the range of a double");
  EXPECT_EQ(CaseError("{\"name\": \"abc"), "case.json:1:10: this text has no closing quote");
  EXPECT_EQ(CaseError("{} {}"), "case.json:1:4: only white space may follow the value, found '{'");
  EXPECT_EQ(CaseError("{\"name\": \"\xFF\"}"), "case.json:1:11: not valid UTF-8: byte 0xff");
  EXPECT_EQ(CaseError("{\"name\": \"\\ud800\"}"), "case.json:1:17: half of a surrogate pair");
  EXPECT_EQ(CaseError("{\"side_x\": 1,\n \"side_x\": 2}"), "case.json:2:2: 'side_x' stands here twice");
  EXPECT_EQ(CaseError("{\"side_x\": 1, \"sideX\": 2}"), "case.json:1:15: sideX is given under two spellings");
  EXPECT_THAT(CaseError(std::string(100, '[')), HasSubstr("nested deeper than 64 levels"));
}

TEST(CaseJsonTest, AnUnknownKeyIsRefusedWithTheNearestKnownOne) {
  EXPECT_EQ(CaseError("{\"obstacles\": [{\"x\": 1},\n  {\"lenght\": 2}]}"),
            "case.json:2:4: unknown key 'lenght' in obstacles[1]; did you mean 'length'?");
  EXPECT_EQ(CaseError("{\"quux\": 1}"),
            "case.json:1:2: unknown key 'quux'; known: name, sideX, sideY, wallThickness, obstacles, "
            "spawnArea, robots");
}

TEST(CaseJsonTest, AWrongTypeIsRefusedWhereItStands) {
  EXPECT_EQ(CaseError("{\"obstacles\": [{\"x\":\n \"abc\"}]}"),
            "case.json:2:2: obstacles[0].x must be a finite number, not the text \"abc\"");
  EXPECT_EQ(CaseError("{\"obstacles\": {}}"),
            "case.json:1:15: obstacles must be a list [ ... ], not an object");
  EXPECT_EQ(CaseError("{\"obstacles\": [[]]}"),
            "case.json:1:16: obstacles[0] must be an object { ... }, not a list");
  EXPECT_EQ(CaseError("{\"name\": 3}"), "case.json:1:10: name must be a text in double quotes, not 3");
  EXPECT_EQ(CaseError("{\"robots\": 1.5}"),
            "case.json:1:12: robots must be a whole number of at most 2147483647, not 1.5");
  EXPECT_EQ(CaseError("{\"robots\": 99999999999}"),
            "case.json:1:12: robots must be a whole number of at most 2147483647, not 99999999999");
  EXPECT_EQ(CaseError("{\"side_x\": true}"), "case.json:1:12: side_x must be a finite number, not true");
  EXPECT_EQ(CaseError("{\"side_x\": \"NaN\"}"),
            "case.json:1:12: side_x must be a finite number, not the text \"NaN\"");
  EXPECT_EQ(CaseError("[1]"), "case.json:1:1: the document must be an object { ... }, not a list");
  EXPECT_EQ(CaseError("{\"obstacles\": [null]}"),
            "case.json:1:16: obstacles[0] must be an object { ... }, not null");
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
