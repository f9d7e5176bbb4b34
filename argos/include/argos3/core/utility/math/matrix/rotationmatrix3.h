// Rotations of space as matrices.
#pragma once

#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/matrix/squarematrix.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CQuaternion;

class CRotationMatrix3 : public CSquareMatrix<3> {
 public:
  CRotationMatrix3() { SetIdentityMatrix(); }
  CRotationMatrix3(const CMatrix<3, 3>& matrix) : CSquareMatrix<3>(matrix) {}
  CRotationMatrix3(const CRadians& z, const CRadians& y, const CRadians& x) { SetFromAngles(z, y, x); }
  CRotationMatrix3(Real v0, Real v1, Real v2, Real v3, Real v4, Real v5, Real v6, Real v7, Real v8) {
    SetFromValues(v0, v1, v2, v3, v4, v5, v6, v7, v8);
  }

  void SetFromMatrix(const CMatrix<3, 3>& matrix) { *this = matrix; }
  // First about x, then y, then z: Rz * Ry * Rx.
  void SetFromAngles(const CRadians& z, const CRadians& y, const CRadians& x);
  void SetFromValues(Real v0, Real v1, Real v2, Real v3, Real v4, Real v5, Real v6, Real v7, Real v8) {
    const Real values[] = {v0, v1, v2, v3, v4, v5, v6, v7, v8};
    Set(values);
  }

  operator CQuaternion() const;
  using CSquareMatrix<3>::operator*;
  CVector3 operator*(const CVector3& vector) const {
    const CMatrix<3, 3>& m = *this;
    const auto row = [&](UInt32 i) {
      return m(i, 0) * vector.GetX() + m(i, 1) * vector.GetY() + m(i, 2) * vector.GetZ();
    };
    return {row(0), row(1), row(2)};
  }
};

}  // namespace argos
