#include "sim/geometry/ray_cast.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/random/random_stream.h"
#include "tests/sim/geometry/generators.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

using testing::AnyAngle;
using testing::AnyBox;
using testing::AnyPoint;
using testing::AnyReal;
using testing::Grown;

constexpr double kFar = std::numeric_limits<double>::infinity();

// Where a ray crosses the segment a-b, by Cramer's rule; infinity when it does not.
double CrossingWithEdge(const Vec2& origin, const Vec2& direction, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a;
  const double determinant = Cross(edge, direction);
  if (determinant == 0.0) return kFar;
  const double along_ray = Cross(edge, a - origin) / determinant;
  const double along_edge = Cross(direction, a - origin) / determinant;
  return along_ray >= 0.0 && along_edge >= 0.0 && along_edge <= 1.0 ? along_ray : kFar;
}

// The first crossing with the outline: a second formulation that shares nothing with slabs.
double HitByEdges(const OrientedBox& box, const Vec2& origin, const Vec2& direction, double range) {
  if (Contains(box, origin)) return 0.0;
  const auto corners = Corners(box);
  double first = kFar;
  for (std::size_t i = 0; i < 4; ++i) {
    first = std::min(first, CrossingWithEdge(origin, direction, corners[i], corners[(i + 1) % 4]));
  }
  return first <= range ? first : kNoHit;
}

bool SegmentsCross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double c_side = Cross(b - a, c - a);
  const double d_side = Cross(b - a, d - a);
  const double a_side = Cross(d - c, a - c);
  const double b_side = Cross(d - c, b - c);
  return c_side * d_side <= 0.0 && a_side * b_side <= 0.0;
}

bool TouchesByEdges(const OrientedBox& box, const Vec2& a, const Vec2& b) {
  if (Contains(box, a) || Contains(box, b)) return true;
  const auto corners = Corners(box);
  for (std::size_t i = 0; i < 4; ++i) {
    if (SegmentsCross(a, b, corners[i], corners[(i + 1) % 4])) return true;
  }
  return false;
}

TEST(RayCastTest, HitsTheNearFaceOfABox) {
  const OrientedBox box = MakeBox({2.0, 0.0}, 1.0, 2.0, 0.0);
  EXPECT_DOUBLE_EQ(RayHit(box, {0.0, 0.0}, {1.0, 0.0}, 5.0), 1.5);
  EXPECT_DOUBLE_EQ(RayHit(box, {0.0, 0.5}, {1.0, 0.0}, 1.5), 1.5) << "the range itself still counts";
  EXPECT_EQ(RayHit(box, {0.0, 0.0}, {1.0, 0.0}, 1.49), kNoHit);
  EXPECT_EQ(RayHit(box, {0.0, 0.0}, {-1.0, 0.0}, 5.0), kNoHit) << "behind";
  EXPECT_EQ(RayHit(box, {2.1, 0.3}, {0.6, 0.8}, 5.0), 0.0) << "inside";
}

TEST(RayCastTest, ARayAlongAFaceTouchesTheBox) {
  const OrientedBox box = MakeBox({2.0, 0.0}, 1.0, 2.0, 0.0);
  for (const double y : {-1.0, 1.0}) {
    EXPECT_DOUBLE_EQ(RayHit(box, {0.0, y}, {1.0, 0.0}, 5.0), 1.5) << y;
    EXPECT_DOUBLE_EQ(RayHit(box, {0.0, y}, {1.0, -0.0}, 5.0), 1.5) << y;
    EXPECT_DOUBLE_EQ(RayHit(box, {4.0, y}, {-1.0, 0.0}, 5.0), 1.5) << y;
    EXPECT_DOUBLE_EQ(RayHit(box, {4.0, y}, {-1.0, -0.0}, 5.0), 1.5) << y;
  }
  EXPECT_EQ(RayHit(box, {0.0, 1.0000001}, {1.0, 0.0}, 5.0), kNoHit);
}

TEST(RayCastTest, HitsTheNearSideOfADisc) {
  EXPECT_DOUBLE_EQ(RayHit({3.0, 0.0}, 0.5, {0.0, 0.0}, {1.0, 0.0}, 5.0), 2.5);
  EXPECT_DOUBLE_EQ(RayHit({3.0, 0.5}, 0.5, {0.0, 0.0}, {1.0, 0.0}, 5.0), 3.0) << "tangent";
  EXPECT_EQ(RayHit({3.0, 0.51}, 0.5, {0.0, 0.0}, {1.0, 0.0}, 5.0), kNoHit);
  EXPECT_EQ(RayHit({3.0, 0.0}, 0.5, {0.0, 0.0}, {1.0, 0.0}, 2.49), kNoHit);
  EXPECT_EQ(RayHit({-3.0, 0.0}, 0.5, {0.0, 0.0}, {1.0, 0.0}, 5.0), kNoHit) << "behind";
  EXPECT_EQ(RayHit({0.1, 0.2}, 0.5, {0.0, 0.0}, {1.0, 0.0}, 5.0), 0.0) << "inside";
  EXPECT_EQ(RayHit({-0.5, 0.0}, 0.5, {0.0, 0.0}, {1.0, 0.0}, 5.0), 0.0) << "touching from behind";
}

TEST(RayCastTest, TouchingTheBoundaryCountsForSegments) {
  const OrientedBox box = MakeBox({0.0, 0.0}, 2.0, 2.0, 0.0);
  EXPECT_TRUE(SegmentTouches(box, {-3.0, 1.0}, {3.0, 1.0})) << "along a face";
  EXPECT_TRUE(SegmentTouches(box, {0.0, 2.0}, {2.0, 0.0})) << "through a corner";
  EXPECT_TRUE(SegmentTouches(box, {1.0, 0.0}, {4.0, 0.0})) << "an end on a face";
  EXPECT_TRUE(SegmentTouches(box, {0.2, 0.2}, {0.3, 0.1})) << "wholly inside";
  EXPECT_TRUE(SegmentTouches(box, {1.0, 1.0}, {1.0, 1.0})) << "a point";
  EXPECT_FALSE(SegmentTouches(box, {-3.0, 1.001}, {3.0, 1.001}));
  EXPECT_FALSE(SegmentTouches(box, {0.0, 2.001}, {2.001, 0.0}));
  EXPECT_FALSE(SegmentTouches(box, {1.001, 0.0}, {4.0, 0.0}));

  EXPECT_TRUE(SegmentTouches({0.0, 0.0}, 1.0, {-3.0, 1.0}, {3.0, 1.0})) << "tangent";
  EXPECT_TRUE(SegmentTouches({0.0, 0.0}, 1.0, {1.0, 0.0}, {3.0, 0.0}));
  EXPECT_TRUE(SegmentTouches({0.0, 0.0}, 1.0, {0.1, 0.0}, {0.1, 0.0}));
  EXPECT_FALSE(SegmentTouches({0.0, 0.0}, 1.0, {-3.0, 1.001}, {3.0, 1.001}));
  EXPECT_FALSE(SegmentTouches({0.0, 0.0}, 1.0, {1.5, 0.0}, {3.0, 0.0}));
}

// Marching in small steps knows no geometry but "is this point inside".
TEST(RayCastTest, AgreesWithMarchingAlongTheRay) {
  constexpr double kStep = 1e-3;
  constexpr double kRange = 4.0;
  RandomStream random(7, StreamPurpose::kTest);
  int hits = 0;
  for (int i = 0; i < 1500; ++i) {
    const OrientedBox box = MakeBox({random.Uniform(-2, 2), random.Uniform(-2, 2)}, random.Uniform(0.1, 2.0),
                                    random.Uniform(0.1, 2.0), random.Uniform(-kPi, kPi));
    const Vec2 origin(random.Uniform(-3, 3), random.Uniform(-3, 3));
    const Vec2 direction = UnitVector(random.Uniform(-kPi, kPi));
    double marched = kNoHit;
    for (double t = 0.0; t <= kRange; t += kStep) {
      if (Contains(box, origin + t * direction)) {
        marched = t;
        break;
      }
    }
    const double hit = RayHit(box, origin, direction, kRange);
    if (marched == kNoHit) {
      // A hit that marching stepped over is a corner cut shorter than a step, or lies in the last step.
      if (hit != kNoHit && hit < kRange - kStep) {
        ASSERT_FALSE(SegmentTouches(Grown(box, -kStep), origin, origin + kRange * direction));
      }
      continue;
    }
    ++hits;
    ASSERT_NE(hit, kNoHit);
    // Marching may step over a corner first and meet the box up to a step later.
    ASSERT_LE(hit, marched + 1e-9);
    ASSERT_GE(hit, marched - kStep - 1e-9);
  }
  EXPECT_GT(hits, 150);
}

RC_GTEST_PROP(RayCastTest, BoxHitsAgreeWithCrossingTheEdges, ()) {
  const OrientedBox box = AnyBox(3.0);
  const Vec2 origin = AnyPoint(4.0);
  const Vec2 direction = UnitVector(AnyAngle());
  const double range = AnyReal(0.05, 6.0);
  // Grazing rays may go either way by rounding: the answer must lie between those of slightly other boxes.
  const double hit = RayHit(box, origin, direction, range);
  if (hit == kNoHit) {
    RC_ASSERT(HitByEdges(Grown(box, -1e-9), origin, direction, range - 1e-6) == kNoHit);
  } else {
    const double reference = HitByEdges(Grown(box, 1e-9), origin, direction, range + 1e-6);
    RC_ASSERT(reference != kNoHit);
    const Vec2 point = origin + hit * direction;
    RC_ASSERT(Distance(box, point) < 1e-9);
    RC_ASSERT(!Contains(Grown(box, -1e-8), point) || hit == 0.0);
    RC_ASSERT(reference <= hit + 1e-9);
  }
}

RC_GTEST_PROP(RayCastTest, DiscHitsLieOnTheNearSideOfTheDisc, ()) {
  const Vec2 center = AnyPoint(3.0);
  const double radius = AnyReal(0.01, 1.0);
  const Vec2 origin = AnyPoint(4.0);
  const Vec2 direction = UnitVector(AnyAngle());
  const double range = AnyReal(0.05, 6.0);
  const double hit = RayHit(center, radius, origin, direction, range);
  if ((origin - center).norm() < radius - 1e-9) {
    RC_ASSERT(hit == 0.0);
  } else if (hit != kNoHit) {
    const Vec2 point = origin + hit * direction;
    RC_ASSERT(std::fabs((point - center).norm() - radius) < 1e-7);
    RC_ASSERT((point - center).dot(direction) <= 1e-6);
    RC_ASSERT(hit <= range);
  } else {
    // The point of the ray nearest to the centre, within the range, is outside the disc; or the first touch
    // lies beyond the range.
    const double nearest = std::clamp((center - origin).dot(direction), 0.0, range);
    RC_ASSERT((origin + nearest * direction - center).norm() > radius - 1e-9);
  }
}

RC_GTEST_PROP(RayCastTest, SegmentsTouchBoxesAsTheirEdgesSay, ()) {
  const OrientedBox box = AnyBox(3.0);
  const Vec2 a = AnyPoint(4.0);
  const Vec2 b = AnyPoint(4.0);
  const bool touches = SegmentTouches(box, a, b);
  RC_ASSERT(touches == SegmentTouches(box, b, a));
  if (touches) {
    RC_ASSERT(TouchesByEdges(Grown(box, 1e-9), a, b));
  } else {
    RC_ASSERT(!TouchesByEdges(Grown(box, -2e-9), a, b));
  }
}

RC_GTEST_PROP(RayCastTest, SegmentsTouchDiscsAsTheirNearestPointSays, ()) {
  const Vec2 center = AnyPoint(3.0);
  const double radius = AnyReal(0.01, 1.0);
  const Vec2 a = AnyPoint(4.0);
  const Vec2 b = AnyPoint(4.0);
  RC_PRE((b - a).norm() > 1e-6);
  const double t = std::clamp((center - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  const double distance = (a + t * (b - a) - center).norm();
  RC_PRE(std::fabs(distance - radius) > 1e-9);
  RC_ASSERT(SegmentTouches(center, radius, a, b) == (distance < radius));
  RC_ASSERT(SegmentTouches(center, radius, b, a) == (distance < radius));
}

RC_GTEST_PROP(RayCastTest, ARayHitsWhatItsSegmentTouches, ()) {
  const OrientedBox box = AnyBox(3.0);
  const Vec2 origin = AnyPoint(4.0);
  const Vec2 direction = UnitVector(AnyAngle());
  const double range = AnyReal(0.05, 6.0);
  const Vec2 end = origin + range * direction;
  if (RayHit(box, origin, direction, range) != kNoHit) {
    RC_ASSERT(SegmentTouches(Grown(box, 1e-9), origin, end));
  } else {
    RC_ASSERT(!SegmentTouches(Grown(box, -1e-9), origin, end));
  }
}

}  // namespace
}  // namespace gauntlet::sim
