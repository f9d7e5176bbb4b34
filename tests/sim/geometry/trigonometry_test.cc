#include "sim/geometry/trigonometry.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim/random/random_stream.h"
#include "tests/sim/geometry/generators.h"

namespace gauntlet::sim {
namespace {

constexpr int kPoints = 500'000;
constexpr double kStatedError = 1e-14;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Calls check(x) for kPoints numbers of either sign whose magnitude is log-uniform in [least, greatest], and
// for as many that are uniform in [-greatest, greatest].
template <typename Check>
void ForManyNumbers(double least, double greatest, Check check) {
  RandomStream random(20180, StreamPurpose::kTest);
  for (int i = 0; i < kPoints; ++i) {
    const double magnitude = least * std::pow(greatest / least, random.Uniform());
    check(random.Chance(0.5) ? magnitude : -magnitude);
    check(random.Uniform(-greatest, greatest));
  }
}

TEST(TrigonometryTest, SineAndCosineAgreeWithLongDouble) {
  for (const double greatest : {4.0, 1e3, 0.999999e6}) {
    double worst = 0.0;
    ForManyNumbers(1e-9, greatest, [&](double x) {
      const SinCos sc = SineCosine(x);
      const auto exact = static_cast<long double>(x);
      worst = std::max(worst, static_cast<double>(std::fabs(sc.sin - std::sin(exact))));
      worst = std::max(worst, static_cast<double>(std::fabs(sc.cos - std::cos(exact))));
    });
    EXPECT_LT(worst, kStatedError) << "up to " << greatest;
  }
}

TEST(TrigonometryTest, SineOfSmallAnglesKeepsItsRelativePrecision) {
  double worst = 0.0;
  ForManyNumbers(1e-300, 0.5, [&](double x) {
    const long double exact = std::sin(static_cast<long double>(x));
    worst = std::max(worst, static_cast<double>(std::fabs((Sin(x) - exact) / exact)));
  });
  EXPECT_LT(worst, kStatedError);
}

TEST(TrigonometryTest, QuarterTurnsAreRightToTheLastBit) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const SinCos sc = SineCosine(quarter * (kPi / 2.0));
    const int phase = ((quarter % 4) + 4) % 4;
    EXPECT_NEAR(sc.sin, (phase == 1) - (phase == 3), 2e-15) << quarter;
    EXPECT_NEAR(sc.cos, (phase == 0) - (phase == 2), 2e-15) << quarter;
  }
  EXPECT_EQ(Sin(0.0), 0.0);
  EXPECT_EQ(Cos(0.0), 1.0);
}

TEST(TrigonometryTest, HugeAnglesGiveUnitVectorsAndOthersNothing) {
  for (const double angle : {1e6, -1e9, 1e22, 1e300}) {
    const SinCos sc = SineCosine(angle);
    EXPECT_NEAR(sc.sin * sc.sin + sc.cos * sc.cos, 1.0, 1e-14) << angle;
  }
  EXPECT_TRUE(std::isnan(SineCosine(kInfinite).sin));
  EXPECT_TRUE(std::isnan(SineCosine(kNan).cos));
}

TEST(TrigonometryTest, ArctangentAgreesWithLongDouble) {
  RandomStream random(20181, StreamPurpose::kTest);
  double worst = 0.0;
  for (int i = 0; i < 2 * kPoints; ++i) {
    // Directions all around, at every ratio of magnitudes.
    const double scale = std::pow(10.0, random.Uniform(-30.0, 30.0));
    const double ratio = std::pow(10.0, random.Uniform(-18.0, 18.0));
    const double y = random.Uniform(-1.0, 1.0) * scale * (i % 2 == 0 ? 1.0 : ratio);
    const double x = random.Uniform(-1.0, 1.0) * scale;
    const double angle = Atan2(y, x);
    ASSERT_GT(angle, -kPi);
    ASSERT_LE(angle, kPi);
    const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    double error = static_cast<double>(std::fabs(angle - exact));
    // pi and -pi are the same direction.
    error = std::min(error, std::fabs(error - 2.0 * kPi));
    worst = std::max(worst, error);
  }
  EXPECT_LT(worst, kStatedError);
}

TEST(TrigonometryTest, ArctangentOfSpecialArguments) {
  EXPECT_EQ(Atan2(0.0, 0.0), 0.0);
  EXPECT_EQ(Atan2(-0.0, -0.0), 0.0);
  EXPECT_EQ(Atan2(0.0, 3.0), 0.0);
  EXPECT_EQ(Atan2(0.0, -3.0), kPi);
  EXPECT_EQ(Atan2(-0.0, -3.0), kPi);
  EXPECT_EQ(Atan2(-1e-300, -3.0), kPi) << "-pi is outside the range";
  EXPECT_EQ(Atan2(2.0, 0.0), kPi / 2.0);
  EXPECT_EQ(Atan2(-2.0, 0.0), -kPi / 2.0);
  EXPECT_EQ(Atan2(1.0, 1.0), kPi / 4.0);
  EXPECT_EQ(Atan2(1e308, 1e308), kPi / 4.0);
  EXPECT_EQ(Atan2(5e-324, 5e-324), kPi / 4.0);
  EXPECT_NEAR(Atan2(-1e308, 1e-308), -kPi / 2.0, 1e-15);
  EXPECT_TRUE(std::isnan(Atan2(kNan, 1.0)));
  EXPECT_TRUE(std::isnan(Atan2(1.0, kInfinite)));
}

TEST(TrigonometryTest, ExponentialAgreesWithLongDouble) {
  double worst = 0.0;
  ForManyNumbers(1e-12, 700.0, [&](double x) {
    const long double exact = std::exp(static_cast<long double>(x));
    worst = std::max(worst, static_cast<double>(std::fabs((Exp(x) - exact) / exact)));
  });
  EXPECT_LT(worst, kStatedError);
  EXPECT_EQ(Exp(0.0), 1.0);
  EXPECT_EQ(Exp(710.0), kInfinite);
  EXPECT_EQ(Exp(-1000.0), 0.0);
  EXPECT_EQ(Exp(-kInfinite), 0.0);
  EXPECT_GT(Exp(-744.0), 0.0) << "subnormal results exist";
  EXPECT_TRUE(std::isnan(Exp(kNan)));
}

TEST(TrigonometryTest, LogarithmAgreesWithLongDouble) {
  double worst = 0.0;
  const auto check = [&](double x) {
    const long double exact = std::log(static_cast<long double>(x));
    const long double error = std::fabs(Log(x) - exact);
    worst = std::max(worst, static_cast<double>(std::min(error, error / std::fabs(exact))));
  };
  ForManyNumbers(3e-308, 1e308, [&](double x) { check(std::max(std::fabs(x), 3e-308)); });
  ForManyNumbers(1e-16, 0.5, [&](double x) {
    if (1.0 + x != 1.0) check(1.0 + x);
  });
  EXPECT_LT(worst, kStatedError);
  EXPECT_EQ(Log(1.0), 0.0);
  EXPECT_EQ(Log(0.0), -kInfinite);
  EXPECT_TRUE(std::isnan(Log(-1.0)));
  EXPECT_NEAR(Log(5e-324), -744.44007192138127, 1e-11);
}

TEST(TrigonometryTest, WrappingKeepsAnglesInRangeAsTheyAre) {
  for (const double angle : {0.0, -0.0, 1e-300, -3.0, kPi, std::nextafter(-kPi, 0.0), 3.1415}) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(WrapAngle(angle)), std::bit_cast<std::uint64_t>(angle)) << angle;
  }
  EXPECT_EQ(WrapAngle(-kPi), kPi);
}

TEST(TrigonometryTest, WrappingKeepsTheDirection) {
  double worst = 0.0;
  ForManyNumbers(1.0, 0.999999e6, [&](double x) {
    const double wrapped = WrapAngle(x);
    ASSERT_GT(wrapped, -kPi);
    ASSERT_LE(wrapped, kPi);
    ASSERT_EQ(WrapAngle(wrapped), wrapped);
    const auto exact = static_cast<long double>(x);
    const auto result = static_cast<long double>(wrapped);
    worst = std::max(worst, static_cast<double>(std::fabs(std::sin(result) - std::sin(exact))));
    worst = std::max(worst, static_cast<double>(std::fabs(std::cos(result) - std::cos(exact))));
  });
  EXPECT_LT(worst, kStatedError);
}

TEST(TrigonometryTest, WrappingEndsInRangeNearEveryOddMultipleOfPiAndFarAway) {
  for (int turn = -159'001; turn < 159'000; turn += 14) {
    for (const double around : {-1e-9, -1e-15, 0.0, 1e-15, 1e-9}) {
      const double angle = turn * kPi + around;
      const double wrapped = WrapAngle(angle);
      ASSERT_GT(wrapped, -kPi) << angle;
      ASSERT_LE(wrapped, kPi) << angle;
      ASSERT_GT(std::fabs(wrapped), 3.14159) << angle;
    }
  }
  for (const double angle : {1e6, -1e7, 1e15, -1e100, 1.7e308}) {
    EXPECT_GT(WrapAngle(angle), -kPi) << angle;
    EXPECT_LE(WrapAngle(angle), kPi) << angle;
  }
}

RC_GTEST_PROP(TrigonometryTest, UnitVectorAndAngleOfAreInverse, ()) {
  const double angle = testing::AnyAngle();
  const Vec2 v = UnitVector(angle);
  RC_ASSERT(std::fabs(v.norm() - 1.0) < 1e-15);
  RC_ASSERT(std::fabs(WrapAngle(AngleOf(v) - angle)) < 1e-14);
}

// Stored results depend on every bit of these functions. A compiler that fuses or re-orders operations (g++
// 12 does when FMA instructions are allowed, in spite of -ffp-contract=off) changes some of these numbers.
TEST(TrigonometryTest, BitsNeverChange) {
  const auto expect_bits = [](double value, std::uint64_t bits, const char* what) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(value), bits) << what;
  };
  expect_bits(Sin(1.0), 0x3feaed548f090cee, "Sin(1)");
  expect_bits(Cos(1.0), 0x3fe14a280fb5068c, "Cos(1)");
  expect_bits(Sin(-2.5), 0xbfe326af0dcfcab0, "Sin(-2.5)");
  expect_bits(Cos(100.0), 0x3feb981dbf665fdf, "Cos(100)");
  expect_bits(Sin(999999.5), 0xbfe833357b1489f3, "Sin(999999.5)");
  expect_bits(Cos(0.7853981633974483), 0x3fe6a09e667f3bcd, "Cos(pi/4)");
  expect_bits(Atan2(1.0, 2.0), 0x3fddac670561bb4f, "Atan2(1, 2)");
  expect_bits(Atan2(-3.0, -0.1), 0xbff9aa76ecfd4070, "Atan2(-3, -0.1)");
  expect_bits(Atan2(0.3, -7.0), 0x4008ca4395cb9f0a, "Atan2(0.3, -7)");
  expect_bits(Exp(1.0), 0x4005bf0a8b14576a, "Exp(1)");
  expect_bits(Exp(-600.25), 0x09d03fcf33f2b267, "Exp(-600.25)");
  expect_bits(Log(2.0), 0x3fe62e42fefa39ef, "Log(2)");
  expect_bits(Log(0.1), 0xc0026bb1bbb55515, "Log(0.1)");
  expect_bits(Log(1e300), 0x4085963447f87fb5, "Log(1e300)");
  expect_bits(WrapAngle(4.0), 0xc00243f6a8885a31, "WrapAngle(4)");
  expect_bits(WrapAngle(-1000.0), 0xbfef27354d3fef61, "WrapAngle(-1000)");
}

TEST(NormalDeviateTest, IsNearTheTable) {
  EXPECT_NEAR(NormalDeviate(0.975), 1.959963985, 1e-8);
  EXPECT_NEAR(NormalDeviate(0.001), -3.090232306, 1e-8);
  EXPECT_EQ(NormalDeviate(0.5), 0.0);
}

}  // namespace
}  // namespace gauntlet::sim
