// Rotations of the plane as matrices.
#pragma once

#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/matrix/squarematrix.h>
#include <argos3/core/utility/math/vector2.h>

namespace argos {

class CRotationMatrix2 : public CSquareMatrix<2> {
 public:
  CRotationMatrix2() { SetIdentityMatrix(); }
  CRotationMatrix2(const CMatrix<2, 2>& matrix) : CSquareMatrix<2>(matrix) {}
  CRotationMatrix2(const CRadians& angle) { SetFromAngle(angle); }
  CRotationMatrix2(Real v0, Real v1, Real v2, Real v3) { SetFromValues(v0, v1, v2, v3); }

  void SetFromMatrix(const CMatrix<2, 2>& matrix) { *this = matrix; }
  void SetFromAngle(const CRadians& angle) {
    const Real sine = Sin(angle);
    const Real cosine = Cos(angle);
    SetFromValues(cosine, -sine, sine, cosine);
  }
  void SetFromValues(Real v0, Real v1, Real v2, Real v3) {
    const Real values[] = {v0, v1, v2, v3};
    Set(values);
  }

  using CSquareMatrix<2>::operator*;
  CVector2 operator*(const CVector2& vector) const {
    const CMatrix<2, 2>& m = *this;
    return {m(0) * vector.GetX() + m(1) * vector.GetY(), m(2) * vector.GetX() + m(3) * vector.GetY()};
  }
};

}  // namespace argos
