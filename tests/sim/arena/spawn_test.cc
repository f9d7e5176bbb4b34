#include "sim/arena/spawn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "sim/geometry/trigonometry.h"
#include "tests/sim/arena/random_arenas.h"

namespace gauntlet::sim {
namespace {

using ::testing::AllOf;
using testing::GridWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kRadius = 0.085036758;

// The flocking scenario's birds.
SpawnRequest Birds() {
  SpawnRequest request;
  request.count = 10;
  request.area = {{2.0, 2.0}, {3.0, 3.0}};
  request.robot_radius = kRadius;
  request.start = {2.5, 2.5};
  return request;
}

RandomStream SpawnStream(std::uint64_t seed) {
  return RandomStream(seed, StreamPurpose::kSpawn);
}

std::string ErrorOf(const SpawnRequest& request, const OccupancyGrid& grid) {
  RandomStream random = SpawnStream(1);
  const Result<std::vector<Pose>> poses = Spawn(request, grid, random);
  return poses.ok() ? "spawned" : poses.error().message;
}

TEST(SpawnTest, BirdsStandInTheirAreaWithoutOverlap) {
  const OccupancyGrid grid = GridWith({});
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random = SpawnStream(seed);
    const Result<std::vector<Pose>> poses = Spawn(Birds(), grid, random);
    ASSERT_TRUE(poses.ok());
    ASSERT_EQ(poses->size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
      const Pose& pose = (*poses)[i];
      ASSERT_GE(pose.position.minCoeff(), 2.0);
      ASSERT_LE(pose.position.maxCoeff(), 2.95 - kRadius - 0.01 + 1e-12);
      ASSERT_GT(pose.heading, -kPi);
      ASSERT_LE(pose.heading, kPi);
      for (std::size_t j = 0; j < i; ++j) {
        ASSERT_GE((pose.position - (*poses)[j].position).norm(), 2.0 * kRadius + 0.01 - 1e-12);
      }
    }
  }
}

TEST(SpawnTest, PosesDependOnTheStreamAlone) {
  const OccupancyGrid grid = GridWith({});
  RandomStream first = SpawnStream(5);
  RandomStream again = SpawnStream(5);
  RandomStream other = SpawnStream(6);
  const auto a = Spawn(Birds(), grid, first).value();
  const auto b = Spawn(Birds(), grid, again).value();
  const auto c = Spawn(Birds(), grid, other).value();
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].heading, b[i].heading);
    EXPECT_NE(a[i].position, c[i].position);
  }
}

TEST(SpawnTest, PositionsAndHeadingsAreUniform) {
  const OccupancyGrid grid = GridWith({});
  SpawnRequest request = Birds();
  request.count = 1;
  request.area = {{-1.0, -0.5}, {1.0, 0.5}};
  request.start = Vec2::Zero();
  constexpr int kRuns = 20'000;
  std::vector<int> cells(40, 0);
  std::vector<int> sectors(36, 0);
  RandomStream random = SpawnStream(9);
  for (int i = 0; i < kRuns; ++i) {
    const Pose pose = Spawn(request, grid, random).value().front();
    const auto column = static_cast<std::size_t>((pose.position.x() + 1.0) / 2.0 * 10.0);
    const auto row = static_cast<std::size_t>((pose.position.y() + 0.5) * 4.0);
    ++cells[row * 10 + column];
    ++sectors[static_cast<std::size_t>((kPi - pose.heading) / (2.0 * kPi) * 36.0)];
  }
  const auto chi_square = [&](const std::vector<int>& counts) {
    const double expected = static_cast<double>(kRuns) / static_cast<double>(counts.size());
    double sum = 0.0;
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    return sum;
  };
  EXPECT_LT(chi_square(cells), 39.0 + 4.0 * std::sqrt(2.0 * 39.0));
  EXPECT_LT(chi_square(sectors), 35.0 + 4.0 * std::sqrt(2.0 * 35.0));
}

TEST(SpawnTest, ADiscIsFilledUniformly) {
  const OccupancyGrid grid = GridWith({});
  SpawnRequest request = Birds();
  request.count = 1;
  request.disc = true;
  request.area = {{-0.8, -1.8}, {0.8, -0.2}};
  request.start = {0.0, -1.0};
  RandomStream random = SpawnStream(10);
  int inner = 0;
  for (int i = 0; i < 10'000; ++i) {
    const double distance = (Spawn(request, grid, random).value().front().position - request.start).norm();
    ASSERT_LE(distance, 0.8 + 1e-12);
    inner += distance < 0.4 ? 1 : 0;
  }
  EXPECT_NEAR(inner, 2500, 4 * 43) << "a quarter of the area lies within half the radius";
}

TEST(SpawnTest, BodiesTouchNeitherObstaclesNorRobotsThatAreThereAndCanReachTheStart) {
  RandomStream random = SpawnStream(11);
  int crowded = 0;
  for (int i = 0; i < 150; ++i) {
    const Arena arena(testing::ValidTestCase(random, 16, testing::CornerToCorner()));
    const OccupancyGrid grid(arena, OccupancyGrid::kDefaultInflation);
    SpawnRequest request = Birds();
    request.occupied = {{2.5, 2.5}};
    const Result<std::vector<Pose>> poses = Spawn(request, grid, random);
    if (!poses.ok()) {
      ++crowded;
      continue;
    }
    const std::vector<std::uint8_t> reachable = grid.Reachable(grid.CellAt(request.start));
    for (const Pose& pose : *poses) {
      ASSERT_GE((pose.position - request.occupied[0]).norm(), 2.0 * kRadius + 0.01 - 1e-12);
      ASSERT_EQ(reachable[grid.Index(grid.CellAt(pose.position))], 1);
      for (const OrientedBox& box : arena.boxes()) {
        ASSERT_GE(Distance(box, pose.position), kRadius + 0.01 - 1e-12);
      }
    }
  }
  EXPECT_LT(crowded, 15);
}

TEST(SpawnTest, ACrowdedAreaGrowsAboutItsCentre) {
  // One robot fits into the first area, two only into larger ones.
  SpawnRequest request = Birds();
  request.area = {{-0.06, 0.94}, {0.06, 1.06}};
  request.start = {0.0, 1.0};
  request.count = 2;
  const OccupancyGrid grid = GridWith({});
  RandomStream random = SpawnStream(12);
  const std::vector<Pose> poses = Spawn(request, grid, random).value();
  EXPECT_LE((poses[0].position - request.start).cwiseAbs().maxCoeff(), 0.06);
  EXPECT_GT((poses[1].position - request.start).cwiseAbs().maxCoeff(), 0.06);
  EXPECT_LE((poses[1].position - request.start).cwiseAbs().maxCoeff(), 0.12);
}

TEST(SpawnTest, AnAreaBehindAWallIsNotUsed) {
  const OccupancyGrid grid = GridWith({{0.0, 0.0, 6.2, 0.2, 90.0}});
  SpawnRequest request = Birds();
  request.area = {{-1.0, -0.5}, {1.0, 0.5}};
  request.start = {2.5, 2.5};
  RandomStream random = SpawnStream(13);
  const std::vector<Pose> poses = Spawn(request, grid, random).value();
  for (const Pose& pose : poses) EXPECT_GT(pose.position.x(), 0.1 + kRadius);
  request.area = {{-2.5, -0.5}, {-1.5, 0.5}};
  EXPECT_THAT(ErrorOf(request, grid), StartsWith("no-room-to-spawn: only 0 of 10 robots fit"));
}

TEST(SpawnTest, ASwarmThatDoesNotFitIsRefusedWithItsNumbers) {
  SpawnRequest request = Birds();
  request.count = 200;
  EXPECT_THAT(ErrorOf(request, GridWith({})),
              AllOf(StartsWith("no-room-to-spawn: only "), HasSubstr(" of 200 robots fit"),
                    HasSubstr("the enlarged spawn area")));
  request = Birds();
  request.area = {{2.5, 2.5}, {2.5, 2.5}};
  request.count = 1;
  EXPECT_EQ(ErrorOf(request, GridWith({})), "spawned") << "a point is enough for one";
  request.count = 2;
  EXPECT_THAT(ErrorOf(request, GridWith({})), StartsWith("no-room-to-spawn: only 1 of 2"));
}

TEST(SpawnTest, ABlockedStartIsRefused) {
  EXPECT_EQ(ErrorOf(Birds(), GridWith({{2.5, 2.5, 1.0, 1.0, 0.0}})),
            "no-room-to-spawn: the start (2.5, 2.5) does not lie in a free cell of the arena");
}

TEST(SpawnTest, SenselessRequestsAreRefusedAtOnce) {
  const OccupancyGrid grid = GridWith({});
  const auto refuse = [&](auto change, const std::string& text) {
    SpawnRequest request = Birds();
    change(request);
    EXPECT_THAT(ErrorOf(request, grid), AllOf(StartsWith("no-room-to-spawn: "), HasSubstr(text)));
  };
  refuse([](SpawnRequest& r) { r.count = -1; }, "-1 robots; want 0 to 1000");
  refuse([](SpawnRequest& r) { r.count = 1'000'000'000; }, "1000000000 robots");
  refuse([](SpawnRequest& r) { r.area.max.x() = std::nan(""); }, "nan");
  refuse([](SpawnRequest& r) { r.area.max.y() = 1.0; }, "must go from its least to its greatest corner");
  refuse([](SpawnRequest& r) { r.robot_radius = 0.0; }, "robot radius 0 m");
  refuse([](SpawnRequest& r) { r.robot_radius = std::nan(""); }, "robot radius nan m");
  refuse([](SpawnRequest& r) { r.start = {std::nan(""), 0.0}; }, "the start (nan, 0)");
  refuse([](SpawnRequest& r) { r.area = {{900.0, 900.0}, {901.0, 901.0}}; }, "only 0 of 10 robots fit");
  SpawnRequest none = Birds();
  none.count = 0;
  RandomStream random = SpawnStream(1);
  EXPECT_TRUE(Spawn(none, grid, random).value().empty());
}

}  // namespace
}  // namespace gauntlet::sim
