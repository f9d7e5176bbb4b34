#include <argos3/core/utility/math/quaternion.h>

namespace argos {

CQuaternion::CQuaternion(const CVector3& from, const CVector3& to) {
  const CVector3 one = CVector3(from).Normalize();
  const CVector3 other = CVector3(to).Normalize();
  const Real cosine = one.DotProduct(other);
  if (cosine > -1.0 + 1e-12) {
    const CVector3 axis = CVector3(one).CrossProduct(other);
    Set(1.0 + cosine, axis.GetX(), axis.GetY(), axis.GetZ());
  } else {  // half a turn about any axis across
    const CVector3 across =
        CVector3(one).CrossProduct(std::fabs(one.GetX()) < 0.9 ? CVector3::X : CVector3::Y);
    Set(0.0, across.GetX(), across.GetY(), across.GetZ());
  }
  Normalize();
}

CQuaternion& CQuaternion::Normalize() {
  const Real length = Length();
  Set(w_ / length, x_ / length, y_ / length, z_ / length);
  return *this;
}

CQuaternion& CQuaternion::FromAngleAxis(const CRadians& angle, const CVector3& axis) {
  Real sine = 0.0;
  Real cosine = 0.0;
  SinCos(angle * 0.5, sine, cosine);
  Set(cosine, axis.GetX() * sine, axis.GetY() * sine, axis.GetZ() * sine);
  return *this;
}

void CQuaternion::ToAngleAxis(CRadians& angle, CVector3& axis) const {
  const Real length = std::sqrt(x_ * x_ + y_ * y_ + z_ * z_);
  angle = 2.0 * ATan2(length, w_);
  axis = length > 0.0 ? CVector3(x_, y_, z_) / length : CVector3::X;
}

CQuaternion& CQuaternion::FromEulerAngles(const CRadians& z, const CRadians& y, const CRadians& x) {
  *this = CQuaternion(x, CVector3::X) * CQuaternion(y, CVector3::Y) * CQuaternion(z, CVector3::Z);
  return *this;
}

void CQuaternion::ToEulerAngles(CRadians& z, CRadians& y, CRadians& x) const {
  const Real half_sine = x_ * z_ + w_ * y_;
  if (std::fabs(half_sine) > 0.49999) {  // looking straight up or down: only z and x together are known
    z = 2.0 * ATan2(half_sine > 0.0 ? x_ : -x_, w_);
    z.SignedNormalize();
    y = half_sine > 0.0 ? CRadians::PI_OVER_TWO : -CRadians::PI_OVER_TWO;
    x = CRadians::ZERO;
    return;
  }
  z = ATan2(2.0 * (w_ * z_ - x_ * y_), 1.0 - 2.0 * (y_ * y_ + z_ * z_));
  y = ASin(2.0 * half_sine);
  x = ATan2(2.0 * (w_ * x_ - y_ * z_), 1.0 - 2.0 * (x_ * x_ + y_ * y_));
}

CQuaternion CQuaternion::operator*(const CQuaternion& other) const {
  return {w_ * other.w_ - x_ * other.x_ - y_ * other.y_ - z_ * other.z_,
          w_ * other.x_ + x_ * other.w_ + y_ * other.z_ - z_ * other.y_,
          w_ * other.y_ - x_ * other.z_ + y_ * other.w_ + z_ * other.x_,
          w_ * other.z_ + x_ * other.y_ - y_ * other.x_ + z_ * other.w_};
}

std::ostream& operator<<(std::ostream& stream, const CQuaternion& rotation) {
  CRadians z;
  CRadians y;
  CRadians x;
  rotation.ToEulerAngles(z, y, x);
  return stream << ToDegrees(z).GetValue() << "," << ToDegrees(y).GetValue() << ","
                << ToDegrees(x).GetValue();
}

std::istream& operator>>(std::istream& stream, CQuaternion& rotation) {
  Real degrees[3];
  ParseValues<Real>(stream, 3, degrees, ',');
  rotation.FromEulerAngles(ToRadians(CDegrees(degrees[0])), ToRadians(CDegrees(degrees[1])),
                           ToRadians(CDegrees(degrees[2])));
  return stream;
}

CVector3& CVector3::Rotate(const CQuaternion& rotation) {
  const CQuaternion turned = rotation * CQuaternion(0.0, GetX(), GetY(), GetZ()) * rotation.Inverse();
  return Set(turned.GetX(), turned.GetY(), turned.GetZ());
}

void CRotationMatrix3::SetFromAngles(const CRadians& z, const CRadians& y, const CRadians& x) {
  Real sx = 0.0, cx = 0.0, sy = 0.0, cy = 0.0, sz = 0.0, cz = 0.0;
  SinCos(x, sx, cx);
  SinCos(y, sy, cy);
  SinCos(z, sz, cz);
  SetFromValues(cz * cy, cz * sy * sx - cx * sz, sz * sx + cz * cx * sy,  //
                cy * sz, cz * cx + sz * sy * sx, cx * sz * sy - cz * sx,  //
                -sy, cy * sx, cy * cx);
}

// From the largest part, so that nothing is divided by little.
CRotationMatrix3::operator CQuaternion() const {
  const CMatrix<3, 3>& m = *this;
  constexpr Real kLittle = 1e-5;
  if (const Real trace = 1.0 + m(0) + m(4) + m(8); trace > kLittle) {
    const Real s = 2.0 * std::sqrt(trace);
    return {s / 4.0, (m(7) - m(5)) / s, (m(2) - m(6)) / s, (m(3) - m(1)) / s};
  }
  if (m(0) > m(4) && m(0) > m(8)) {
    const Real s = 2.0 * std::sqrt(1.0 + m(0) - m(4) - m(8));
    return {(m(7) - m(5)) / s, s / 4.0, (m(3) + m(1)) / s, (m(2) + m(6)) / s};
  }
  if (m(4) > m(8)) {
    const Real s = 2.0 * std::sqrt(1.0 + m(4) - m(0) - m(8));
    return {(m(2) - m(6)) / s, (m(3) + m(1)) / s, s / 4.0, (m(7) + m(5)) / s};
  }
  const Real s = 2.0 * std::sqrt(1.0 + m(8) - m(0) - m(4));
  return {(m(3) - m(1)) / s, (m(2) + m(6)) / s, (m(7) + m(5)) / s, s / 4.0};
}

}  // namespace argos
