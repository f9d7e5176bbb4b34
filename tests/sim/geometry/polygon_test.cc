#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "sim/geometry/oriented_box.h"
#include "tests/sim/geometry/generators.h"
#include "tests/support/make_box.h"

namespace gauntlet::sim {
namespace {

const Vec2 kMin(-2.95, -2.95);
const Vec2 kMax(2.95, 2.95);

TEST(PolygonTest, ABoxInsideTheRectangleStaysWhole) {
  const OrientedBox box = MakeBox({0.5, 0.5}, 1.5, 0.25, 0.7);
  const Polygon polygon = ClipToRectangle(box, kMin, kMax);
  ASSERT_EQ(polygon.size(), 4u);
  EXPECT_NEAR(Area(polygon), 1.5 * 0.25, 1e-12);
}

TEST(PolygonTest, WhatLiesBeyondAnEdgeIsSplitOff) {
  const OrientedBox box = MakeBox({2.95, 0.0}, 1.0, 0.5, 0.0);
  const Polygon polygon = ClipToRectangle(box, kMin, kMax);
  EXPECT_NEAR(Area(polygon), 0.25, 1e-12);
  for (const Vec2& corner : polygon) EXPECT_LE(corner.x(), 2.95);
}

TEST(PolygonTest, ABoxAcrossACornerLosesBothSides) {
  const OrientedBox diamond = MakeBox({2.95, 2.95}, std::sqrt(2.0), std::sqrt(2.0), kPi / 4.0);
  const Polygon polygon = ClipToRectangle(diamond, kMin, kMax);
  EXPECT_NEAR(Area(polygon), 0.5, 1e-9) << "a quarter of a diamond of area 2";
}

TEST(PolygonTest, NothingIsLeftOutsideOrOfAMereTouch) {
  EXPECT_TRUE(ClipToRectangle(MakeBox({5.0, 0.0}, 1.0, 1.0, 0.3), kMin, kMax).empty());
  EXPECT_TRUE(ClipToRectangle(MakeBox({3.45, 0.0}, 1.0, 1.0, 0.0), kMin, kMax).empty());
}

TEST(PolygonTest, ABoxAroundTheRectangleLeavesTheRectangle) {
  const Polygon polygon = ClipToRectangle(MakeBox({0.1, 0.2}, 20.0, 20.0, 0.4), kMin, kMax);
  EXPECT_NEAR(Area(polygon), 5.9 * 5.9, 1e-9);
}

RC_GTEST_PROP(PolygonTest, TheClippedPartIsConvexInsideBothAndCountedOnceInFourQuadrants, ()) {
  const OrientedBox box = testing::AnyBox(3.5);
  const Polygon whole = ClipToRectangle(box, kMin, kMax);
  double sum = 0.0;
  for (const double x : {kMin.x(), 0.0}) {
    for (const double y : {kMin.y(), 0.0}) {
      sum += Area(ClipToRectangle(box, {x, y}, {x + 2.95, y + 2.95}));
    }
  }
  RC_ASSERT(std::fabs(Area(whole) - sum) < 1e-9);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const Vec2& a = whole[i];
    const Vec2& b = whole[(i + 1) % whole.size()];
    const Vec2& c = whole[(i + 2) % whole.size()];
    RC_ASSERT(Cross(b - a, c - b) > -1e-9);
    RC_ASSERT(Contains(testing::Grown(box, 1e-9), a));
    RC_ASSERT((a.array() >= kMin.array()).all() && (a.array() <= kMax.array()).all());
  }
}

}  // namespace
}  // namespace gauntlet::sim
