// Angles, ranges, vectors and rotations against what ARGoS computes.
// Covers: argos/utility/arithmetic.cc, argos/utility/quaternion.cc
#include <argos3/core/utility/math/bearing.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/ray2.h>
#include <argos3/core/utility/math/ray3.h>

#include <gtest/gtest.h>

#include <cmath>

namespace argos {
namespace {

TEST(Arithmetic, HasTheQuirksOfArgos) {
  EXPECT_EQ(Floor(2.5), 2);
  EXPECT_EQ(Floor(-2.5), -3);
  EXPECT_EQ(Floor(-2.0), -3);
  EXPECT_EQ(Round(2.5), 3);
  EXPECT_EQ(Round(-2.5), -3);
  EXPECT_EQ(Sign(-0.5), -1);
  EXPECT_TRUE(DoubleEq(1.0, 1.00005));
  EXPECT_FALSE(DoubleEq(1.0, 1.001));
  EXPECT_EQ(Abs(CRadians(-1.0)), CRadians(1.0));
  EXPECT_NEAR(Interpolate(3.0, {{0.0, 0.0}, {1.0, 1.0}, {2.0, 3.0}}), 5.0, 1e-15);
}

TEST(Angles, KeepBothEndsWhenTheyAreNormalised) {
  EXPECT_EQ(CRadians(CRadians::PI).SignedNormalize(), CRadians::PI);
  EXPECT_EQ((-CRadians::PI).SignedNormalize(), -CRadians::PI);
  EXPECT_EQ(CRadians(CRadians::TWO_PI).UnsignedNormalize(), CRadians::TWO_PI);
  EXPECT_NEAR(CRadians(5.0).SignedNormalize().GetValue(), 5.0 - 2.0 * ARGOS_PI, 1e-15);
  EXPECT_NEAR(CDegrees(-30.0).UnsignedNormalize().GetValue(), 330.0, 1e-12);
  EXPECT_EQ(NormalizedDifference(CRadians::PI, -CRadians::PI).GetValue(), 0.0);
  EXPECT_EQ(NormalizedDifference(-CRadians::PI_OVER_TWO, CRadians::PI_OVER_TWO), -CRadians::PI);
  EXPECT_EQ(NormalizedDifference(CDegrees(10.0), CDegrees(350.0)).GetValue(), 20.0);
}

TEST(Ray, GoesFromItsStartToItsEnd) {
  CRay3 ray(CVector3(1.0, 0.0, 0.0), CVector3::Z, 4.0);
  EXPECT_EQ(ray.GetEnd(), CVector3(1.0, 0.0, 4.0));
  CVector3 point;
  ray.GetPoint(point, 0.25);
  EXPECT_EQ(point, CVector3(1.0, 0.0, 1.0));
  EXPECT_EQ(ray.GetDistance(0.25), 1.0);
  ray.GetInverseDirection(point);
  EXPECT_EQ(point, CVector3(0.0, 0.0, -1.0));
  CRay2 flat(CVector2(0.0, 0.0), CVector2(3.0, 4.0));
  flat.SetLength(10.0);
  EXPECT_NEAR((flat.GetEnd() - CVector2(6.0, 8.0)).Length(), 0.0, 1e-14);
}

TEST(Angles, Convert) {
  EXPECT_NEAR(ToDegrees(CRadians(1.0)).GetValue(), 57.295779513082323, 1e-13);
  CRadians angle;
  angle.FromValueInDegrees(180.0);
  EXPECT_EQ(angle, CRadians::PI);
  EXPECT_NEAR(Sin(CRadians::PI_OVER_SIX), 0.5, 1e-15);
  EXPECT_NEAR(ACos(0.5).GetValue(), ARGOS_PI / 3.0, 1e-15);
  EXPECT_NEAR(ASin(-1.0).GetValue(), -ARGOS_PI / 2.0, 1e-15);
  EXPECT_EQ(CRadians::PI / CRadians::PI_OVER_TWO, 2.0);
}

// Of an angle that knows wrong ones, so that it shows where they come from.
TEST(Bearings, BringTheirSineAlong) {
  const CBearing bearing(0.5, 3.0, 4.0);
  EXPECT_EQ(Sin(bearing), 3.0);
  EXPECT_EQ(Cos(bearing), 4.0);
  EXPECT_EQ(CVector2(2.0, bearing), CVector2(8.0, 6.0));
  CVector2 vector;
  vector.FromPolarCoordinates(1.0, bearing);
  EXPECT_EQ(vector, CVector2(4.0, 3.0));
  const CBearing copy = bearing;
  EXPECT_EQ(Sin(copy), 3.0);
}

TEST(Bearings, ForgetTheirSineWithTheirValue) {
  const CRadians half(0.5);
  EXPECT_EQ(Sin(CBearing(half)), Sin(half));
  EXPECT_EQ(CVector2(1.0, CBearing(half)), CVector2(1.0, half));
  CBearing turned(0.25, 3.0, 4.0);
  turned += CRadians(0.25);
  EXPECT_EQ(Sin(turned), Sin(half));
  EXPECT_EQ(CVector2(1.0, turned), CVector2(1.0, half));
  CBearing set(0.0, 3.0, 4.0);
  set.SetValue(-0.0);
  EXPECT_EQ(Cos(set), 1.0);
  const CRadians angle = CBearing(0.5, 3.0, 4.0);
  EXPECT_EQ(Sin(angle), Sin(half));
}

TEST(Bearings, AreAnglesForEverythingElse) {
  const CBearing bearing(-0.5, 3.0, 4.0);
  const CRadians angle(0.25);
  EXPECT_EQ(bearing + angle, CRadians(-0.25));
  EXPECT_EQ(-bearing, CRadians(0.5));
  EXPECT_EQ(Abs(bearing), CRadians(0.5));
  EXPECT_EQ(Max(bearing, angle), angle);
  EXPECT_EQ(Min(angle, bearing), bearing);
  EXPECT_TRUE(bearing < angle);
  EXPECT_EQ(Sign(bearing), -1);
  EXPECT_NEAR(ToDegrees(bearing).GetValue(), -28.6478897565, 1e-9);
  EXPECT_EQ(true ? bearing : angle, bearing);
  EXPECT_EQ(CBearing(bearing).UnsignedNormalize(), CRadians(bearing).UnsignedNormalize());
  EXPECT_EQ(NormalizedDifference(bearing, angle), CRadians(-0.75));
}

TEST(Range, CutsWrapsAndMaps) {
  const CRange<Real> range(-1.0, 3.0);
  Real value = 7.5;
  range.WrapValue(value);
  EXPECT_EQ(value, -0.5);
  value = 9.0;
  range.TruncValue(value);
  EXPECT_EQ(value, 3.0);
  EXPECT_EQ(range.NormalizeValue(0.0), 0.25);
  CRadians mapped;
  range.MapValueIntoRange(mapped, 1.0, CRange<CRadians>(CRadians(0.0), CRadians(2.0)));
  EXPECT_EQ(mapped, CRadians(1.0));
  EXPECT_EQ(CRange<CRadians>(CRadians(0.0), CRadians(2.0)).NormalizeValue(CRadians(0.5)), 0.25);
  EXPECT_TRUE(range.WithinMinBoundIncludedMaxBoundExcluded(-1.0));
  EXPECT_FALSE(range.WithinMinBoundIncludedMaxBoundExcluded(3.0));
}

TEST(Vector2, TurnsAndMeasures) {
  EXPECT_EQ(CVector2().Angle(), CRadians::ZERO);
  EXPECT_EQ(CVector2(-1.0, 0.0).Angle(), CRadians::PI);
  const CVector2 turned = CVector2(1.0, 0.0).Rotate(CRadians::PI_OVER_TWO);
  EXPECT_NEAR(turned.GetX(), 0.0, 1e-15);
  EXPECT_NEAR(turned.GetY(), 1.0, 1e-15);
  EXPECT_TRUE(std::isnan(CVector2().Normalize().GetX()));
  EXPECT_EQ(CVector2(1.0, 2.0).Perpendicularize(), CVector2(-2.0, 1.0));
  EXPECT_EQ(CVector2(1.0, 2.0).CrossProduct(CVector2(3.0, 4.0)), -2.0);
  EXPECT_EQ(Distance(CVector2(1.0, 1.0), CVector2(4.0, 5.0)), 5.0);
  EXPECT_NEAR(CVector2(2.0, CRadians::PI_OVER_TWO).GetY(), 2.0, 1e-15);
}

TEST(Vector3, CrossProductChangesIt) {
  CVector3 vector(CVector3::X);
  EXPECT_EQ(vector.CrossProduct(CVector3::Y), CVector3::Z);
  EXPECT_EQ(vector, CVector3::Z);
  EXPECT_TRUE(CVector3(1.0, 1.0, 1.0) < CVector3(2.0, 2.0, 2.0));
  EXPECT_FALSE(CVector3(1.0, 3.0, 1.0) < CVector3(2.0, 2.0, 2.0));
  EXPECT_EQ(CVector3(0.0, 1.0, 5.0).GetZAngle(), CRadians::PI_OVER_TWO);
}

TEST(Quaternion, GivesTheHeadingOfARobotFirst) {
  for (const double heading : {0.0, 1.0, -3.0, 3.1}) {
    CRadians z;
    CRadians y;
    CRadians x;
    CQuaternion(CRadians(heading), CVector3::Z).ToEulerAngles(z, y, x);
    EXPECT_NEAR(z.GetValue(), heading, 1e-15);
    EXPECT_EQ(y.GetValue(), 0.0);
    EXPECT_EQ(x.GetValue(), 0.0);
  }
}

TEST(Quaternion, GivesBackItsEulerAngles) {
  CQuaternion rotation;
  rotation.FromEulerAngles(CRadians(0.5), CRadians(-0.4), CRadians(0.3));
  CRadians z;
  CRadians y;
  CRadians x;
  rotation.ToEulerAngles(z, y, x);
  EXPECT_NEAR(z.GetValue(), 0.5, 1e-14);
  EXPECT_NEAR(y.GetValue(), -0.4, 1e-14);
  EXPECT_NEAR(x.GetValue(), 0.3, 1e-14);
  const CVector3 turned = CVector3(CVector3::X).Rotate(CQuaternion(CVector3::X, CVector3::Y));
  EXPECT_NEAR(Distance(turned, CVector3::Y), 0.0, 1e-14);
}

}  // namespace
}  // namespace argos
