// Our rays and lines of sight against Box2D's RayCast. Box2D computes in single precision; where the two
// disagree about a hit, the ray must graze the shape.
// Covers: sim/sensors/distance_scanner.cc, sim/sensors/occluders.cc
#include <box2d/box2d.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "sim/geometry/ray_cast.h"
#include "sim/geometry/trigonometry.h"
#include "sim/random/random_stream.h"
#include "sim/sensors/distance_scanner.h"
#include "sim/sensors/occluders.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

constexpr double kGrazing = 1e-4;  // m

b2Vec2 ToBox2d(const Vec2& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y())};
}

// Distance along the ray to the shape's boundary, or kNoHit.
double Cast(const b2Shape& shape, const b2Transform& place, const Vec2& origin, const Vec2& direction,
            double range) {
  const Vec2 end = origin + range * direction;
  const b2RayCastInput input = {ToBox2d(origin), ToBox2d(end), 1.0F};
  b2RayCastOutput output;
  if (!shape.RayCast(&output, input, place, 0)) return kNoHit;
  return range * static_cast<double>(output.fraction);
}

double CastBox(const OrientedBox& box, const Vec2& origin, const Vec2& direction, double range) {
  b2PolygonShape shape;
  shape.SetAsBox(static_cast<float>(box.half_extents.x()), static_cast<float>(box.half_extents.y()));
  b2Transform place;
  place.Set(ToBox2d(box.center), static_cast<float>(AngleOf(box.axis)));
  return Cast(shape, place, origin, direction, range);
}

double CastDisc(const Vec2& center, double radius, const Vec2& origin, const Vec2& direction, double range) {
  b2CircleShape shape;
  shape.m_radius = static_cast<float>(radius);
  b2Transform place;
  place.Set(ToBox2d(center), 0.0F);
  return Cast(shape, place, origin, direction, range);
}

OrientedBox Grown(OrientedBox box, double by) {
  box.half_extents += Vec2(by, by);
  return box;
}

OrientedBox RandomBox(RandomStream& random) {
  const double x = random.Uniform(-2, 2);
  const double y = random.Uniform(-2, 2);
  const double length = random.Uniform(0.05, 2.0);
  const double width = random.Uniform(0.05, 0.5);
  return MakeBox({x, y}, length, width, random.Uniform(-kPi, kPi));
}

Vec2 RandomPoint(RandomStream& random) {
  const double x = random.Uniform(-3, 3);
  return {x, random.Uniform(-3, 3)};
}

RC_GTEST_PROP(Box2dOracle, RaysMeetBoxesWhereBox2dSays, (std::uint64_t seed)) {
  RandomStream random(seed, StreamPurpose::kTest);
  const OrientedBox box = RandomBox(random);
  const Vec2 origin = RandomPoint(random);
  const Vec2 direction = UnitVector(AngleOf(box.center - origin) + random.Uniform(-0.5, 0.5));
  const double range = random.Uniform(0.5, 8.0);
  RC_PRE(!Contains(Grown(box, kGrazing), origin));  // Box2D's rays do not start inside
  const double ours = RayHit(box, origin, direction, range);
  const double theirs = CastBox(box, origin, direction, range);
  RC_CLASSIFY(ours != kNoHit, "hit");
  if ((ours == kNoHit) != (theirs == kNoHit)) {
    const bool grazes = (RayHit(Grown(box, kGrazing), origin, direction, range + kGrazing) == kNoHit) !=
                        (RayHit(Grown(box, -kGrazing), origin, direction, range - kGrazing) == kNoHit);
    RC_ASSERT(grazes);
  } else if (ours != kNoHit) {
    // A flat angle makes a small error across a long one along the ray.
    RC_ASSERT(std::abs(ours - theirs) < 1e-3 ||
              RayHit(Grown(box, kGrazing), origin, direction, range) <= theirs);
  }
}

RC_GTEST_PROP(Box2dOracle, RaysMeetDiscsWhereBox2dSays, (std::uint64_t seed)) {
  RandomStream random(seed, StreamPurpose::kTest);
  const Vec2 center = 0.3 * RandomPoint(random);
  const double radius = foot_bot::kRadius;
  const Vec2 origin = 0.3 * RandomPoint(random);
  const Vec2 direction = UnitVector(AngleOf(center - origin) + random.Uniform(-0.2, 0.2));
  const double range = random.Uniform(0.1, 3.0);
  RC_PRE((origin - center).norm() > radius + kGrazing);
  const double ours = RayHit(center, radius, origin, direction, range);
  const double theirs = CastDisc(center, radius, origin, direction, range);
  RC_CLASSIFY(ours != kNoHit, "hit");
  const double grown = RayHit(center, radius + kGrazing, origin, direction, range + kGrazing);
  const double shrunk = RayHit(center, radius - kGrazing, origin, direction, range - kGrazing);
  if ((ours == kNoHit) != (theirs == kNoHit)) {
    RC_ASSERT((grown == kNoHit) != (shrunk == kNoHit));
  } else if (ours != kNoHit) {
    RC_ASSERT(std::abs(ours - theirs) < 1e-3 || (grown <= theirs && (shrunk == kNoHit || theirs <= shrunk)));
  }
}

RC_GTEST_PROP(Box2dOracle, LinesOfSightAreThoseOfBox2d, (std::uint64_t seed)) {
  RandomStream random(seed, StreamPurpose::kTest);
  std::vector<OrientedBox> boxes;
  Occluders occluders;
  Occluders grown;
  Occluders shrunk;
  const Vec2 a = RandomPoint(random);
  const Vec2 b = RandomPoint(random);
  for (int i = 0; i < 6; ++i) {
    const OrientedBox box = RandomBox(random);
    if (Contains(Grown(box, kGrazing), a) || Contains(Grown(box, kGrazing), b)) continue;
    boxes.push_back(box);
    occluders.AddBox(box);
    grown.AddBox(Grown(box, kGrazing));
    shrunk.AddBox(Grown(box, -kGrazing));
  }
  const double distance = (b - a).norm();
  RC_PRE(distance > 0.01);
  const Vec2 direction = (b - a) / distance;
  const bool theirs = std::any_of(boxes.begin(), boxes.end(), [&](const OrientedBox& box) {
    return CastBox(box, a, direction, distance) != kNoHit;
  });
  std::vector<std::size_t> all(boxes.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Sight sight = occluders.SightBetween(all, a, b);
  const bool ours = !sight.clear;
  // Wherever its ends go within what it holds for, the answer stays.
  for (int i = 0; i < 10; ++i) {
    const auto shift = [&]() -> Vec2 { return 0.999 * sight.holds * UnitVector(random.Uniform(-kPi, kPi)); };
    const Vec2 near_a = a + shift();
    RC_ASSERT(occluders.SightBetween(all, near_a, b + shift()).clear == sight.clear);
  }
  RC_CLASSIFY(ours, "hidden");
  RC_ASSERT(occluders.BoxBetween({a, 0.1}, {b, 0.3}) == ours);
  if (ours == theirs) return;
  RC_ASSERT(grown.BoxBetween({a, 0.1}, {b, 0.1}) != shrunk.BoxBetween({a, 0.1}, {b, 0.1}));
}

// A whole device in a whole scene: the nearest of everything in the way.
RC_GTEST_PROP(Box2dOracle, TheScannerSeesTheNearestThing, (std::uint64_t seed)) {
  RandomStream random(seed, StreamPurpose::kTest);
  const BodyFrame self(Pose{Vec2::Zero(), random.Uniform(-kPi, kPi)});
  std::vector<BodyFrame> robots = {self};
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < 4; ++i) {
    const OrientedBox box = RandomBox(random);
    if (Distance(box, self.position) > foot_bot::kRadius + 0.01) boxes.push_back(box);
    const Pose pose = {0.4 * RandomPoint(random), random.Uniform(-kPi, kPi)};
    if (pose.position.norm() > 2.0 * foot_bot::kRadius + 0.02) robots.emplace_back(pose);
  }
  const double angle = random.Uniform(-kPi, kPi);
  DistanceScanner scanner;
  scanner.Scan({.mode = ScannerCommand::Mode::kAngle, .value = angle}, robots, 0, boxes);
  for (const ScannerReading& reading : scanner.long_range()) {
    const auto nearest = [&](double bearing) {
      const Vec2 direction = UnitVector(self.heading + bearing);
      const Vec2 origin = self.position + foot_bot::kRadius * direction;
      double result = 10.0;
      const auto see = [&result](double hit) {
        if (hit != kNoHit) result = std::min(result, hit);
      };
      for (const OrientedBox& box : boxes) see(CastBox(box, origin, direction, 1.42));
      for (std::size_t i = 1; i < robots.size(); ++i) {
        see(CastDisc(robots[i].position, foot_bot::kRadius, origin, direction, 1.42));
        see(CastDisc(robots[i].position + foot_bot::kRadius * robots[i].direction, foot_bot::kGripperRadius,
                     origin, direction, 1.42));
      }
      return result;
    };
    const double theirs = nearest(reading.bearing);
    // Where a hair's turn changes the answer, an edge is grazed.
    const double hair = 2e-4;  // rad
    const double left = nearest(reading.bearing + hair);
    const double right = nearest(reading.bearing - hair);
    if (std::abs(left - theirs) > 5e-3 || std::abs(right - theirs) > 5e-3) continue;
    if (std::abs(theirs - 0.12) < 1e-3 || std::abs(theirs - 1.42) < 1e-3) continue;
    const double expected = theirs > 1.42   ? ScannerReading::kNothing
                            : theirs < 0.12 ? ScannerReading::kTooNear
                                            : theirs;
    RC_ASSERT(std::abs(reading.distance - expected) < 1e-3);
  }
}

}  // namespace
}  // namespace gauntlet::sim
