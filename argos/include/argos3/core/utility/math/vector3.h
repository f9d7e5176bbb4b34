// A vector of space.
#pragma once

#include <array>
#include <cmath>
#include <iostream>

#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CQuaternion;

class CVector3 {
 public:
  static const CVector3 X, Y, Z, ZERO;

  constexpr CVector3() = default;
  constexpr CVector3(Real x, Real y, Real z) : values_{x, y, z} {}
  CVector3(Real length, const CRadians& inclination, const CRadians& azimuth) {
    FromSphericalCoords(length, inclination, azimuth);
  }

  Real GetX() const { return values_[0]; }
  Real GetY() const { return values_[1]; }
  Real GetZ() const { return values_[2]; }
  void SetX(Real x) { values_[0] = x; }
  void SetY(Real y) { values_[1] = y; }
  void SetZ(Real z) { values_[2] = z; }
  CVector3& Set(Real x, Real y, Real z) {
    values_ = {x, y, z};
    return *this;
  }
  // 0, 1, 2: x, y, z.
  Real operator[](UInt32 index) const { return values_.at(index); }
  Real& operator[](UInt32 index) { return values_.at(index); }

  Real SquareLength() const { return DotProduct(*this); }
  Real Length() const { return std::sqrt(SquareLength()); }
  CRadians GetXAngle() const { return ATan2(GetZ(), GetY()); }
  CRadians GetYAngle() const { return ATan2(GetX(), GetZ()); }
  CRadians GetZAngle() const { return ATan2(GetY(), GetX()); }
  CRadians GetAngleWith(const CVector3& other) const {
    return ACos(DotProduct(other) / (Length() * other.Length()));
  }
  Real DotProduct(const CVector3& other) const {
    return GetX() * other.GetX() + GetY() * other.GetY() + GetZ() * other.GetZ();
  }
  void ProjectOntoXY(CVector2& projection) const { projection.Set(GetX(), GetY()); }
  void ProjectOntoYZ(CVector2& projection) const { projection.Set(GetY(), GetZ()); }
  void ProjectOntoXZ(CVector2& projection) const { projection.Set(GetX(), GetZ()); }
  // The inclination is the angle from +Z, the azimuth that from +X on the plane.
  void ToSphericalCoords(Real& length, CRadians& inclination, CRadians& azimuth) const;

  // These change the vector.
  CVector3& FromSphericalCoords(Real length, const CRadians& inclination, const CRadians& azimuth);
  CVector3& Normalize() { return *this /= Length(); }
  CVector3& Negate() { return Set(-GetX(), -GetY(), -GetZ()); }
  CVector3& RotateX(const CRadians& angle);
  CVector3& RotateY(const CRadians& angle);
  CVector3& RotateZ(const CRadians& angle);
  CVector3& Rotate(const CQuaternion& rotation);
  CVector3& CrossProduct(const CVector3& other) {
    return Set(GetY() * other.GetZ() - GetZ() * other.GetY(), GetZ() * other.GetX() - GetX() * other.GetZ(),
               GetX() * other.GetY() - GetY() * other.GetX());
  }

  bool operator==(const CVector3& other) const { return values_ == other.values_; }
  // True when it is of each of the three.
  bool operator<(const CVector3& other) const {
    return GetX() < other.GetX() && GetY() < other.GetY() && GetZ() < other.GetZ();
  }
  bool operator<=(const CVector3& other) const {
    return GetX() <= other.GetX() && GetY() <= other.GetY() && GetZ() <= other.GetZ();
  }
  bool operator>(const CVector3& other) const { return other < *this; }
  bool operator>=(const CVector3& other) const { return other <= *this; }
  CVector3& operator+=(const CVector3& other) {
    return Set(GetX() + other.GetX(), GetY() + other.GetY(), GetZ() + other.GetZ());
  }
  CVector3& operator-=(const CVector3& other) {
    return Set(GetX() - other.GetX(), GetY() - other.GetY(), GetZ() - other.GetZ());
  }
  CVector3& operator*=(Real factor) { return Set(GetX() * factor, GetY() * factor, GetZ() * factor); }
  CVector3& operator/=(Real divisor) { return Set(GetX() / divisor, GetY() / divisor, GetZ() / divisor); }
  CVector3 operator+(const CVector3& other) const { return CVector3(*this) += other; }
  CVector3 operator-(const CVector3& other) const { return CVector3(*this) -= other; }
  CVector3 operator*(Real factor) const { return CVector3(*this) *= factor; }
  CVector3 operator/(Real divisor) const { return CVector3(*this) /= divisor; }
  CVector3 operator-() const { return CVector3(*this).Negate(); }
  friend CVector3 operator*(Real factor, const CVector3& vector) { return vector * factor; }
  friend std::ostream& operator<<(std::ostream& stream, const CVector3& vector) {
    return stream << vector.GetX() << "," << vector.GetY() << "," << vector.GetZ();
  }
  friend std::istream& operator>>(std::istream& stream, CVector3& vector) {
    Real values[3];
    ParseValues<Real>(stream, 3, values, ',');
    vector.Set(values[0], values[1], values[2]);
    return stream;
  }

 private:
  std::array<Real, 3> values_{};
};

inline constexpr CVector3 CVector3::X(1.0, 0.0, 0.0);
inline constexpr CVector3 CVector3::Y(0.0, 1.0, 0.0);
inline constexpr CVector3 CVector3::Z(0.0, 0.0, 1.0);
inline constexpr CVector3 CVector3::ZERO(0.0, 0.0, 0.0);

inline Real SquareDistance(const CVector3& one, const CVector3& other) {
  return (one - other).SquareLength();
}
inline Real Distance(const CVector3& one, const CVector3& other) {
  return (one - other).Length();
}

}  // namespace argos
