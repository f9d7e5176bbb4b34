// Matrices of a fixed size.
#pragma once

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <iterator>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

template <UInt32 ROWS, UInt32 COLS>
class CMatrix {
 public:
  CMatrix() = default;  // zeros
  // Row by row.
  CMatrix(const Real* values) { Set(values); }

  Real& operator()(UInt32 row, UInt32 column) { return m_pfValues[Place(row, column)]; }
  Real operator()(UInt32 row, UInt32 column) const { return m_pfValues[Place(row, column)]; }
  Real& operator()(UInt32 place) { return m_pfValues[Checked(place)]; }
  Real operator()(UInt32 place) const { return m_pfValues[Checked(place)]; }

  void Set(const Real* values) { std::copy_n(values, ROWS * COLS, m_pfValues); }
  void SetZero() { std::fill(std::begin(m_pfValues), std::end(m_pfValues), 0.0); }

  CMatrix<COLS, ROWS> GetTransposed() const {
    CMatrix<COLS, ROWS> transposed;
    for (UInt32 i = 0; i < ROWS; ++i) {
      for (UInt32 j = 0; j < COLS; ++j) transposed(j, i) = (*this)(i, j);
    }
    return transposed;
  }
  // The part of the size of `part` that begins at this row and column.
  template <UInt32 PART_ROWS, UInt32 PART_COLS>
  void GetSubMatrix(CMatrix<PART_ROWS, PART_COLS>& part, UInt32 row, UInt32 column) const {
    for (UInt32 i = 0; i < PART_ROWS; ++i) {
      for (UInt32 j = 0; j < PART_COLS; ++j) part(i, j) = (*this)(row + i, column + j);
    }
  }

  bool operator==(const CMatrix& other) const {
    return std::equal(std::begin(m_pfValues), std::end(m_pfValues), other.m_pfValues);
  }
  CMatrix& operator+=(const CMatrix& other) {
    for (UInt32 i = 0; i < ROWS * COLS; ++i) m_pfValues[i] += other.m_pfValues[i];
    return *this;
  }
  CMatrix& operator-=(const CMatrix& other) {
    for (UInt32 i = 0; i < ROWS * COLS; ++i) m_pfValues[i] -= other.m_pfValues[i];
    return *this;
  }
  CMatrix& operator*=(Real factor) {
    for (Real& value : m_pfValues) value *= factor;
    return *this;
  }
  CMatrix& operator*=(const CMatrix<COLS, COLS>& other) { return *this = *this * other; }
  CMatrix operator+(const CMatrix& other) const { return CMatrix(*this) += other; }
  CMatrix operator-(const CMatrix& other) const { return CMatrix(*this) -= other; }
  CMatrix operator-() const { return CMatrix() -= *this; }
  // Sums from left to right, as ARGoS has them.
  template <UInt32 OTHER_COLS>
  CMatrix<ROWS, OTHER_COLS> operator*(const CMatrix<COLS, OTHER_COLS>& other) const {
    CMatrix<ROWS, OTHER_COLS> product;
    for (UInt32 i = 0; i < ROWS; ++i) {
      for (UInt32 j = 0; j < OTHER_COLS; ++j) {
        for (UInt32 k = 0; k < COLS; ++k) product(i, j) += (*this)(i, k) * other(k, j);
      }
    }
    return product;
  }

  // A line for each row: "|   1.00   0.00 |".
  friend std::ostream& operator<<(std::ostream& stream, const CMatrix& matrix) {
    const std::ios_base::fmtflags flags = stream.flags();
    const std::streamsize precision = stream.precision();
    stream << std::fixed << std::setprecision(2);
    for (UInt32 i = 0; i < ROWS; ++i) {
      stream << "| ";
      for (UInt32 j = 0; j < COLS; ++j) stream << std::setw(6) << matrix(i, j) << " ";
      stream << "|" << std::endl;
    }
    stream.flags(flags);
    stream.precision(precision);
    return stream;
  }

 protected:
  Real m_pfValues[ROWS * COLS] = {};

 private:
  static UInt32 Checked(UInt32 place) {
    ARGOS_ASSERT(place < ROWS * COLS, "A matrix has no value " << place);
    return place;
  }
  static UInt32 Place(UInt32 row, UInt32 column) {
    ARGOS_ASSERT(row < ROWS && column < COLS, "A matrix has no value at " << row << ", " << column);
    return row * COLS + column;
  }
};

}  // namespace argos
