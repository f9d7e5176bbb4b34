// Rotations and translations of the plane as matrices.
#pragma once

#include <argos3/core/utility/math/matrix/rotationmatrix2.h>

namespace argos {

class CTransformationMatrix2 : public CSquareMatrix<3> {
 public:
  CTransformationMatrix2() { SetIdentityMatrix(); }
  CTransformationMatrix2(const CMatrix<3, 3>& matrix) : CSquareMatrix<3>(matrix) {}
  CTransformationMatrix2(const CRotationMatrix2& rotation, const CVector2& translation) {
    SetFromComponents(rotation, translation);
  }

  void SetFromMatrix(const CMatrix<3, 3>& matrix) { *this = matrix; }
  void SetFromComponents(const CRotationMatrix2& rotation, const CVector2& translation) {
    SetIdentityMatrix();
    SetRotationMatrix(rotation);
    SetTranslationVector(translation);
  }
  void SetRotationMatrix(const CRotationMatrix2& rotation) {
    for (UInt32 i = 0; i < 2; ++i) {
      for (UInt32 j = 0; j < 2; ++j) (*this)(i, j) = rotation(i, j);
    }
  }
  CRotationMatrix2 GetRotationMatrix() const {
    CMatrix<2, 2> rotation;
    GetSubMatrix(rotation, 0, 0);
    return rotation;
  }
  void SetTranslationVector(const CVector2& translation) {
    (*this)(0, 2) = translation.GetX();
    (*this)(1, 2) = translation.GetY();
  }
  CVector2 GetTranslationVector() const { return {(*this)(0, 2), (*this)(1, 2)}; }
};

}  // namespace argos
