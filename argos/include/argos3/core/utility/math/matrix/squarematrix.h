// Matrices with as many rows as columns.
#pragma once

#include <argos3/core/utility/math/matrix/matrix.h>

namespace argos {

template <UInt32 DIM>
class CSquareMatrix : public CMatrix<DIM, DIM> {
 public:
  CSquareMatrix() = default;
  CSquareMatrix(const CMatrix<DIM, DIM>& other) : CMatrix<DIM, DIM>(other) {}

  void SetIdentityMatrix() {
    for (UInt32 i = 0; i < DIM; ++i) {
      for (UInt32 j = 0; j < DIM; ++j) (*this)(i, j) = i == j ? 1.0 : 0.0;
    }
  }
  bool IsIdentityMatrix() const {
    CSquareMatrix identity;
    identity.SetIdentityMatrix();
    return *this == identity;
  }

  Real GetDeterminant() const {
    if constexpr (DIM == 1) {
      return (*this)(0);
    } else if constexpr (DIM == 2) {
      return (*this)(0) * (*this)(3) - (*this)(2) * (*this)(1);
    } else {
      Real determinant = 0.0;
      for (UInt32 column = 0; column < DIM; ++column) {
        determinant += Sign(column) * (*this)(0, column) * Without(0, column).GetDeterminant();
      }
      return determinant;
    }
  }
  CSquareMatrix GetCofactorMatrix() const {
    CSquareMatrix cofactors;
    for (UInt32 i = 0; i < DIM; ++i) {
      for (UInt32 j = 0; j < DIM; ++j) cofactors(i, j) = Sign(i + j) * Without(i, j).GetDeterminant();
    }
    return cofactors;
  }
  CSquareMatrix GetTransposed() const { return CMatrix<DIM, DIM>::GetTransposed(); }
  CSquareMatrix GetInverse() const {
    CSquareMatrix inverse = GetCofactorMatrix().GetTransposed();
    inverse *= 1.0 / GetDeterminant();
    return inverse;
  }

 private:
  static Real Sign(UInt32 place) { return place % 2 == 0 ? 1.0 : -1.0; }
  // What is left without a row and a column.
  CSquareMatrix<DIM - 1> Without(UInt32 row, UInt32 column) const {
    CSquareMatrix<DIM - 1> rest;
    for (UInt32 i = 0; i < DIM - 1; ++i) {
      for (UInt32 j = 0; j < DIM - 1; ++j) rest(i, j) = (*this)(i < row ? i : i + 1, j < column ? j : j + 1);
    }
    return rest;
  }
};

}  // namespace argos
