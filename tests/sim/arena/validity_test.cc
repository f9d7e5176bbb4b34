#include "sim/arena/validity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "sim/arena/path_planner.h"
#include "tests/sim/arena/random_arenas.h"

namespace gauntlet::sim {
namespace {

using testing::CornerToCorner;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TestCase WithObstacles(const Genome& genome) {
  TestCase test_case;
  test_case.obstacles = genome;
  return test_case;
}

void ExpectViolation(const TestCase& test_case, const ArenaRequirements& requirements, ValidityRule rule,
                     int gene, const std::string& text) {
  const std::optional<Violation> violation = CheckValidity(test_case, requirements);
  ASSERT_TRUE(violation.has_value()) << "want " << NameOf(rule);
  EXPECT_EQ(NameOf(violation->rule), NameOf(rule)) << violation->message;
  EXPECT_EQ(violation->gene, gene) << violation->message;
  EXPECT_THAT(violation->message, HasSubstr(text));
}

TEST(ValidityTest, RuleNamesAreTheCommandLinesContract) {
  const std::map<ValidityRule, std::string> names = {{ValidityRule::kFiniteNumbers, "finite-numbers"},
                                                     {ValidityRule::kPositiveSize, "positive-size"},
                                                     {ValidityRule::kContainedObstacle, "contained-obstacle"},
                                                     {ValidityRule::kStartBlocked, "start-blocked"},
                                                     {ValidityRule::kGoalBlocked, "goal-blocked"},
                                                     {ValidityRule::kClearance, "clearance"},
                                                     {ValidityRule::kNoPath, "no-path"},
                                                     {ValidityRule::kLimits, "limits"},
                                                     {ValidityRule::kOutsideArena, "outside-arena"},
                                                     {ValidityRule::kKeepOut, "keep-out"}};
  for (const auto& [rule, name] : names) EXPECT_EQ(NameOf(rule), name);
}

TEST(ValidityTest, AnEmptyArenaAndOneWithAFewObstaclesAreValid) {
  EXPECT_FALSE(CheckValidity(TestCase{}, CornerToCorner()));
  const TestCase test_case = WithObstacles({{0.0, 0.0, 2.0, 0.4, 45.0}, {1.0, -1.0, 1.0, 0.1, 300.0}});
  EXPECT_FALSE(CheckValidity(test_case, CornerToCorner()));
}

TEST(ValidityTest, AnObstacleMustReachIntoTheArenaAtSomeTime) {
  const TestCase empty;
  const double outer = empty.side_x / 2.0 + empty.wall_thickness;
  const ObstacleGene touching = {outer + 0.5, 0.0, 1.0, 0.4, 0.0};
  EXPECT_FALSE(CheckValidity(WithObstacles({touching}), CornerToCorner()));
  for (const ObstacleGene& gene :
       {ObstacleGene{99.0, 0.0, 1.0, 0.4, 0.0}, ObstacleGene{0.0, -4.0, 1.0, 0.4, 0.0},
        ObstacleGene{outer + 0.501, 0.0, 1.0, 0.4, 0.0}}) {
    ExpectViolation(WithObstacles({{0.0, 0.0, 1.0, 0.4, 0.0}, gene}), CornerToCorner(),
                    ValidityRule::kOutsideArena, 1, "lies outside the arena");
  }
  ObstacleGene arriving = {5.0, 0.0, 1.0, 0.4, 0.0};
  arriving.path = {Vec2(0.0, 0.0)};
  arriving.speed = 0.02;
  EXPECT_FALSE(CheckValidity(WithObstacles({arriving}), CornerToCorner()));
}

TEST(ValidityTest, NumbersThatAreNotFiniteAreRefused) {
  for (const double bad : {kInfinity, -kInfinity, std::nan("")}) {
    for (const auto& field : {&ObstacleGene::x, &ObstacleGene::y, &ObstacleGene::length, &ObstacleGene::width,
                              &ObstacleGene::orientation_deg}) {
      ObstacleGene gene = {0.8, 2.4, 1.4, 0.4, 100.0};
      gene.*field = bad;
      ExpectViolation(WithObstacles({{0.0, 0.0, 1.0, 0.4, 0.0}, gene}), CornerToCorner(),
                      ValidityRule::kFiniteNumbers, 1, std::isnan(bad) ? "nan" : "inf");
    }
    for (const auto& field : {&TestCase::side_x, &TestCase::side_y, &TestCase::wall_thickness}) {
      TestCase test_case;
      test_case.*field = bad;
      ExpectViolation(test_case, CornerToCorner(), ValidityRule::kFiniteNumbers, -1, "the arena");
    }
    TestCase test_case;
    test_case.spawn_area = Rectangle{{2.0, bad}, {3.0, 3.0}};
    ExpectViolation(test_case, CornerToCorner(), ValidityRule::kFiniteNumbers, -1, "the spawn area");
  }
}

TEST(ValidityTest, SizesMustBePositive) {
  for (const double bad : {0.0, -0.0, -1.0, -1e308}) {
    ExpectViolation(WithObstacles({{0.0, 0.0, bad, 0.4, 0.0}}), CornerToCorner(), ValidityRule::kPositiveSize,
                    0, "obstacle 1");
    ExpectViolation(WithObstacles({{0.0, 0.0, 0.4, bad, 0.0}}), CornerToCorner(), ValidityRule::kPositiveSize,
                    0, "must have a positive length and width");
    TestCase test_case;
    test_case.side_y = bad;
    ExpectViolation(test_case, CornerToCorner(), ValidityRule::kPositiveSize, -1, "positive sides");
  }
  TestCase test_case;
  test_case.spawn_area = Rectangle{{2.0, 2.0}, {1.0, 3.0}};
  ExpectViolation(test_case, CornerToCorner(), ValidityRule::kPositiveSize, -1, "from (2, 2) to (1, 3)");
}

TEST(ValidityTest, AbsurdNumbersAreRefusedAtOnce) {
  for (const ObstacleGene& gene : {ObstacleGene{1e308, 0, 1, 1, 0}, ObstacleGene{0, -1000.5, 1, 1, 0},
                                   ObstacleGene{0, 0, 200.5, 1, 0}, ObstacleGene{0, 0, 1, 1e300, 0},
                                   ObstacleGene{0, 0, 1e-300, 1, 0}, ObstacleGene{0, 0, 1, 0.0009, 0}}) {
    ExpectViolation(WithObstacles({gene}), CornerToCorner(), ValidityRule::kLimits, 0, "obstacle 1");
  }
  const auto refuse = [](const std::function<void(TestCase&)>& change, const std::string& text) {
    TestCase test_case;
    change(test_case);
    ExpectViolation(test_case, CornerToCorner(), ValidityRule::kLimits, -1, text);
  };
  refuse([](TestCase& t) { t.side_x = 1e308; }, "sides of 1 to 100 m");
  refuse([](TestCase& t) { t.side_x = 100.001; }, "sides of 1 to 100 m");
  refuse([](TestCase& t) { t.side_y = 0.999; }, "sides of 1 to 100 m");
  refuse([](TestCase& t) { t.wall_thickness = 1e-9; }, "walls of 0.001 m");
  refuse([](TestCase& t) { t.wall_thickness = 3.5; }, "half of its shorter side");
  refuse([](TestCase& t) { t.spawn_area = Rectangle{{-1e300, 0}, {0, 0}}; }, "within 1000 m");
  refuse([](TestCase& t) { t.robots = 0; }, "0 robots; want 1 to 1000");
  refuse([](TestCase& t) { t.robots = 1'000'000'000; }, "1000000000 robots");
  refuse([](TestCase& t) { t.obstacles.resize(1001, {0, 0, 1, 1, 0}); }, "1001 obstacles; want at most 1000");
}

TEST(ValidityTest, TheLimitsThemselvesAreAllowed) {
  TestCase large;
  large.side_x = 100.0;
  large.side_y = 1.0;
  large.robots = 1000;
  large.obstacles = {{150.0, -105.0, 200.0, 200.0, 7.0}, {0.0, 0.5, 0.001, 0.001, 1e9}};
  ArenaRequirements requirements;
  requirements.start = {-49.0, 0.0};
  requirements.goal = {49.0, 0.0};
  EXPECT_FALSE(CheckValidity(large, requirements));
}

TEST(ValidityTest, AnObstacleInsideAnEarlierOneIsRefusedInThatOrderOnly) {
  const ObstacleGene outer = {0.0, 0.0, 2.0, 0.4, 30.0};
  const ObstacleGene other = {1.5, -1.5, 1.0, 0.4, 0.0};
  const ObstacleGene inner = {0.1, 0.05, 0.5, 0.1, 30.0};
  ExpectViolation(WithObstacles({other, outer, inner}), CornerToCorner(), ValidityRule::kContainedObstacle, 2,
                  "obstacle 3 (x 0.1 m, y 0.05 m, 0.5 x 0.1 m at 30 degrees) lies wholly inside obstacle 2");
  ExpectViolation(WithObstacles({outer, outer}), CornerToCorner(), ValidityRule::kContainedObstacle, 1,
                  "inside obstacle 1");
  EXPECT_FALSE(CheckValidity(WithObstacles({inner, outer}), CornerToCorner()));
}

TEST(ValidityTest, AnObstacleCoveredOnlyByTwoTogetherIsAllowed) {
  const TestCase test_case =
      WithObstacles({{-0.5, 0.0, 1.0, 0.4, 0.0}, {0.5, 0.0, 1.0, 0.4, 0.0}, {0.0, 0.0, 0.6, 0.2, 0.0}});
  EXPECT_FALSE(CheckValidity(test_case, CornerToCorner()));
}

TEST(ValidityTest, ObstaclesKeepTheirClearanceFromStartAndGoal) {
  ArenaRequirements requirements;
  requirements.start = {0.0, -2.0};
  requirements.goal = {0.0, 2.0};
  requirements.clearance = 0.30;
  ExpectViolation(WithObstacles({{0.4, -2.0, 0.4, 0.4, 0.0}}), requirements, ValidityRule::kClearance, 0,
                  "from the start (0, -2); want at least 0.3 m");
  ExpectViolation(WithObstacles({{0.0, 2.45, 1.0, 0.4, 0.0}}), requirements, ValidityRule::kClearance, 0,
                  "from the goal (0, 2)");
  EXPECT_FALSE(CheckValidity(WithObstacles({{0.51, -2.0, 0.4, 0.4, 0.0}}), requirements));
}

TEST(ValidityTest, StartAndGoalMustBeFree) {
  ExpectViolation(WithObstacles({{2.5, 2.4, 1.0, 0.1, 0.0}}), CornerToCorner(), ValidityRule::kStartBlocked,
                  0, "blocks the start (2.5, 2.5); a robot's centre needs 0.1 m of room there");
  ExpectViolation(WithObstacles({{-2.5, -2.5, 0.1, 0.1, 0.0}}), CornerToCorner(), ValidityRule::kGoalBlocked,
                  0, "blocks the goal (-2.5, -2.5)");
  ArenaRequirements requirements = CornerToCorner();
  requirements.goal = {5.0, 0.0};
  ExpectViolation(TestCase{}, requirements, ValidityRule::kGoalBlocked, -1,
                  "the wall blocks the goal (5, 0)");
  requirements.goal = {std::nan(""), 0.0};
  ExpectViolation(TestCase{}, requirements, ValidityRule::kGoalBlocked, -1, "nan");
}

TEST(ValidityTest, AnObstacleThatClosesTheLastWayIsNamed) {
  const TestCase test_case =
      WithObstacles({{0.0, -0.5, 5.0, 0.2, 90.0}, {-2.0, 2.0, 0.5, 0.2, 0.0}, {0.0, 2.4, 1.4, 0.4, 100.0}});
  ExpectViolation(test_case, CornerToCorner(), ValidityRule::kNoPath, 2,
                  "obstacle 3 (x 0 m, y 2.4 m, 1.4 x 0.4 m at 100 degrees) leaves no path from (2.5, 2.5) to "
                  "(-2.5, -2.5) for a robot's body");
}

TEST(ValidityTest, AGapCountsOnlyWhenTheBodyFits) {
  // Two walls across the whole arena with a gap in the middle.
  const auto with_gap = [](double gap) {
    const double length = 3.0 - gap / 2.0;
    const double middle = (3.0 + gap / 2.0) / 2.0;
    return WithObstacles({{0.0, middle, 0.2, length, 0.0}, {0.0, -middle, 0.2, length, 0.0}});
  };
  EXPECT_FALSE(CheckValidity(with_gap(0.30), CornerToCorner()));
  EXPECT_TRUE(CheckValidity(with_gap(0.15), CornerToCorner()));
  ArenaRequirements point_robot = CornerToCorner();
  point_robot.inflation = 0.0;
  EXPECT_FALSE(CheckValidity(with_gap(0.15), point_robot));
}

TEST(IncrementalValidityTest, AgreesWithCheckValidityGeneByGene) {
  RandomStream random(51, StreamPurpose::kTest);
  ArenaRequirements requirements = CornerToCorner();
  requirements.clearance = 0.3;
  std::set<ValidityRule> seen;
  for (int i = 0; i < 60; ++i) {
    IncrementalValidity validity(TestCase{}, requirements);
    TestCase test_case;
    for (int j = 0; j < 25; ++j) {
      ObstacleGene gene = testing::RandomGene(random, 3.0);
      if (random.Chance(0.1)) gene.width = gene.length = 0.15;
      test_case.obstacles.push_back(gene);
      const std::optional<Violation> whole = CheckValidity(test_case, requirements);
      const std::optional<Violation> step = validity.TryAppend(gene);
      ASSERT_EQ(whole.has_value(), step.has_value());
      if (!step) continue;
      seen.insert(step->rule);
      ASSERT_EQ(whole->rule, step->rule);
      ASSERT_EQ(whole->gene, step->gene);
      ASSERT_EQ(whole->message, step->message);
      test_case.obstacles.pop_back();
    }
    ASSERT_EQ(validity.size(), test_case.obstacles.size());
    // Refused genes have left no trace.
    ASSERT_EQ(validity.grid().blocked(), OccupancyGrid(Arena(test_case), requirements.inflation).blocked());
  }
  EXPECT_TRUE(seen.contains(ValidityRule::kNoPath));
  EXPECT_TRUE(seen.contains(ValidityRule::kClearance));
  EXPECT_TRUE(seen.contains(ValidityRule::kContainedObstacle));
}

TEST(IncrementalValidityTest, ValidMeansThatThePlannerFindsAPathAndNoPathThatItFindsNone) {
  RandomStream random(52, StreamPurpose::kTest);
  const ArenaRequirements requirements = CornerToCorner();
  int no_path = 0;
  for (int i = 0; i < 150; ++i) {
    const TestCase test_case = testing::AnyTestCase(random, 10, 4.0);
    const std::optional<Violation> violation = CheckValidity(test_case, requirements);
    const OccupancyGrid grid(Arena(test_case), requirements.inflation);
    const bool found = !PlanPath(grid, requirements.start, requirements.goal).empty();
    if (!violation) {
      ASSERT_TRUE(found);
    } else if (violation->rule == ValidityRule::kNoPath) {
      ASSERT_FALSE(found);
      ++no_path;
    }
  }
  EXPECT_GT(no_path, 10);
}

TEST(IncrementalValidityTest, MotionBeyondTheLimitsIsNamed) {
  const auto judge = [](const ObstacleGene& gene, const ArenaRequirements& requirements) {
    IncrementalValidity validity(TestCase{}, requirements);
    const std::optional<Violation> violation = validity.TryAppend(gene);
    return violation ? std::string(NameOf(violation->rule)) + ": " + violation->message
                     : std::string("valid");
  };
  ObstacleGene gene = {0.0, 0.0, 1.0, 0.2, 0.0};
  gene.path = {{0.0, 1.0}};
  gene.speed = 0.05;
  EXPECT_EQ(judge(gene, CornerToCorner()), "valid");
  gene.speed = 0.06;
  EXPECT_EQ(
      judge(gene, CornerToCorner()),
      "limits: obstacle 1 (x 0 m, y 0 m, 1 x 0.2 m at 0 degrees) moves at 0.06 m/s; want 0 to 0.05 m/s");
  gene.speed = 0.0;
  EXPECT_EQ(judge(gene, CornerToCorner()),
            "limits: obstacle 1 (x 0 m, y 0 m, 1 x 0.2 m at 0 degrees) has a path of 1 points and a speed of "
            "0 m/s; want both or neither");
  gene.speed = -0.01;
  EXPECT_EQ(
      judge(gene, CornerToCorner()),
      "limits: obstacle 1 (x 0 m, y 0 m, 1 x 0.2 m at 0 degrees) moves at -0.01 m/s; want 0 to 0.05 m/s");
  gene.speed = std::nan("");
  EXPECT_EQ(judge(gene, CornerToCorner()),
            "finite-numbers: obstacle 1 (x 0 m, y 0 m, 1 x 0.2 m at 0 degrees) moves along numbers that are "
            "not finite");
  gene.speed = 0.05;
  gene.path = {{0.0, 1e6}};
  EXPECT_EQ(judge(gene, CornerToCorner()),
            "limits: obstacle 1 (x 0 m, y 0 m, 1 x 0.2 m at 0 degrees) moves to (0, 1e+06) m; want paths "
            "within 1000 m of the origin");
  gene.path.assign(kMaxObstaclePath + 1, {0.0, 1.0});
  EXPECT_EQ(
      judge(gene, CornerToCorner()),
      "limits: obstacle 1 (x 0 m, y 0 m, 1 x 0.2 m at 0 degrees) has a path of 17 points; want at most 16");

  ArenaRequirements keep_away = CornerToCorner();
  keep_away.clearance = 0.5;
  gene.path = {{0.0, 1.0}};
  EXPECT_EQ(judge(gene, keep_away), "valid");
  gene.path = {keep_away.goal};
  EXPECT_EQ(judge(gene, keep_away),
            "clearance: obstacle 1 (x 0 m, y 0 m, 1 x 0.2 m at 0 degrees) is 0 m from the goal (-2.5, -2.5); "
            "want at least 0.5 m");
}

TEST(IncrementalValidityTest, CopiesContinueIndependently) {
  IncrementalValidity validity(TestCase{}, CornerToCorner());
  ASSERT_FALSE(validity.TryAppend({0.0, 0.0, 1.0, 0.2, 0.0}));
  IncrementalValidity copy = validity;
  ASSERT_FALSE(copy.TryAppend({1.0, -1.0, 1.0, 0.2, 0.0}));
  EXPECT_EQ(validity.size(), 1u);
  EXPECT_EQ(copy.size(), 2u);
  EXPECT_NE(validity.grid().blocked(), copy.grid().blocked());
}

TEST(IncrementalValidityTest, AnImpossibleArenaTakesNoGene) {
  TestCase test_case;
  test_case.side_x = std::nan("");
  IncrementalValidity validity(test_case, CornerToCorner());
  ASSERT_TRUE(validity.arena_violation());
  const std::optional<Violation> violation = validity.TryAppend({0.0, 0.0, 1.0, 0.2, 0.0});
  ASSERT_TRUE(violation);
  EXPECT_EQ(violation->rule, ValidityRule::kFiniteNumbers);
}

TEST(Validity, TheArenaStaysOpenWhereThatIsAskedFor) {
  ArenaRequirements requirements = CornerToCorner();
  requirements.open_share = 0.75;
  // Two walls that close off a corner of about a third of the arena's area.
  TestCase test_case;
  test_case.obstacles = {{-1.3, 0.3, 3.4, 0.2, 0.0}, {0.3, 1.65, 0.2, 2.8, 0.0}};
  const auto violation = CheckValidity(test_case, requirements);
  ASSERT_TRUE(violation);
  EXPECT_EQ(NameOf(violation->rule), "open-area");
  EXPECT_EQ(violation->gene, 1);
  EXPECT_THAT(violation->message,
              ::testing::HasSubstr("% of what it reaches in the empty arena; want at least 75 %"));
  test_case.obstacles.pop_back();
  EXPECT_FALSE(CheckValidity(test_case, requirements)) << "the first wall alone closes nothing off";
  test_case.obstacles = {{-1.3, 0.3, 3.4, 0.2, 0.0}, {0.3, 1.65, 0.2, 2.8, 0.0}};
  requirements.open_share = 0.5;
  EXPECT_FALSE(CheckValidity(test_case, requirements));
  requirements.open_share = 0.0;
  EXPECT_FALSE(CheckValidity(test_case, requirements)) << "nobody asks";
}

}  // namespace
// With numbers that are sums of few powers of two all sums are exact.
RC_GTEST_PROP(ValidityProperty, ATranslatedArenaGivesTheSameVerdicts, ()) {
  const auto dyadic = [](int least, int most) { return *rc::gen::inRange(least, most + 1) / 16.0; };
  ArenaRequirements requirements = CornerToCorner();
  requirements.inflation = 0.125;
  requirements.cell_size = 0.0625;
  requirements.clearance = 0.5;
  requirements.further_goals = {{2.5, -2.5}};
  requirements.keep_outs = {{{{1.0, 1.0}, {0.25, 0.5}}}, {{{-1.0, 0.0}, {0.0, 0.0}}, 0.25}};
  requirements.standing = {{{{0.0, -2.0}, {0.0, 0.0}}, 0.5}};
  requirements.anywhere = true;
  requirements.open_share = 0.6;
  const Vec2 shift(std::exp2(*rc::gen::inRange(-2, 9)), -std::exp2(*rc::gen::inRange(-2, 9)));
  ArenaRequirements shifted = requirements;
  shifted.start += shift;
  shifted.goal += shift;
  for (Vec2& goal : shifted.further_goals) goal += shift;
  for (auto* boxes : {&shifted.keep_outs, &shifted.standing})
    for (RoundedBox& one : *boxes) one.box.center += shift;
  TestCase there;
  there.center = shift;
  IncrementalValidity here_judge(TestCase{}, requirements);
  IncrementalValidity there_judge(there, shifted);
  RC_ASSERT(!here_judge.arena_violation() && !there_judge.arena_violation());
  for (int i = 0; i < 12; ++i) {
    ObstacleGene gene = {dyadic(-60, 60), dyadic(-60, 60), dyadic(1, 60), dyadic(1, 8),
                         static_cast<double>(*rc::gen::inRange(0, 360))};
    if (*rc::gen::inRange(0, 4) == 0) {
      gene.path = {{dyadic(-48, 48), dyadic(-48, 48)}};
      gene.speed = 0.03125;
    }
    ObstacleGene moved = gene;
    moved.x += shift.x();
    moved.y += shift.y();
    for (Vec2& point : moved.path) point += shift;
    const auto here_violation = here_judge.TryAppend(gene);
    const auto there_violation = there_judge.TryAppend(moved);
    RC_ASSERT(here_violation.has_value() == there_violation.has_value());
    if (here_violation) RC_ASSERT(here_violation->rule == there_violation->rule);
  }
  RC_ASSERT(here_judge.grid().blocked() == there_judge.grid().blocked());
}

TEST(ValidityTest, OnlyScenariosThatSaySoHaveArenasElsewhere) {
  TestCase test_case;
  test_case.center = {0.25, 0.0};
  ArenaRequirements requirements = CornerToCorner();
  ExpectViolation(test_case, requirements, ValidityRule::kLimits, -1,
                  "the arena lies around (0.25, 0) m, but this scenario is simulated around the origin only");
  requirements.anywhere = true;
  EXPECT_FALSE(CheckValidity(test_case, requirements));
  test_case.obstacles = {{-3.2, 0.0, 0.5, 0.5, 0.0}};
  ExpectViolation(test_case, requirements, ValidityRule::kOutsideArena, 0,
                  "lies outside the arena, which reaches from (-2.85, -3.1) to (3.35, 3.1) m with its walls");
  test_case.center = {998.0, 0.0};
  ExpectViolation(test_case, requirements, ValidityRule::kLimits, -1, "must end within 1000 m of the origin");
  test_case.center = {kInfinity, 0.0};
  ExpectViolation(test_case, requirements, ValidityRule::kFiniteNumbers, -1, "which is not finite");
}

TEST(ValidityTest, NoObstacleTouchesAKeepOut) {
  ArenaRequirements requirements = CornerToCorner();
  requirements.keep_outs = {{{{1.0, 0.0}, {0.5, 0.25}}}, {{{-1.0, 0.0}, Vec2::Zero()}, 0.5}};
  EXPECT_FALSE(
      CheckValidity(WithObstacles({{1.0, 0.75, 2.0, 0.5, 0.0}, {-1.0, 0.875, 1.0, 0.5, 0.0}}), requirements));
  ExpectViolation(WithObstacles({{1.0, 0.5, 2.0, 0.5, 0.0}}), requirements, ValidityRule::kKeepOut, 0,
                  "touches keep-out 1, around (1, 0), where no obstacle may be");
  ExpectViolation(WithObstacles({{-1.0, 0.75, 1.0, 0.5, 0.0}}), requirements, ValidityRule::kKeepOut, 0,
                  "touches keep-out 2, around (-1, 0), where no obstacle may be");
  TestCase moving = WithObstacles({{-2.0, 1.0, 0.2, 0.2, 0.0}});
  EXPECT_FALSE(CheckValidity(moving, requirements));
  moving.obstacles[0].path = {{-2.0, 0.0}, {0.0, 0.0}};
  moving.obstacles[0].speed = 0.02;
  ExpectViolation(moving, requirements, ValidityRule::kKeepOut, 0, "touches keep-out 2");
}

TEST(ValidityTest, WhatStandsInTheArenaIsJudgedBeforeAnyObstacle) {
  ArenaRequirements requirements = CornerToCorner();
  requirements.standing = {{{{0.0, 1.6}, {0.1, 1.4}}}, {{{0.0, -1.6}, {0.1, 1.4}}}};
  EXPECT_FALSE(CheckValidity({}, requirements));  // a gap of 0.4 m
  ExpectViolation(WithObstacles({{0.0, 0.0, 0.2, 0.3, 0.0}}), requirements, ValidityRule::kNoPath, 0,
                  "obstacle 1");
  requirements.standing.push_back({{{0.0, 0.0}, Vec2::Zero()}, 0.15});
  ExpectViolation({}, requirements, ValidityRule::kNoPath, -1,
                  "what stands in the arena itself leaves no path from (2.5, 2.5) to (-2.5, -2.5)");
  requirements.standing.push_back({{{2.5, 2.5}, {0.1, 0.1}}});
  ExpectViolation({}, requirements, ValidityRule::kStartBlocked, -1,
                  "what stands in the arena itself blocks");
}

TEST(ValidityTest, EveryFurtherGoalIsConnectedWithTheStart) {
  ArenaRequirements requirements = CornerToCorner();
  requirements.clearance = 0.2;
  requirements.further_goals = {{2.5, -2.5}, {-2.5, 2.5}};
  EXPECT_FALSE(CheckValidity({}, requirements));
  ExpectViolation(WithObstacles({{-2.1, 2.1, 2.6, 0.1, 45.0}}), requirements, ValidityRule::kNoPath, 0,
                  "leaves no path from (2.5, 2.5) to (-2.5, 2.5)");
  ExpectViolation(WithObstacles({{2.5, -2.25, 0.2, 0.2, 0.0}}), requirements, ValidityRule::kClearance, 0,
                  "is 0.15 m from the goal (2.5, -2.5)");
  requirements.clearance = 0.0;
  ExpectViolation(WithObstacles({{2.5, -2.5, 0.2, 0.2, 0.0}}), requirements, ValidityRule::kGoalBlocked, 0,
                  "blocks the goal (2.5, -2.5)");
}

TEST(ValidityTest, AScenarioMayAskForNoPath) {
  ArenaRequirements requirements;
  requirements.start = requirements.goal = {50.0, 50.0};
  requirements.clearance = 100.0;
  requirements.asks_for_path = false;
  EXPECT_FALSE(CheckValidity(WithObstacles({{0.0, 0.0, 6.0, 6.0, 0.0}}), requirements));
}

TEST(ValidityTest, SmallArenasNeedAScenarioThatTakesThemAndGridsHaveALimit) {
  TestCase small;
  small.side_x = small.side_y = 0.1;
  small.wall_thickness = 0.01;
  ArenaRequirements requirements;
  ExpectViolation(small, requirements, ValidityRule::kLimits, -1, "must have sides of 1 to 100 m");
  requirements.least_side = 0.1;
  requirements.inflation = 0.017;
  requirements.cell_size = 0.0085;
  EXPECT_FALSE(CheckValidity(small, requirements));
  TestCase large;
  large.side_x = large.side_y = 100.0;
  ExpectViolation(large, requirements, ValidityRule::kLimits, -1,
                  "has more than 4 million cells of 0.0085 m, in which ways are looked for");
  requirements.cell_size = 0.05;
  EXPECT_FALSE(CheckValidity(large, requirements));
  requirements.cell_size = std::nan("");
  ExpectViolation(large, requirements, ValidityRule::kLimits, -1, "cells of nan m");
}

}  // namespace gauntlet::sim
