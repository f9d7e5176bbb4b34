#include "controllers/foraging/pheromone.h"

#include <cmath>

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

constexpr PheromoneSettings kPheromone = {.decay_time = 300.0, .trail_time = 60.0, .speed = 0.05};

TEST(Pheromone, EvaporatesByItsTimeConstant) {
  Pheromone level;
  level.Lay(LaidStaleness(30.0, 1.5, kPheromone));
  EXPECT_NEAR(std::exp(-level.staleness()), std::exp(-(30.0 + 1.5 / 0.05) / 60.0), 1e-12);
  for (int tick = 0; tick < 3000; ++tick) level.Evaporate(kPheromone);
  EXPECT_NEAR(std::exp(-level.staleness()), std::exp(-1.0) * std::exp(-1.0), 1e-12);
}

TEST(Pheromone, KeepsTheLargerLevel) {
  Pheromone level;
  EXPECT_EQ(level.staleness(), kNoPheromone);
  level.Evaporate(kPheromone);
  EXPECT_EQ(level.staleness(), kNoPheromone);
  level.Lay(2.0);
  level.Lay(3.0);
  EXPECT_EQ(level.staleness(), 2.0);
  level.Lay(1.0);
  EXPECT_EQ(level.staleness(), 1.0);
  level.Clear();
  EXPECT_EQ(level.staleness(), kNoPheromone);
}

TEST(Pheromone, BeaconsThatHearTheNestAreAboveOneTheNearestMost) {
  EXPECT_NEAR(std::exp(-NestStaleness(1.0, 3.0)), 1.02, 1e-12);
  EXPECT_LT(NestStaleness(0.5, 3.0), NestStaleness(0.6, 3.0));
  EXPECT_LT(NestStaleness(2.999, 3.0), LaidStaleness(0.0, 0.0, kPheromone));
}

}  // namespace
}  // namespace gauntlet::controllers
