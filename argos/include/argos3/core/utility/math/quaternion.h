// Rotations of space.
#pragma once

#include <cmath>
#include <iostream>

#include <argos3/core/utility/math/matrix/rotationmatrix3.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CQuaternion {
 public:
  constexpr CQuaternion() = default;  // turns nothing
  constexpr CQuaternion(Real w, Real x, Real y, Real z) : w_(w), x_(x), y_(y), z_(z) {}
  CQuaternion(const CRadians& angle, const CVector3& axis) { FromAngleAxis(angle, axis); }
  // The shortest rotation that turns one vector into the other's direction.
  CQuaternion(const CVector3& from, const CVector3& to);

  Real GetW() const { return w_; }
  Real GetX() const { return x_; }
  Real GetY() const { return y_; }
  Real GetZ() const { return z_; }
  void SetW(Real w) { w_ = w; }
  void SetX(Real x) { x_ = x; }
  void SetY(Real y) { y_ = y; }
  void SetZ(Real z) { z_ = z; }
  void Set(Real w, Real x, Real y, Real z) { *this = CQuaternion(w, x, y, z); }
  Real SquareLength() const { return w_ * w_ + x_ * x_ + y_ * y_ + z_ * z_; }
  Real Length() const { return std::sqrt(SquareLength()); }

  CQuaternion Conjugate() const { return {w_, -x_, -y_, -z_}; }
  CQuaternion Inverse() const { return Conjugate(); }
  CQuaternion& Normalize();

  // The axis has the length 1.
  CQuaternion& FromAngleAxis(const CRadians& angle, const CVector3& axis);
  void ToAngleAxis(CRadians& angle, CVector3& axis) const;
  CQuaternion& BetweenTwoVectors(const CVector3& from, const CVector3& to) {
    return *this = CQuaternion(from, to);
  }
  // About the robot's z (yaw), y (pitch) and x (roll): Rx * Ry * Rz. On the plane z is the heading in [-pi,
  // pi].
  CQuaternion& FromEulerAngles(const CRadians& z, const CRadians& y, const CRadians& x);
  void ToEulerAngles(CRadians& z, CRadians& y, CRadians& x) const;

  bool operator==(const CQuaternion& other) const {
    return w_ == other.w_ && x_ == other.x_ && y_ == other.y_ && z_ == other.z_;
  }
  CQuaternion& operator+=(const CQuaternion& other) {
    return *this = {w_ + other.w_, x_ + other.x_, y_ + other.y_, z_ + other.z_};
  }
  CQuaternion& operator-=(const CQuaternion& other) {
    return *this = {w_ - other.w_, x_ - other.x_, y_ - other.y_, z_ - other.z_};
  }
  CQuaternion operator+(const CQuaternion& other) const { return CQuaternion(*this) += other; }
  CQuaternion operator-(const CQuaternion& other) const { return CQuaternion(*this) -= other; }
  CQuaternion operator*(const CQuaternion& other) const;
  CQuaternion& operator*=(const CQuaternion& other) { return *this = *this * other; }

  // In degrees: z,y,x.
  friend std::ostream& operator<<(std::ostream& stream, const CQuaternion& rotation);
  friend std::istream& operator>>(std::istream& stream, CQuaternion& rotation);

 private:
  Real w_ = 1.0;
  Real x_ = 0.0;
  Real y_ = 0.0;
  Real z_ = 0.0;
};

}  // namespace argos
