#include "sim/geometry/oriented_box.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/geometry/generators.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

using testing::AnyBox;
using testing::AnyPoint;

TEST(OrientedBoxTest, CornersRunCounterClockwiseFromTheLowerLeftOfTheBoxFrame) {
  const OrientedBox box = MakeBox({1.0, 2.0}, 4.0, 2.0, 0.0);
  const auto corners = Corners(box);
  EXPECT_EQ(corners[0], Vec2(-1.0, 1.0));
  EXPECT_EQ(corners[1], Vec2(3.0, 1.0));
  EXPECT_EQ(corners[2], Vec2(3.0, 3.0));
  EXPECT_EQ(corners[3], Vec2(-1.0, 3.0));
}

TEST(OrientedBoxTest, LengthPointsUpAfterAQuarterTurn) {
  const OrientedBox box = MakeBox({0.0, 0.0}, 4.0, 2.0, kPi / 2.0);
  EXPECT_TRUE(Contains(box, {0.0, 1.99}));
  EXPECT_FALSE(Contains(box, {1.99, 0.0}));
  EXPECT_TRUE(Corners(box)[0].isApprox(Vec2(1.0, -2.0), 1e-12));
}

TEST(OrientedBoxTest, DistanceToFacesCornersAndInside) {
  const OrientedBox box = MakeBox({0.0, 0.0}, 2.0, 1.0, 0.0);
  EXPECT_DOUBLE_EQ(Distance(box, {1.5, 0.2}), 0.5);
  EXPECT_DOUBLE_EQ(Distance(box, {0.3, -2.5}), 2.0);
  EXPECT_DOUBLE_EQ(Distance(box, {4.0, 4.5}), 5.0);
  EXPECT_EQ(Distance(box, {0.9, 0.4}), 0.0);
  EXPECT_EQ(Distance(box, {1.0, 0.5}), 0.0);
}

TEST(OrientedBoxTest, ABoxContainsItselfAndASmallerOneButNotOneThatSticksOut) {
  const OrientedBox box = MakeBox({0.3, -0.7}, 1.3, 0.4, 1.1);
  EXPECT_TRUE(ContainsBox(box, box));
  EXPECT_TRUE(ContainsBox(box, MakeBox({0.3, -0.7}, 1.2, 0.3, 1.1)));
  EXPECT_FALSE(ContainsBox(box, MakeBox({0.3, -0.7}, 1.4, 0.3, 1.1)));
  EXPECT_FALSE(ContainsBox(box, MakeBox({0.3, -0.7}, 1.3, 0.4, 1.2)));
}

RC_GTEST_PROP(OrientedBoxTest, ABoxContainsItsCornersAtAnyAngleAndPlace, ()) {
  const OrientedBox box = AnyBox(1000.0);
  for (const Vec2& corner : Corners(box)) RC_ASSERT(Contains(box, corner));
  RC_ASSERT(ContainsBox(box, box));
}

RC_GTEST_PROP(OrientedBoxTest, DistanceIsTheDistanceToTheNearestPointOfTheOutline, ()) {
  const OrientedBox box = AnyBox(3.0);
  const Vec2 p = AnyPoint(5.0);
  RC_PRE(!Contains(box, p));
  // Independent of the box frame: nearest point on each edge.
  const auto corners = Corners(box);
  double nearest = 1e9;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2& a = corners[i];
    const Vec2 edge = corners[(i + 1) % 4] - a;
    const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (a + t * edge - p).norm());
  }
  RC_ASSERT(std::fabs(Distance(box, p) - nearest) < 1e-12);
}

RC_GTEST_PROP(OrientedBoxTest, TheBoundingRectangleIsTheOneOfTheCorners, ()) {
  const OrientedBox box = AnyBox(3.0);
  Vec2 reach = Vec2::Zero();
  for (const Vec2& corner : Corners(box)) reach = reach.cwiseMax((corner - box.center).cwiseAbs());
  RC_ASSERT((BoundingHalfExtents(box) - reach).norm() < 1e-12);
}

}  // namespace
TEST(OrientedBoxTest, BoxesThatTouchCrossOrLieInsideHaveNoDistance) {
  const OrientedBox box = MakeBox({0.0, 0.0}, 2.0, 2.0, 0.0);
  EXPECT_EQ(Distance(box, MakeBox({2.0, 0.0}, 2.0, 1.0, 0.0)), 0.0);
  EXPECT_EQ(Distance(box, MakeBox({0.0, 0.0}, 9.0, 0.5, 0.3)), 0.0);  // no corner in the other
  EXPECT_EQ(Distance(box, MakeBox({0.1, 0.1}, 0.2, 0.2, 0.3)), 0.0);
  EXPECT_EQ(Distance(MakeBox({0.1, 0.1}, 0.2, 0.2, 0.3), box), 0.0);
  EXPECT_EQ(Distance(box, MakeBox({2.5, 0.0}, 2.0, 1.0, 0.0)), 0.5);
  EXPECT_EQ(Distance(box, {{4.0, 5.0}, Vec2::Zero()}), 5.0);
}

RC_GTEST_PROP(OrientedBoxTest, TheDistanceOfBoxesIsTheLeastOfTheirOutlines, ()) {
  const OrientedBox a = AnyBox(3.0);
  const OrientedBox b = AnyBox(3.0);
  double nearest = 1e9;
  constexpr int kPoints = 400;  // on a side
  const auto corners = Corners(b);
  for (std::size_t i = 0; i < 4; ++i) {
    for (int k = 0; k < kPoints; ++k)
      nearest = std::min(nearest, Distance(a, corners[i] + static_cast<double>(k) / kPoints *
                                                               (corners[(i + 1) % 4] - corners[i])));
  }
  if (ContainsBox(b, a)) nearest = 0.0;
  RC_ASSERT(Distance(a, b) == Distance(b, a));
  RC_ASSERT(Distance(a, b) <= nearest + 1e-12);
  RC_ASSERT(Distance(a, b) > nearest - 0.01);  // sides of up to 3 m, a point every 7.5 mm
}

}  // namespace gauntlet::sim
