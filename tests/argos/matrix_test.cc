// Matrices.
#include <argos3/core/utility/math/matrix/transformationmatrix2.h>
#include <argos3/core/utility/math/matrix/transformationmatrix3.h>
#include <argos3/core/utility/math/quaternion.h>

#include <gtest/gtest.h>

#include <sstream>

namespace argos {
namespace {

constexpr Real kSix[] = {1, 2, 3, 4, 5, 6};

TEST(Matrix, HasItsValuesRowByRow) {
  CMatrix<2, 3> matrix(kSix);
  EXPECT_EQ(matrix(0, 2), 3.0);
  EXPECT_EQ(matrix(1, 0), 4.0);
  EXPECT_EQ(matrix(5), 6.0);
  matrix(1, 1) = 7.0;
  EXPECT_EQ(matrix.GetTransposed()(1, 1), 7.0);
  EXPECT_EQ(matrix.GetTransposed()(2, 0), 3.0);
  CMatrix<1, 2> part;
  matrix.GetSubMatrix(part, 1, 1);
  EXPECT_EQ(part(0), 7.0);
  EXPECT_EQ(part(1), 6.0);
  EXPECT_EQ((CMatrix<2, 2>()(3)), 0.0);
}

TEST(Matrix, AddsMultipliesAndPrints) {
  const CMatrix<2, 3> matrix(kSix);
  const CMatrix<2, 2> square = matrix * matrix.GetTransposed();
  constexpr Real kExpected[] = {14, 32, 32, 77};
  EXPECT_EQ(square, (CMatrix<2, 2>(kExpected)));
  EXPECT_EQ((square - square + -square)(3), -77.0);
  std::ostringstream text;
  text << square;
  EXPECT_EQ(text.str(), "|  14.00  32.00 |\n|  32.00  77.00 |\n");
}

TEST(SquareMatrix, IsUndoneByItsInverse) {
  constexpr Real kValues[] = {2, 0, 1, 1, 3, 2, 1, 1, 4};
  const CSquareMatrix<3> matrix = CMatrix<3, 3>(kValues);
  EXPECT_NEAR(matrix.GetDeterminant(), 18.0, 1e-12);
  const CMatrix<3, 3> product = matrix * matrix.GetInverse();
  for (UInt32 i = 0; i < 3; ++i) {
    for (UInt32 j = 0; j < 3; ++j) EXPECT_NEAR(product(i, j), i == j ? 1.0 : 0.0, 1e-15);
  }
  EXPECT_FALSE(matrix.IsIdentityMatrix());
  EXPECT_TRUE(CRotationMatrix2().IsIdentityMatrix());
}

TEST(TransformationMatrix2, TurnsAndMoves) {
  const CTransformationMatrix2 matrix(CRotationMatrix2(CRadians::PI_OVER_TWO), CVector2(1.0, 2.0));
  const CVector2 turned = matrix.GetRotationMatrix() * CVector2(3.0, 0.0);
  EXPECT_NEAR(turned.GetX(), 0.0, 1e-15);
  EXPECT_NEAR(turned.GetY(), 3.0, 1e-15);
  EXPECT_EQ(matrix.GetTranslationVector(), CVector2(1.0, 2.0));
}

// The quaternion of the same angles turns a vector to the same place.
TEST(RotationMatrix3, IsTheRotationOfItsQuaternion) {
  for (const Real yaw : {-3.0, -1.0, 0.5, 3.1}) {
    const CRotationMatrix3 matrix(CRadians(yaw), CRadians(0.4), CRadians(2.8));
    const CQuaternion quaternion = matrix;
    const CVector3 turned = matrix * CVector3(1.0, 2.0, 3.0);
    const CVector3 expected = CVector3(1.0, 2.0, 3.0).Rotate(quaternion);
    EXPECT_NEAR((turned - expected).Length(), 0.0, 1e-12) << yaw;
    const CTransformationMatrix3 moved(matrix, CVector3(0.0, 0.0, 1.0));
    EXPECT_NEAR((moved * CVector3(1.0, 2.0, 3.0) - turned - CVector3::Z).Length(), 0.0, 1e-12) << yaw;
  }
}

}  // namespace
}  // namespace argos
