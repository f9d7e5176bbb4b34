// The directions of many places against those of each.
#include "sim/geometry/directions.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "sim/geometry/trigonometry.h"
#include "sim/random/random_stream.h"

namespace gauntlet::sim {
namespace {

struct Seen {
  double other = 0.0;
  double range = 0.0;
  Vec2 position = Vec2::Zero();

  static Seen At(const Vec2& position) {
    return {.range = std::hypot(position.x(), position.y()), .position = position};
  }
};

std::uint64_t Bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

std::vector<Directions::Lanes> LanesThatWorkHere() {
  std::vector<Directions::Lanes> lanes = {Directions::Lanes::kTwo};
  if (Directions::LanesHere() == Directions::Lanes::kFour) lanes.push_back(Directions::Lanes::kFour);
  return lanes;
}

// Of the angle in (-pi, pi], of the range and of what both are divided or worked out to.
constexpr double kRounding = 1e-15;

// What no step under- or overflows of.
bool Moderate(const Vec2& position) {
  const double larger = position.cwiseAbs().maxCoeff();
  return larger > 1e-200 && larger < 1e200;
}

void ExpectEachAsAlone(const std::vector<Seen>& all) {
  for (const Directions::Lanes lanes : LanesThatWorkHere()) {
    Directions directions(4, lanes);
    directions.WorkOut(std::span<const Seen>(all));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double angle = AngleOf(all[i].position);
      const Vec2& position = all[i].position;
      const SinCos both = Moderate(position)
                              ? SinCos{.sin = position.y() / all[i].range, .cos = position.x() / all[i].range}
                              : SineCosine(angle);
      ASSERT_EQ(Bits(directions.Angle(i)), Bits(angle)) << position.transpose();
      ASSERT_EQ(Bits(directions.Sine(i)), Bits(both.sin)) << position.transpose();
      ASSERT_EQ(Bits(directions.Cosine(i)), Bits(both.cos)) << position.transpose();
      ASSERT_NEAR(directions.Sine(i), SineCosine(angle).sin, kRounding) << position.transpose();
      ASSERT_NEAR(directions.Cosine(i), SineCosine(angle).cos, kRounding) << position.transpose();
    }
  }
}

TEST(Directions, AreToTheLastBitThoseOfEachPlaceAlone) {
  RandomStream random(1, StreamPurpose::kTest);
  std::vector<Seen> all(200'003);
  for (Seen& one : all) one = Seen::At({random.Uniform(-3.0, 3.0), random.Uniform(-3.0, 3.0)});
  ExpectEachAsAlone(all);
}

TEST(Directions, AreSoOnAxesAndDiagonalsAndNearThem) {
  const std::vector<double> coordinates = {0.0,   -0.0,  1.0,   -1.0,  0.25,  -0.25, 0.5,    -0.5,   0.75,
                                           -0.75, 0.125, 0.375, 0.625, 0.875, 1e-17, -1e-17, 1e-300, 5e-324};
  std::vector<Seen> all;
  for (const double x : coordinates) {
    for (const double y : coordinates) {
      if (x == 0.0 && y == 0.0) continue;
      for (const double toward : {-10.0, 0.0, 10.0})
        all.push_back(Seen::At({x, toward == 0.0 ? y : std::nextafter(y, toward)}));
    }
  }
  std::erase_if(all, [](const Seen& one) { return !Moderate(one.position); });
  ExpectEachAsAlone(all);
}

TEST(Directions, AreSoOfPlacesBesideThoseThatAreExtreme) {
  constexpr double kMost = std::numeric_limits<double>::max();
  for (const Vec2& extreme : {Vec2(0.0, 0.0), Vec2(-0.0, -0.0), Vec2(1e-300, -1e-300), Vec2(5e-324, 0.0),
                              Vec2(-1e300, 1e299), Vec2(kMost, -kMost)}) {
    for (const std::size_t count : {1u, 2u, 5u}) {
      std::vector<Seen> all(count, Seen::At({-1.5, -0.2}));
      all.front() = Seen::At(extreme);
      ExpectEachAsAlone(all);
    }
  }
}

TEST(Directions, AreThoseOfTheLastCall) {
  Directions directions(0);
  for (const std::size_t count : {3u, 0u, 40u, 1u}) {
    const std::vector<Seen> all(count, Seen::At({0.0, static_cast<double>(count)}));
    directions.WorkOut(std::span<const Seen>(all));
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(directions.Angle(i), AngleOf({0.0, 1.0}));
  }
}

}  // namespace
}  // namespace gauntlet::sim
