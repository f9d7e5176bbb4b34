#include "analysis/statistics/multiple_tests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/statistics/reference_data.h"

namespace gauntlet::analysis {
namespace {

TEST(HolmTest, AgreesWithRInWhateverOrder) {
  std::vector<double> p;
  std::vector<double> expected;
  for (const ReferenceRow& row : ReadReference("p_adjust.csv")) {
    p.push_back(row.Number("p"));
    expected.push_back(row.Number("holm"));
  }
  EXPECT_THAT(HolmAdjusted(p), testing::Pointwise(testing::DoubleEq(), expected));
  std::rotate(p.begin(), p.begin() + 2, p.end());
  std::rotate(expected.begin(), expected.begin() + 2, expected.end());
  EXPECT_THAT(HolmAdjusted(p), testing::Pointwise(testing::DoubleEq(), expected));
}

TEST(HolmTest, OneTestNeedsNoCorrectionAndNoneGivesNone) {
  EXPECT_THAT(HolmAdjusted(std::vector<double>{0.03}), testing::ElementsAre(0.03));
  EXPECT_THAT(HolmAdjusted(std::vector<double>{}), testing::IsEmpty());
}

}  // namespace
}  // namespace gauntlet::analysis
