// A vector of the plane.
#pragma once

#include <array>
#include <cmath>
#include <iostream>

#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/bearing.h>
#include <argos3/core/utility/math/general.h>
#include <argos3/core/utility/math/matrix/matrix.h>

namespace argos {

class CVector2 {
 public:
  static const CVector2 X, Y, ZERO;

  constexpr CVector2() = default;
  constexpr CVector2(Real x, Real y) : x_(x), y_(y) {}
  explicit constexpr CVector2(const std::array<Real, 2>& values) : x_(values[0]), y_(values[1]) {}
  CVector2(Real length, const CRadians& angle) { FromPolarCoordinates(length, angle); }
  CVector2(Real length, const CBearing& angle) { FromPolarCoordinates(length, angle); }

  Real GetX() const { return x_; }
  Real GetY() const { return y_; }
  void SetX(Real x) { x_ = x; }
  void SetY(Real y) { y_ = y; }
  void Set(Real x, Real y) {
    x_ = x;
    y_ = y;
  }
  // Of a CRadians or a CBearing.
  template <typename Angle>
  void FromPolarCoordinates(Real length, const Angle& angle) {
    Real sine = 0.0;
    Real cosine = 0.0;
    SinCos(angle, sine, cosine);
    Set(length * cosine, length * sine);
  }

  Real SquareLength() const { return x_ * x_ + y_ * y_; }
  Real Length() const { return std::sqrt(SquareLength()); }
  // In (-pi, pi]; 0 of the zero vector.
  CRadians Angle() const { return ATan2(y_, x_); }

  // These change the vector. The zero vector normalised is no number.
  CVector2& Normalize() { return *this /= Length(); }
  CVector2& Rotate(const CRadians& angle) {
    Real sine = 0.0;
    Real cosine = 0.0;
    SinCos(angle, sine, cosine);
    Set(x_ * cosine - y_ * sine, x_ * sine + y_ * cosine);
    return *this;
  }
  CVector2& Scale(Real x, Real y) {
    Set(x_ * x, y_ * y);
    return *this;
  }
  CVector2& Perpendicularize() {
    Set(-y_, x_);
    return *this;
  }
  CVector2& Absolute() {
    Set(std::fabs(x_), std::fabs(y_));
    return *this;
  }

  Real DotProduct(const CVector2& other) const { return x_ * other.x_ + y_ * other.y_; }
  Real CrossProduct(const CVector2& other) const { return x_ * other.y_ - y_ * other.x_; }

  bool operator==(const CVector2& other) const { return x_ == other.x_ && y_ == other.y_; }
  CVector2& operator+=(const CVector2& other) {
    Set(x_ + other.x_, y_ + other.y_);
    return *this;
  }
  CVector2& operator-=(const CVector2& other) {
    Set(x_ - other.x_, y_ - other.y_);
    return *this;
  }
  CVector2& operator*=(Real factor) {
    Set(x_ * factor, y_ * factor);
    return *this;
  }
  CVector2& operator/=(Real divisor) {
    Set(x_ / divisor, y_ / divisor);
    return *this;
  }
  CVector2 operator+(const CVector2& other) const { return {x_ + other.x_, y_ + other.y_}; }
  CVector2 operator-(const CVector2& other) const { return {x_ - other.x_, y_ - other.y_}; }
  CVector2 operator*(Real factor) const { return {x_ * factor, y_ * factor}; }
  CVector2 operator/(Real divisor) const { return {x_ / divisor, y_ / divisor}; }
  CVector2 operator-() const { return {-x_, -y_}; }
  friend CVector2 operator*(Real factor, const CVector2& vector) {
    return {factor * vector.x_, factor * vector.y_};
  }
  friend std::ostream& operator<<(std::ostream& stream, const CVector2& vector) {
    return stream << vector.x_ << "," << vector.y_;
  }
  friend std::istream& operator>>(std::istream& stream, CVector2& vector) {
    Real values[2];
    ParseValues<Real>(stream, 2, values, ',');
    vector.Set(values[0], values[1]);
    return stream;
  }

 private:
  Real x_ = 0.0;
  Real y_ = 0.0;
};

inline constexpr CVector2 CVector2::X(1.0, 0.0);
inline constexpr CVector2 CVector2::Y(0.0, 1.0);
inline constexpr CVector2 CVector2::ZERO(0.0, 0.0);

inline Real SquareDistance(const CVector2& one, const CVector2& other) {
  return (one - other).SquareLength();
}
inline Real Distance(const CVector2& one, const CVector2& other) {
  return (one - other).Length();
}

}  // namespace argos
