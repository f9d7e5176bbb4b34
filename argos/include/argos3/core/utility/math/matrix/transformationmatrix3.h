// Rotations and translations of space as matrices.
#pragma once

#include <argos3/core/utility/math/matrix/rotationmatrix3.h>

namespace argos {

class CTransformationMatrix3 : public CSquareMatrix<4> {
 public:
  CTransformationMatrix3() { SetIdentityMatrix(); }
  CTransformationMatrix3(const CMatrix<4, 4>& matrix) : CSquareMatrix<4>(matrix) {}
  CTransformationMatrix3(const CRotationMatrix3& rotation, const CVector3& translation) {
    SetFromComponents(rotation, translation);
  }

  void SetFromMatrix(const CMatrix<4, 4>& matrix) { *this = matrix; }
  void SetFromComponents(const CRotationMatrix3& rotation, const CVector3& translation) {
    SetIdentityMatrix();
    SetRotationMatrix(rotation);
    SetTranslationVector(translation);
  }
  void SetRotationMatrix(const CRotationMatrix3& rotation) {
    for (UInt32 i = 0; i < 3; ++i) {
      for (UInt32 j = 0; j < 3; ++j) (*this)(i, j) = rotation(i, j);
    }
  }
  CRotationMatrix3 GetRotationMatrix() const {
    CMatrix<3, 3> rotation;
    GetSubMatrix(rotation, 0, 0);
    return rotation;
  }
  void SetTranslationVector(const CVector3& translation) {
    (*this)(0, 3) = translation.GetX();
    (*this)(1, 3) = translation.GetY();
    (*this)(2, 3) = translation.GetZ();
  }
  CVector3 GetTranslationVector() const { return {(*this)(0, 3), (*this)(1, 3), (*this)(2, 3)}; }

  using CSquareMatrix<4>::operator*;
  CVector3 operator*(const CVector3& vector) const {
    const CMatrix<4, 4>& m = *this;
    const auto row = [&](UInt32 i) {
      return m(i, 0) * vector.GetX() + m(i, 1) * vector.GetY() + m(i, 2) * vector.GetZ() + m(i, 3);
    };
    return {row(0), row(1), row(2)};
  }
};

}  // namespace argos
