// Trigonometry with the same bits on every x86-64 CPU. libm chooses code paths by CPU features (FMA), so its
// double sin, cos, atan2, exp and log differ in the last bit between nodes; these use only +, -, *, /, sqrt
// and floor, which IEEE 754 fixes.
#pragma once

#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;

struct SinCos {
  double sin;
  double cos;
};
// Any finite angle up to |angle| < 1e6 rad; error below 1e-14 absolute there. Larger angles are first taken
// modulo the double nearest to 2 pi, so they give a point of the unit circle but not the exact one; an angle
// that is not finite gives NaN.
SinCos SineCosine(double angle);
double Sin(double angle);
double Cos(double angle);
// Result in (-pi, pi]; Atan2(0, 0) = 0 whatever the signs of the zeros; error below 1e-14. Finite arguments
// only; others give NaN.
double Atan2(double y, double x);
// e^x; relative error below 1e-14 for |x| < 700. Overflows to infinity, underflows to 0.
double Exp(double x);
// Natural logarithm of a positive normal number; error below 1e-14 relative or absolute. Log(0) = -infinity,
// NaN below.
double Log(double x);

// The number below which a standard normal value lies with this probability, in (0, 1): Acklam's rational
// approximation (2003); relative error below 1.2e-9.
double NormalDeviate(double probability);

// WrapAngle for an angle outside (-pi, pi].
double WrapAngleOutOfRange(double angle);
// The angle in (-pi, pi]. An angle that is already there comes back unchanged; error below 1e-14 up to
// |angle| < 1e6 rad; any finite angle ends in range.
inline double WrapAngle(double angle) {
  return angle > -kPi && angle <= kPi ? angle : WrapAngleOutOfRange(angle);
}

inline Vec2 UnitVector(double angle) {
  const SinCos sc = SineCosine(angle);
  return {sc.cos, sc.sin};
}
// Direction of v in (-pi, pi]; 0 for the zero vector.
inline double AngleOf(const Vec2& v) {
  return Atan2(v.y(), v.x());
}

}  // namespace gauntlet::sim
