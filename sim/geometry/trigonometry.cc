#include "sim/geometry/trigonometry.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim/geometry/series.h"

namespace gauntlet::sim {
namespace {

using series::kHalfPiA;
using series::kHalfPiB;
using series::kHalfPiC;
using series::kTwoOverPi;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kReductionLimit = 1e6;

// ln 2 = A + B; A has 42 significant bits, so that n * A is exact for every exponent n.
constexpr double kLn2A = 0x1.62e42fefa38p-1;
constexpr double kLn2B = 0x1.ef35793c7673p-45;
constexpr double kOneOverLn2 = 0x1.71547652b82fep+0;

// Choices between results are made without branches: angles are random, so a branch would be guessed wrong
// every other time, which costs more than the polynomial.
double NegateIf(bool condition, double value) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^
                               (static_cast<std::uint64_t>(condition) << 63));
}

// 2^n for -1022 <= n <= 1023.
double PowerOfTwo(std::int64_t n) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52);
}

}  // namespace

SinCos SineCosine(double angle) {
  if (!(std::fabs(angle) < kReductionLimit)) [[unlikely]] {
    if (!std::isfinite(angle)) return {kNotANumber, kNotANumber};
    angle = std::fmod(angle, 2.0 * kPi);
  }
  const series::Reduced reduced = series::ReduceToOctant(angle);
  const double s = series::Sine(reduced.remainder);
  const double c = series::Cosine(reduced.remainder);
  const double both[2] = {s, c};
  const auto quadrant = static_cast<std::uint64_t>(static_cast<std::int64_t>(reduced.quadrant));
  return {NegateIf((quadrant & 2) != 0, both[quadrant & 1]),
          NegateIf(((quadrant + 1) & 2) != 0, both[(quadrant + 1) & 1])};
}

double Sin(double angle) {
  return SineCosine(angle).sin;
}

double Cos(double angle) {
  return SineCosine(angle).cos;
}

double Atan2(double y, double x) {
  const double opposite = std::fabs(y);
  const double adjacent = std::fabs(x);
  double larger = opposite > adjacent ? opposite : adjacent;
  // Written so that a NaN on either side survives in one of the two.
  double smaller = adjacent < opposite ? adjacent : opposite;
  if (!(larger > series::kShortest && larger < series::kLongest)) [[unlikely]] {
    if (larger == 0.0 && smaller == 0.0) return 0.0;
    if (!(std::isfinite(opposite) && std::isfinite(adjacent))) return kNotANumber;
    const double scale = larger < 1.0 ? 0x1p+100 : 0x1p-100;
    larger *= scale;
    smaller *= scale;
  }
  const double eighths = 8.0 * smaller;
  const int quarter = static_cast<int>(eighths > larger) + static_cast<int>(eighths > 3.0 * larger) +
                      static_cast<int>(eighths > 5.0 * larger) + static_cast<int>(eighths > 7.0 * larger);
  const double c = 0.25 * quarter;
  const double u = (smaller - c * larger) / (larger + c * smaller);
  static constexpr double kZeroOrHalfPi[2] = {0.0, 0.5 * kPi};
  static constexpr double kZeroOrPi[2] = {0.0, kPi};
  const bool steep = opposite > adjacent;
  const bool backward = x < 0.0;
  double angle = series::kArctangentOfQuarters[quarter] + series::Arctangent(u);
  angle = kZeroOrHalfPi[steep ? 1 : 0] + NegateIf(steep, angle);
  angle = kZeroOrPi[backward ? 1 : 0] + NegateIf(backward, angle);
  // -pi is the same direction as pi and outside the range.
  return NegateIf((y < 0.0) & (angle < kPi), angle);
}

double Exp(double x) {
  if (!(x < 709.79)) [[unlikely]] {
    if (std::isnan(x)) return kNotANumber;
    return kInfinity;
  }
  if (x < -745.2) [[unlikely]] {
    return 0.0;
  }
  const double n = std::floor(x * kOneOverLn2 + 0.5);
  const double r = (x - n * kLn2A) - n * kLn2B;
  // |r| <= ln(2) / 2; the first omitted term, r^14 / 14!, is below 5e-18.
  // c[n] = 1 / (n + 2)!
  static constexpr double c[] = {1.0 / 2.0,       1.0 / 6.0,        1.0 / 24.0,        1.0 / 120.0,
                                 1.0 / 720.0,     1.0 / 5040.0,     1.0 / 40320.0,     1.0 / 362880.0,
                                 1.0 / 3628800.0, 1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0};
  const double r2 = r * r;
  const double r4 = r2 * r2;
  const double low = (c[0] + c[1] * r) + (c[2] + c[3] * r) * r2;
  const double middle = (c[4] + c[5] * r) + (c[6] + c[7] * r) * r2;
  const double high = (c[8] + c[9] * r) + (c[10] + c[11] * r) * r2;
  const double value = 1.0 + (r + r2 * (low + r4 * (middle + r4 * high)));
  // 2^n in two factors, because n may lie beyond the exponents of normal numbers.
  const auto exponent = static_cast<std::int64_t>(n);
  const std::int64_t half = exponent / 2;
  return (value * PowerOfTwo(half)) * PowerOfTwo(exponent - half);
}

double Log(double x) {
  if (!(x >= std::numeric_limits<double>::min() && x < kInfinity)) [[unlikely]] {
    if (x == 0.0) return -kInfinity;
    if (!(x > 0.0)) return kNotANumber;
    if (x == kInfinity) return kInfinity;
    return Log(x * 0x1p+54) - 54.0 * (kLn2A + kLn2B);
  }
  constexpr std::uint64_t kFraction = (1ULL << 52) - 1;
  constexpr double kSqrtTwo = 1.4142135623730951;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  static constexpr double kOneOrHalf[2] = {1.0, 0.5};
  const double significand = std::bit_cast<double>((bits & kFraction) | (1023ULL << 52));
  const int above = significand > kSqrtTwo ? 1 : 0;
  const double mantissa = significand * kOneOrHalf[above];
  const auto exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023 + above);
  // log m = 2 artanh s with s = (m - 1) / (m + 1), |s| <= 0.1716; the first omitted term, s^22 / 23 relative
  // to the first, is below 1e-18.
  const double s = (mantissa - 1.0) / (mantissa + 1.0);
  static constexpr double c[] = {2.0,        2.0 / 3.0,  2.0 / 5.0,  2.0 / 7.0,  2.0 / 9.0, 2.0 / 11.0,
                                 2.0 / 13.0, 2.0 / 15.0, 2.0 / 17.0, 2.0 / 19.0, 2.0 / 21.0};
  const double z = s * s;
  const double z2 = z * z;
  const double z4 = z2 * z2;
  const double low = (c[1] + c[2] * z) + (c[3] + c[4] * z) * z2;
  const double middle = (c[5] + c[6] * z) + (c[7] + c[8] * z) * z2;
  const double high = c[9] + c[10] * z;
  const double log_mantissa = 2.0 * s + (s * z) * (low + z4 * (middle + z4 * high));
  return exponent * kLn2A + (log_mantissa + exponent * kLn2B);
}

double NormalDeviate(double probability) {
  constexpr std::array kA = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                             1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr std::array kB = {-5.447609879822406e+01, 1.615858368580409e+02,  -1.556989798598866e+02,
                             6.680131188771972e+01,  -1.328068155288572e+01, 1.0};
  constexpr std::array kC = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                             -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr std::array kD = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                             3.754408661907416e+00, 1.0};
  constexpr double kTail = 0.02425;
  const auto polynomial = [](const auto& coefficients, double x) {
    double sum = 0.0;
    for (const double one : coefficients) sum = sum * x + one;
    return sum;
  };
  if (probability > 0.5) return -NormalDeviate(1.0 - probability);
  if (probability < kTail) {
    const double q = std::sqrt(-2.0 * Log(probability));
    return polynomial(kC, q) / polynomial(kD, q);
  }
  const double q = probability - 0.5;
  return polynomial(kA, q * q) * q / polynomial(kB, q * q);
}

double WrapAngleOutOfRange(double angle) {
  if (!(std::fabs(angle) < kReductionLimit)) [[unlikely]] {
    angle = std::fmod(angle, 2.0 * kPi);
  }
  // Whole turns are four quarters: the split constants of pi/2 serve here too.
  const double n = 4.0 * std::floor(angle * (0.25 * kTwoOverPi) + 0.5);
  double wrapped = ((angle - n * kHalfPiA) - n * kHalfPiB) - n * kHalfPiC;
  // Near an odd multiple of pi the rounding of n may pick the neighbouring turn.
  if (wrapped > kPi) wrapped -= 2.0 * kPi;
  if (wrapped <= -kPi) wrapped += 2.0 * kPi;
  return wrapped;
}

}  // namespace gauntlet::sim
