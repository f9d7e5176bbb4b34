// Small arithmetic of ARGoS' interface.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

// Exponential and logarithm with the same bits on every x86-64 processor.
namespace reproducible {
Real Exponential(Real value);
Real Logarithm(Real value);
}  // namespace reproducible

template <typename T>
T Abs(const T& value) {
  if (value > T(0)) return value;
  if (value < T(0)) return -value;
  return T(0);
}

template <typename T>
T Min(const T& one, const T& other) {
  return one < other ? one : other;
}
template <typename T>
T& Min(T& one, T& other) {
  return one < other ? one : other;
}
template <typename T>
T Max(const T& one, const T& other) {
  return one > other ? one : other;
}
template <typename T>
T& Max(T& one, T& other) {
  return one > other ? one : other;
}

// -1, 0 or 1.
template <typename T>
SInt32 Sign(const T& value) {
  if (value > T(0)) return 1;
  return value < T(0) ? -1 : 0;
}

template <typename T>
T Square(const T& value) {
  return value * value;
}

// As ARGoS has it, a negative whole number goes one lower: Floor(-2) is -3.
inline SInt32 Floor(Real value) {
  return static_cast<SInt32>(value >= 0.0 ? value : value - 1.0);
}
inline SInt32 Ceil(Real value) {
  return static_cast<SInt32>(std::ceil(value));
}
// Halves go away from zero.
inline SInt32 Round(Real value) {
  return static_cast<SInt32>(value > 0.0 ? value + 0.5 : value - 0.5);
}
inline SInt32 RoundClosestToZero(Real value) {
  return static_cast<SInt32>(value);
}

inline bool DoubleEqAbsolute(Real one, Real other, Real epsilon) {
  return std::fabs(one - other) <= epsilon;
}
// Within 1e-4 of the larger of them, or of 1 when both are smaller.
inline bool DoubleEq(Real one, Real other) {
  return DoubleEqAbsolute(one, other, 1e-4 * std::max({1.0, std::fabs(one), std::fabs(other)}));
}

// On the polygon through these points, at least two of them sorted by x; beyond its ends the outermost lines
// go on.
inline Real Interpolate(Real x, const std::vector<std::pair<Real, Real>>& points) {
  std::size_t right = 1;
  while (right + 1 < points.size() && x > points[right].first) ++right;
  const auto& [x0, y0] = points[right - 1];
  const auto& [x1, y1] = points[right];
  return y0 + (x - x0) * (y1 - y0) / (x1 - x0);
}

}  // namespace argos

// Macros in ARGoS too, so that sources may name what they like best.
#define ARGOS_PI 3.14159265358979323846264338327950288
#define Sqrt ::sqrt
#define Mod ::fmod
#define Exp ::argos::reproducible::Exponential
#define Log ::argos::reproducible::Logarithm
