// Angles in radians and in degrees, counter-clockwise. No arithmetic brings them into a range.
#pragma once

#include <cmath>
#include <compare>
#include <iostream>
#include <limits>
#include <utility>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/math/general.h>
#include <argos3/core/utility/math/range.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

// What both kinds of angles have in common.
template <typename Angle>
class CAngle {
 public:
  constexpr CAngle() = default;
  explicit constexpr CAngle(Real value) : value_(value) {}

  constexpr Real GetValue() const { return value_; }
  void SetValue(Real value) { value_ = value; }
  Real GetAbsoluteValue() const { return std::fabs(value_); }
  // Into the range of that name, in place; both of its ends stay.
  Angle& SignedNormalize() {
    Angle::SIGNED_RANGE.WrapValue(static_cast<Angle&>(*this));
    return static_cast<Angle&>(*this);
  }
  Angle& UnsignedNormalize() {
    Angle::UNSIGNED_RANGE.WrapValue(static_cast<Angle&>(*this));
    return static_cast<Angle&>(*this);
  }

  constexpr Angle operator+() const { return Angle(value_); }
  constexpr Angle operator-() const { return Angle(-value_); }
  Angle& operator+=(const Angle& other) { return Set(value_ + other.GetValue()); }
  Angle& operator-=(const Angle& other) { return Set(value_ - other.GetValue()); }
  Angle& operator*=(Real factor) { return Set(value_ * factor); }
  Angle& operator/=(Real divisor) { return Set(value_ / divisor); }
  friend constexpr Angle operator+(const Angle& one, const Angle& other) {
    return Angle(one.GetValue() + other.GetValue());
  }
  friend constexpr Angle operator-(const Angle& one, const Angle& other) {
    return Angle(one.GetValue() - other.GetValue());
  }
  friend constexpr Angle operator*(const Angle& angle, Real factor) {
    return Angle(angle.GetValue() * factor);
  }
  friend constexpr Angle operator*(Real factor, const Angle& angle) {
    return Angle(factor * angle.GetValue());
  }
  friend constexpr Angle operator/(const Angle& angle, Real divisor) {
    return Angle(angle.GetValue() / divisor);
  }
  friend constexpr Real operator/(const Angle& one, const Angle& other) {
    return one.GetValue() / other.GetValue();
  }
  friend constexpr bool operator==(const Angle& one, const Angle& other) {
    return one.GetValue() == other.GetValue();
  }
  friend constexpr std::partial_ordering operator<=>(const Angle& one, const Angle& other) {
    return one.GetValue() <=> other.GetValue();
  }
  friend std::istream& operator>>(std::istream& stream, Angle& angle) {
    Real value = 0.0;
    if (stream >> value) angle.SetValue(value);
    return stream;
  }

 protected:
  Angle& Set(Real value) {
    value_ = value;
    return static_cast<Angle&>(*this);
  }

 private:
  Real value_ = 0.0;
};

class CDegrees;

class CRadians : public CAngle<CRadians> {
 public:
  using CAngle::CAngle;

  static const CRadians PI, TWO_PI, PI_OVER_TWO, PI_OVER_THREE, PI_OVER_FOUR, PI_OVER_SIX, ZERO;
  static const Real RADIANS_TO_DEGREES;
  static const CRange<CRadians> SIGNED_RANGE;    // [-pi, pi]
  static const CRange<CRadians> UNSIGNED_RANGE;  // [0, 2 pi]

  void FromValueInDegrees(Real value);
  CRadians& Negate() { return Set(-GetValue()); }
};

class CDegrees : public CAngle<CDegrees> {
 public:
  using CAngle::CAngle;

  static const Real DEGREES_TO_RADIANS;
  static const CRange<CDegrees> SIGNED_RANGE;    // [-180, 180]
  static const CRange<CDegrees> UNSIGNED_RANGE;  // [0, 360]

  void FromValueInRadians(Real value) { SetValue(value * CRadians::RADIANS_TO_DEGREES); }
};

inline constexpr CRadians CRadians::PI(ARGOS_PI);
inline constexpr CRadians CRadians::TWO_PI(2.0 * ARGOS_PI);
inline constexpr CRadians CRadians::PI_OVER_TWO(ARGOS_PI / 2.0);
inline constexpr CRadians CRadians::PI_OVER_THREE(ARGOS_PI / 3.0);
inline constexpr CRadians CRadians::PI_OVER_FOUR(ARGOS_PI / 4.0);
inline constexpr CRadians CRadians::PI_OVER_SIX(ARGOS_PI / 6.0);
inline constexpr CRadians CRadians::ZERO(0.0);
inline constexpr Real CRadians::RADIANS_TO_DEGREES = 180.0 / ARGOS_PI;
inline constexpr CRange<CRadians> CRadians::SIGNED_RANGE(CRadians(-ARGOS_PI), CRadians(ARGOS_PI));
inline constexpr CRange<CRadians> CRadians::UNSIGNED_RANGE(CRadians(0.0), CRadians(2.0 * ARGOS_PI));
inline constexpr Real CDegrees::DEGREES_TO_RADIANS = ARGOS_PI / 180.0;
inline constexpr CRange<CDegrees> CDegrees::SIGNED_RANGE(CDegrees(-180.0), CDegrees(180.0));
inline constexpr CRange<CDegrees> CDegrees::UNSIGNED_RANGE(CDegrees(0.0), CDegrees(360.0));

inline void CRadians::FromValueInDegrees(Real value) {
  SetValue(value * CDegrees::DEGREES_TO_RADIANS);
}

inline CDegrees ToDegrees(const CRadians& angle) {
  return CDegrees(angle.GetValue() * CRadians::RADIANS_TO_DEGREES);
}
inline CRadians ToRadians(const CDegrees& angle) {
  return CRadians(angle.GetValue() * CDegrees::DEGREES_TO_RADIANS);
}

// one - other in [-pi, pi) and [-180, 180).
CRadians NormalizedDifference(const CRadians& one, const CRadians& other);
CDegrees NormalizedDifference(const CDegrees& one, const CDegrees& other);

// The same bits on every x86-64 processor.
// By these names sources mean the C library's.
#define ARGOS_SIN ::sin
#define ARGOS_ASIN ::asin
#define ARGOS_COS ::cos
#define ARGOS_ACOS ::acos
#define ARGOS_TAN ::tan
#define ARGOS_ATAN2 ::atan2

Real Sin(const CRadians& angle);
Real Cos(const CRadians& angle);
Real Tan(const CRadians& angle);
void SinCos(const CRadians& angle, Real& sine, Real& cosine);
CRadians ASin(Real value);
CRadians ACos(Real value);
CRadians ATan2(Real y, Real x);

std::ostream& operator<<(std::ostream& stream, const CRadians& angle);
std::ostream& operator<<(std::ostream& stream, const CDegrees& angle);

}  // namespace argos
