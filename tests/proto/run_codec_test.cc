// Covers: proto/run_result_codec.cc
#include "proto/run_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "proto/case_json.h"
#include "tests/master/dispatch/sample_runs.h"
#include "tests/sim/arena/random_genomes.h"

namespace gauntlet::proto {
namespace {

using testing::HasSubstr;

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

TEST(RunCodecTest, ADefinitionAndRequirementsTravelAndCostNothingWhereThereAreNone) {
  sim::RunSpec spec = SampleSpec();
  const std::string without = EncodeRunSpec(spec);
  spec.definition = "fitness = \"1\"\nlight.1.x = 0.5\n";
  spec.requirements = "stay = always speed > 0\n";
  const Result<sim::RunSpec> decoded = DecodeRunSpec(EncodeRunSpec(spec));
  ASSERT_TRUE(decoded.ok());
  EXPECT_EQ(decoded->definition, spec.definition);
  EXPECT_EQ(decoded->requirements, spec.requirements);
  const std::size_t bytes_of_fields = 2 + spec.definition.size() + 3 + spec.requirements.size();
  EXPECT_EQ(EncodeRunSpec(spec).size(), without.size() + bytes_of_fields);
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
  const SeededSpecs specs(spec);
  for (const std::uint64_t seed : {std::uint64_t{1}, ~std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{5}}) {
    spec.seed = seed;
    EXPECT_EQ(specs.Encode(seed), EncodeRunSpec(spec)) << seed;
    EXPECT_TRUE(specs.Encode(seed).starts_with(specs.head()));
  }
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
  sim::SetHashes(refused);
  const std::string empty_trajectory("\x5a\x00", 2);  // field 11, no bytes
  const Result<sim::RunResult> decoded = DecodeRunResult(EncodeRunResult(refused) + empty_trajectory);
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  EXPECT_EQ(decoded->verdict, sim::Verdict::kRefused);
  EXPECT_TRUE(decoded->trajectory.empty());
}

TEST(RunCodecTest, AResultMayLackItsWays) {
  const sim::RunResult result = SampleResult(0.5);
  const std::string bytes = EncodeWithoutWays(result);
  EXPECT_LT(bytes.size(), EncodeRunResult(result, TrajectoryEncoding::kLeaveOut).size());
  for (const Result<sim::RunResult>& decoded : {DecodeStoredResult(bytes), DecodeRunResult(bytes)}) {
    ASSERT_TRUE(decoded.ok()) << decoded.error().message;
    EXPECT_TRUE(decoded->without_ways);
    EXPECT_EQ(decoded->hash, result.hash);
    EXPECT_EQ(decoded->metrics, result.metrics);
    EXPECT_EQ(decoded->robots.at(1).path_length, result.robots.at(1).path_length);
    EXPECT_TRUE(decoded->robots.at(1).waypoints.empty());
    EXPECT_TRUE(decoded->annotations.empty());
    EXPECT_EQ(EncodeWithoutWays(*decoded), bytes);
    EXPECT_EQ(EncodeRunResult(*decoded, TrajectoryEncoding::kLeaveOut), bytes) << "they do not come back";
  }
}

TEST(RunCodecTest, AResultWithoutWaysHasAHashOfItsOwn) {
  sim::RunResult result = SampleResult(0.5);
  result.fitness = 0.25;
  const std::string changed = EncodeWithoutWays(result);
  EXPECT_THAT(DecodeRunResult(changed).error().message, HasSubstr("hash"));
  EXPECT_TRUE(DecodeStoredResult(changed).ok()) << "the store's checksum guards it";
  result = SampleResult(0.5);
  result.without_ways = true;
  EXPECT_EQ(DecodeRunResult(EncodeRunResult(result)).error().message,
            "the run result has ways that it is said to be without");
}

TEST(RunCodecTest, AStoredResultWithoutAnyWaysIsHeldAgainstItsHash) {
  sim::RunResult result;
  result.fitness = 0.5;
  sim::SetHashes(result);
  EXPECT_TRUE(DecodeStoredResult(EncodeWithoutWays(result)).ok());
  EXPECT_TRUE(DecodeStoredResult(EncodeRunResult(SampleResult(0.5))).ok()) << "whole ones are read, too";
  result.fitness = 0.25;
  EXPECT_FALSE(DecodeStoredResult(EncodeWithoutWays(result)).ok());
}

TEST(RunCodecTest, UnreadableBytesAreCorrupt) {
  EXPECT_EQ(DecodeRunSpec("\xff\xff\xff").error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(DecodeRunResult("\xff\xff\xff").error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(DecodeRunResult("").error().message, "the run result has the unknown verdict 0");
}

RC_GTEST_PROP(RunCodecProperty, DamagedResultsAreNeverTakenForGood, ()) {
  const sim::RunResult result = SampleResult(0.5);
  const bool with_ways = *rc::gen::arbitrary<bool>();
  std::string bytes = with_ways ? EncodeRunResult(result) : EncodeWithoutWays(result);
  const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
  bytes[at] = static_cast<char>(bytes[at] ^ *rc::gen::inRange(1, 256));
  const Result<sim::RunResult> decoded = DecodeRunResult(bytes);
  // A changed bit either does not decode or lies in what the hash does not cover.
  if (decoded.ok()) RC_ASSERT(decoded->hash == result.hash);
}

}  // namespace
TEST(RunCodecTest, ACentreIsWrittenOnlyWhereItIsNotTheOrigin) {
  sim::RunSpec spec = SampleSpec();
  const std::string bytes = EncodeRunSpec(spec);
  const std::string text = WriteCaseJson(spec.test_case);
  EXPECT_EQ(text.find("center"), std::string::npos);
  for (const auto& [center, fields] :
       {std::pair{sim::Vec2(1.0 / 3.0, -2.5), 2U}, {sim::Vec2(0.0, 1e-9), 1U}, {sim::Vec2(0.0, 0.0), 0U}}) {
    spec.test_case.center = center;
    EXPECT_EQ(EncodeRunSpec(spec).size(), bytes.size() + fields * 9);  // a tag and 8 bytes each
    EXPECT_EQ(DecodeRunSpec(EncodeRunSpec(spec))->test_case.center, center);
    EXPECT_EQ(ParseCaseJson(WriteCaseJson(spec.test_case), "case.json")->center, center);
  }
  EXPECT_EQ(EncodeRunSpec(spec), bytes);
  EXPECT_EQ(WriteCaseJson(spec.test_case), text);
}

}  // namespace gauntlet::proto
