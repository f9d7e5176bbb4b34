#include "proto/run_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "proto/run.pb.h"
#include "sim/arena/validity.h"

namespace gauntlet::proto {
namespace {

using testing::ElementsAre;

rc::Gen<double> FiniteDouble() {
  return rc::gen::suchThat(rc::gen::map(rc::gen::arbitrary<std::uint64_t>(),
                                        [](std::uint64_t bits) { return std::bit_cast<double>(bits); }),
                           [](double value) { return std::isfinite(value); });
}

rc::Gen<std::string> Name() {
  return rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange('a', 'z')));
}

// The wire form of a spec and the same spec as a struct, made side by side.
struct SpecPair {
  v1::RunSpec wire;
  sim::RunSpec spec;
};

sim::Parameters ArbitraryParameters() {
  return *rc::gen::container<std::map<std::string, double>>(Name(), FiniteDouble());
}

template <typename List>
void Write(const sim::Parameters& parameters, List* wire) {
  for (const auto& [name, value] : parameters) {
    v1::Parameter& parameter = *wire->Add();
    parameter.set_name(name);
    parameter.set_value(value);
  }
}

SpecPair ArbitrarySpec() {
  SpecPair pair;
  sim::TestCase& test_case = pair.spec.test_case;
  v1::TestCase& wire = *pair.wire.mutable_test_case();
  test_case.name = *Name();
  wire.set_name(test_case.name);
  if (*rc::gen::arbitrary<bool>()) wire.set_side_x(test_case.side_x = *FiniteDouble());
  if (*rc::gen::arbitrary<bool>()) wire.set_side_y(test_case.side_y = *FiniteDouble());
  if (*rc::gen::arbitrary<bool>()) wire.set_wall_thickness(test_case.wall_thickness = *FiniteDouble());
  const int obstacles = *rc::gen::inRange(0, 12);
  for (int i = 0; i < obstacles; ++i) {
    const sim::ObstacleGene gene{*FiniteDouble(), *FiniteDouble(), *FiniteDouble(), *FiniteDouble(),
                                 *FiniteDouble()};
    test_case.obstacles.push_back(gene);
    v1::Obstacle& obstacle = *wire.add_obstacles();
    obstacle.set_x(gene.x);
    obstacle.set_y(gene.y);
    obstacle.set_length(gene.length);
    obstacle.set_width(gene.width);
    obstacle.set_orientation_deg(gene.orientation_deg);
  }
  if (*rc::gen::arbitrary<bool>()) {
    test_case.spawn_area = sim::Rectangle{.min = {1.0, 2.0}, .max = {*FiniteDouble(), 4.0}};
    wire.mutable_spawn_area()->set_min_x(1.0);
    wire.mutable_spawn_area()->set_min_y(2.0);
    wire.mutable_spawn_area()->set_max_x(test_case.spawn_area->max.x());
    wire.mutable_spawn_area()->set_max_y(4.0);
  }
  if (*rc::gen::arbitrary<bool>()) wire.set_robots(*(test_case.robots = *rc::gen::arbitrary<int>()));
  if (*rc::gen::arbitrary<bool>()) {
    test_case.start_poses = {{{*FiniteDouble(), 2.0}, 0.5}};
    v1::Pose& pose = *wire.add_start_poses();
    pose.set_x(test_case.start_poses[0].position.x());
    pose.set_y(2.0);
    pose.set_heading(0.5);
  }
  pair.wire.set_scenario(pair.spec.scenario = *Name());
  pair.wire.set_controller(pair.spec.controller = *Name());
  Write(pair.spec.scenario_parameters = ArbitraryParameters(), pair.wire.mutable_scenario_parameters());
  Write(pair.spec.controller_parameters = ArbitraryParameters(), pair.wire.mutable_controller_parameters());
  pair.wire.set_seed(pair.spec.seed = *rc::gen::arbitrary<std::uint64_t>());
  pair.wire.set_record_trajectory(pair.spec.record_trajectory = *rc::gen::arbitrary<bool>());
  const auto physics = *rc::gen::element(std::pair{v1::PHYSICS_UNSPECIFIED, sim::PhysicsKind::kBox2d},
                                         std::pair{v1::PHYSICS_RELAXATION, sim::PhysicsKind::kRelaxation},
                                         std::pair{v1::PHYSICS_IMPULSE, sim::PhysicsKind::kImpulse});
  pair.wire.set_physics(physics.first);
  pair.spec.physics = physics.second;
  return pair;
}

RC_GTEST_PROP(RunCodecProperty, SpecsDecodeToWhatWasSent, ()) {
  const SpecPair pair = ArbitrarySpec();
  const Result<sim::RunSpec> decoded = DecodeRunSpec(pair.wire.SerializeAsString());
  RC_ASSERT(decoded.ok());
  const sim::TestCase& expected = pair.spec.test_case;
  const sim::TestCase& actual = decoded->test_case;
  RC_ASSERT(actual.name == expected.name);
  RC_ASSERT(actual.side_x == expected.side_x);
  RC_ASSERT(actual.side_y == expected.side_y);
  RC_ASSERT(actual.wall_thickness == expected.wall_thickness);
  RC_ASSERT(actual.obstacles == expected.obstacles);
  RC_ASSERT(actual.robots == expected.robots);
  RC_ASSERT(actual.spawn_area.has_value() == expected.spawn_area.has_value());
  if (expected.spawn_area) {
    RC_ASSERT(actual.spawn_area->min == expected.spawn_area->min);
    RC_ASSERT(actual.spawn_area->max == expected.spawn_area->max);
  }
  RC_ASSERT(actual.start_poses.size() == expected.start_poses.size());
  if (!expected.start_poses.empty()) {
    RC_ASSERT(actual.start_poses[0].position == expected.start_poses[0].position);
    RC_ASSERT(actual.start_poses[0].heading == 0.5);
  }
  RC_ASSERT(decoded->scenario == pair.spec.scenario);
  RC_ASSERT(decoded->controller == pair.spec.controller);
  RC_ASSERT(decoded->scenario_parameters == pair.spec.scenario_parameters);
  RC_ASSERT(decoded->controller_parameters == pair.spec.controller_parameters);
  RC_ASSERT(decoded->seed == pair.spec.seed);
  RC_ASSERT(decoded->record_trajectory == pair.spec.record_trajectory);
  RC_ASSERT(decoded->physics == pair.spec.physics);
}

RC_GTEST_PROP(RunCodecProperty, GarbageIsAnErrorNeverACrash, (const std::string& bytes)) {
  const Result<sim::RunSpec> decoded = DecodeRunSpec(bytes);
  if (!decoded.ok()) RC_ASSERT(!decoded.error().message.empty());
}

TEST(RunCodecTest, AbsentSidesAreTheThesisArena) {
  const Result<sim::RunSpec> decoded = DecodeRunSpec(v1::RunSpec().SerializeAsString());
  ASSERT_TRUE(decoded.ok());
  EXPECT_EQ(decoded->test_case.side_x, 6.0);
  EXPECT_EQ(decoded->test_case.wall_thickness, 0.1);
  EXPECT_FALSE(decoded->test_case.robots.has_value());
}

std::string ErrorOf(const v1::RunSpec& wire) {
  const Result<sim::RunSpec> decoded = DecodeRunSpec(wire.SerializeAsString());
  return decoded.ok() ? "" : decoded.error().message;
}

TEST(RunCodecTest, RefusesMoreObstaclesThanAnArenaMayHave) {
  v1::RunSpec wire;
  for (std::size_t i = 0; i < sim::kMaxObstacles; ++i)
    wire.mutable_test_case()->add_obstacles()->set_length(1.0);
  EXPECT_EQ(ErrorOf(wire), "");
  wire.mutable_test_case()->add_obstacles();
  EXPECT_EQ(ErrorOf(wire), "1001 obstacles, 1000 are possible");
}

TEST(RunCodecTest, RefusesMoreParametersThanThereCanBe) {
  v1::RunSpec wire;
  for (int i = 0; i <= kMaxParameters; ++i) wire.add_controller_parameters()->set_name(std::to_string(i));
  EXPECT_EQ(ErrorOf(wire), "1001 parameters, 1000 are possible");
}

TEST(RunCodecTest, RefusesNumbersThatAreNotFiniteByName) {
  v1::RunSpec wire;
  wire.mutable_test_case()->add_obstacles()->set_width(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(ErrorOf(wire), "an obstacle's width is nan, a finite number is needed");
  wire.Clear();
  wire.mutable_test_case()->set_side_x(std::numeric_limits<double>::infinity());
  EXPECT_EQ(ErrorOf(wire), "side_x is inf, a finite number is needed");
  wire.Clear();
  wire.add_scenario_parameters()->set_name("duration");
  wire.mutable_scenario_parameters(0)->set_value(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(ErrorOf(wire), "duration is nan, a finite number is needed");
}

TEST(RunCodecTest, RefusesAParameterThatIsGivenTwice) {
  v1::RunSpec wire;
  wire.add_controller_parameters()->set_name("speed");
  wire.add_controller_parameters()->set_name("speed");
  EXPECT_EQ(ErrorOf(wire), "controller parameter 'speed' is given twice");
}

TEST(RunCodecTest, ObstaclesThatMoveAndShineDecodeToWhatWasSent) {
  v1::RunSpec wire;
  v1::Obstacle& obstacle = *wire.mutable_test_case()->add_obstacles();
  obstacle.set_length(1.0);
  obstacle.set_light("green");
  obstacle.mutable_motion()->set_speed(0.02);
  obstacle.mutable_motion()->add_path()->set_y(2.0);
  const Result<sim::RunSpec> decoded = DecodeRunSpec(wire.SerializeAsString());
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  const sim::ObstacleGene& gene = decoded->test_case.obstacles.at(0);
  EXPECT_EQ(gene.light, sim::Color::kGreen);
  EXPECT_EQ(gene.speed, 0.02);
  EXPECT_EQ(gene.path, (std::vector<sim::Vec2>{{0.0, 2.0}}));

  obstacle.set_light("mauve");
  EXPECT_EQ(ErrorOf(wire),
            "obstacle 1: 'mauve' is no colour of lights; known: black, red, green, blue, yellow, white, "
            "magenta, cyan, orange");
  obstacle.clear_light();
  obstacle.mutable_motion()->mutable_path(0)->set_x(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(ErrorOf(wire), "x of a path is nan, a finite number is needed");
  for (int i = 0; i < 16; ++i) obstacle.mutable_motion()->add_path();
  EXPECT_EQ(ErrorOf(wire), "17 points of a path, 16 are possible");
}

TEST(RunCodecTest, DisturbancesDecodeToWhatWasSent) {
  v1::RunSpec wire;
  v1::DeviceNoise& noise = *wire.add_noise();
  noise.set_device("range_and_bearing");
  noise.set_gaussian(0.05);
  noise.set_drop(0.1);
  wire.add_faults()->set_robot(3);
  wire.mutable_faults(0)->set_device("wheels");
  wire.mutable_faults(0)->set_tick(500);
  wire.add_faults()->set_tick(7);
  const Result<sim::RunSpec> decoded = DecodeRunSpec(wire.SerializeAsString());
  ASSERT_TRUE(decoded.ok()) << decoded.error().message;
  EXPECT_EQ(decoded->disturbances,
            (sim::Disturbances{.noise = {{sim::Device::kRangeAndBearing, {.gaussian = 0.05, .drop = 0.1}}},
                               .faults = {{.robot = 3, .device = sim::Device::kWheels, .tick = 500},
                                          {.robot = 0, .tick = 7}}}));
}

TEST(RunCodecTest, RandomFaultsArriveAndAreLeftOutWhereNobodyIsDrawn) {
  sim::RunSpec spec;
  spec.disturbances.random_faults = {
      .count = 2, .device = sim::Device::kWheels, .tick = 500, .role = sim::FaultyRole::kAll};
  EXPECT_EQ(DecodeRunSpec(EncodeRunSpec(spec))->disturbances, spec.disturbances);
  spec.disturbances.random_faults = {.count = 1};
  EXPECT_EQ(DecodeRunSpec(EncodeRunSpec(spec))->disturbances, spec.disturbances);
  spec.disturbances.random_faults = {.count = 0, .tick = 500};
  EXPECT_EQ(EncodeRunSpec(spec), EncodeRunSpec(sim::RunSpec()));
}

TEST(RunCodecTest, RefusesDisturbancesThatItDoesNotKnow) {
  v1::RunSpec wire;
  wire.add_noise()->set_device("sonar");
  EXPECT_EQ(ErrorOf(wire), "noise of 'sonar', which is no device");
  wire.mutable_noise(0)->set_device("light");
  wire.mutable_noise(0)->set_uniform(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(ErrorOf(wire), "uniform noise is nan, a finite number is needed");
  wire.mutable_noise(0)->set_uniform(0.1);
  wire.add_noise()->set_device("light");
  EXPECT_EQ(ErrorOf(wire), "noise of light is given twice");
  wire.Clear();
  wire.add_faults()->set_device("sonar");
  EXPECT_EQ(ErrorOf(wire), "a fault of 'sonar', which is no device");
  wire.Clear();
  wire.mutable_random_faults()->set_device("sonar");
  EXPECT_EQ(ErrorOf(wire), "a fault of 'sonar', which is no device");
}

TEST(RunCodecTest, RefusesNamesBeyondReason) {
  v1::RunSpec wire;
  wire.set_scenario(std::string(kMaxNameBytes + 1, 'x'));
  EXPECT_EQ(ErrorOf(wire), "a scenario's name of 4097 bytes, 4096 are possible");
}

TEST(RunCodecTest, RefusesFieldsOfALaterVersion) {
  v1::RunSpec wire;
  v1::TestCase& test_case = *wire.mutable_test_case();
  test_case.GetReflection()->MutableUnknownFields(&test_case)->AddVarint(77, 1);
  EXPECT_EQ(ErrorOf(wire), "test_case has fields that this version does not know");
}

sim::RunResult ExampleResult() {
  sim::RunResult result;
  result.fitness = 0.25;
  result.metrics = {{"proportion_left", 0.9}, {"angular_order", -0.0}};
  result.failure = {.total = true, .type = 7, .label = "split at the wall"};
  result.ticks = 2;
  result.robots = {{.start = {.position = {1.0, 2.0}, .heading = 0.5},
                    .end = {.position = {3.0, 4.0}, .heading = -0.5},
                    .path_length = 5.0,
                    .lost = true,
                    .waypoints = {{1.0, 2.0}, {3.0, 4.0}}}};
  result.annotations = {
      {.kind = "disc", .label = "goal", .points = {{5.0, 6.0}}, .radius = 0.3, .tick = 1, .robots = {0}}};
  result.trajectory_hash = 11;
  result.hash = 12;
  result.trajectory = {{{1.0, 2.0, 0.5, 0.0}}, {{3.0, 4.0, -0.5, 0.1}}};
  result.cpu_seconds = 0.125;
  return result;
}

TEST(RunCodecTest, ResultCarriesEveryField) {
  v1::RunResult wire;
  ASSERT_TRUE(wire.ParseFromString(EncodeRunResult(ExampleResult(), TrajectoryEncoding::kInclude)));
  EXPECT_EQ(wire.verdict(), v1::VERDICT_COMPLETED);
  EXPECT_EQ(wire.fitness(), 0.25);
  ASSERT_EQ(wire.metrics_size(), 2);
  EXPECT_EQ(wire.metrics(0).name(), "proportion_left");
  EXPECT_TRUE(std::signbit(wire.metrics(1).value())) << "the sign of a zero survives";
  EXPECT_TRUE(wire.failure().total());
  EXPECT_EQ(wire.failure().type(), 7);
  EXPECT_EQ(wire.failure().label(), "split at the wall");
  EXPECT_EQ(wire.ticks(), 2);
  ASSERT_EQ(wire.robots_size(), 1);
  EXPECT_EQ(wire.robots(0).end().heading(), -0.5);
  EXPECT_EQ(wire.robots(0).path_length(), 5.0);
  EXPECT_TRUE(wire.robots(0).lost());
  EXPECT_THAT(wire.robots(0).waypoints(), ElementsAre(1.0, 2.0, 3.0, 4.0));
  ASSERT_EQ(wire.annotations_size(), 1);
  EXPECT_EQ(wire.annotations(0).kind(), "disc");
  EXPECT_THAT(wire.annotations(0).points(), ElementsAre(5.0, 6.0));
  EXPECT_EQ(wire.annotations(0).tick(), 1);
  EXPECT_THAT(wire.annotations(0).robots(), ElementsAre(0));
  EXPECT_EQ(wire.trajectory_hash(), 11u);
  EXPECT_EQ(wire.hash(), 12u);
  EXPECT_EQ(wire.trajectory().robots(), 1);
  EXPECT_THAT(wire.trajectory().states(), ElementsAre(1.0, 2.0, 0.5, 0.0, 3.0, 4.0, -0.5, 0.1));
  EXPECT_EQ(wire.cpu_seconds(), 0.125);
}

TEST(RunCodecTest, TrajectoryIsLeftOutUnlessAskedFor) {
  v1::RunResult wire;
  ASSERT_TRUE(wire.ParseFromString(EncodeRunResult(ExampleResult(), TrajectoryEncoding::kLeaveOut)));
  EXPECT_FALSE(wire.has_trajectory());
}

TEST(RunCodecTest, EveryVerdictHasItsOwnNumberOnTheWire) {
  for (const auto& [verdict, expected] : {std::pair{sim::Verdict::kCompleted, v1::VERDICT_COMPLETED},
                                          {sim::Verdict::kRefused, v1::VERDICT_REFUSED},
                                          {sim::Verdict::kCrashed, v1::VERDICT_CRASHED},
                                          {sim::Verdict::kHung, v1::VERDICT_HUNG},
                                          {sim::Verdict::kOutOfMemory, v1::VERDICT_OUT_OF_MEMORY},
                                          {sim::Verdict::kInvalidCommand, v1::VERDICT_INVALID_COMMAND}}) {
    sim::RunResult result;
    result.verdict = verdict;
    v1::RunResult wire;
    ASSERT_TRUE(wire.ParseFromString(EncodeRunResult(result, TrajectoryEncoding::kLeaveOut)));
    EXPECT_EQ(wire.verdict(), expected);
  }
}

TEST(RunCodecTest, EqualResultsGiveEqualBytes) {
  EXPECT_EQ(EncodeRunResult(ExampleResult(), TrajectoryEncoding::kInclude),
            EncodeRunResult(ExampleResult(), TrajectoryEncoding::kInclude));
}

TEST(RunCodecDeathTest, TextThatNoReaderWouldAcceptEndsTheProcess) {
  sim::RunResult result;
  result.message = "\xff";
  EXPECT_DEATH(EncodeRunResult(result, TrajectoryEncoding::kLeaveOut), "not UTF-8");
}

}  // namespace
}  // namespace gauntlet::proto
