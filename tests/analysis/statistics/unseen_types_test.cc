#include "analysis/statistics/unseen_types.h"

#include <gtest/gtest.h>

#include "tests/analysis/statistics/reference_data.h"

namespace gauntlet::analysis {
namespace {

TEST(UnseenTypesTest, AgreesWithItsFormulas) {
  for (const ReferenceRow& row : ReadReference("chao1.csv")) {
    const std::vector<double> listed = row.List("counts");
    const UnseenTypes types = EstimateUnseenTypes(std::vector<std::uint64_t>(listed.begin(), listed.end()));
    const std::string& name = row.Text("case");
    EXPECT_EQ(types.seen, row.Count("S_obs")) << name;
    EXPECT_EQ(types.failures, row.Count("n")) << name;
    EXPECT_EQ(types.seen_once, row.Count("f1")) << name;
    EXPECT_EQ(types.seen_twice, row.Count("f2")) << name;
    EXPECT_NEAR(types.chao1, row.Number("chao1_bias_corrected"), 1e-12) << name;
    EXPECT_NEAR(types.chao1_of_sample, row.Number("chao1_with_n_factor"), 1e-12) << name;
    EXPECT_NEAR(types.chance_of_new, row.Number("good_turing_p_new"), 1e-12) << name;
  }
}

TEST(UnseenTypesTest, WithoutFailuresTheNextOneIsNew) {
  const UnseenTypes types = EstimateUnseenTypes(std::vector<std::uint64_t>{0, 0});
  EXPECT_EQ(types.seen, 0U);
  EXPECT_EQ(types.chao1, 0.0);
  EXPECT_EQ(types.chance_of_new, 1.0);
}

TEST(RarefiedTypesTest, ExpectsWhatDrawingGives) {
  const std::vector<std::uint64_t> counts = {2, 0, 1, 1};
  EXPECT_DOUBLE_EQ(RarefiedTypes(counts, 1), 1.0);
  // Of the six pairs of failures one is of a single type.
  EXPECT_NEAR(RarefiedTypes(counts, 2), 11.0 / 6.0, 1e-15);
  EXPECT_DOUBLE_EQ(RarefiedTypes(counts, 4), 3.0);
  EXPECT_DOUBLE_EQ(RarefiedTypes(counts, 0), 0.0);
}

}  // namespace
}  // namespace gauntlet::analysis
