// Trigonometry with the same bits on every x86-64 CPU. libm chooses code paths by CPU features (FMA), so its
// double sin, cos, atan2, exp and log differ in the last bit between nodes; these use only +, -, *, / and
// sqrt, which IEEE 754 fixes.
#pragma once

#include "sim/geometry/vec2.h"

namespace gauntlet::sim {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;

struct SinCos {
  double sin;
  double cos;
};
// Any finite angle up to |angle| < 1e6 rad; error below 1e-14 absolute there.
SinCos SineCosine(double angle);
double Sin(double angle);
double Cos(double angle);
// Result in (-pi, pi]; Atan2(0, 0) = 0; error below 1e-14.
double Atan2(double y, double x);
// e^x; relative error below 1e-14 for |x| < 700.
double Exp(double x);
// Natural logarithm of a positive normal number; error below 1e-14 relative or absolute.
double Log(double x);
// The angle in (-pi, pi]. Any finite angle.
double WrapAngle(double angle);

inline Vec2 UnitVector(double angle) {
  const SinCos sc = SineCosine(angle);
  return {sc.cos, sc.sin};
}
// Direction of v in (-pi, pi]; 0 for the zero vector.
inline double AngleOf(const Vec2& v) {
  return Atan2(v.y(), v.x());
}

}  // namespace gauntlet::sim
