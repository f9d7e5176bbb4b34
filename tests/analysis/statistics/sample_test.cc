#include "analysis/statistics/sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/analysis/statistics/reference_data.h"

namespace gauntlet::analysis {
namespace {

TEST(CheckSampleTest, NamesTheSetAndWhatIsWrongWithIt) {
  EXPECT_TRUE(CheckSample(std::vector<double>{0.0}, "set A").ok());
  EXPECT_EQ(CheckSample(std::vector<double>{}, "set A").error().message,
            "set A is empty: at least one value is needed");
  EXPECT_EQ(CheckSample(std::vector<double>{1.0, std::numeric_limits<double>::quiet_NaN()}, "set B")
                .error()
                .message,
            "set B: value 2 is not a number, only finite numbers can be compared");
  EXPECT_EQ(
      CheckSample(std::vector<double>{-std::numeric_limits<double>::infinity()}, "set B").error().message,
      "set B: value 1 is infinite, only finite numbers can be compared");
}

TEST(DescribeTest, OneValueHasNoSpreadAndEqualOnesNone) {
  const Description one = Describe(std::vector<double>{3.0});
  EXPECT_EQ(one.mean, 3.0);
  EXPECT_EQ(one.median, 3.0);
  EXPECT_FALSE(one.sd.has_value());
  const Description equal = Describe(std::vector<double>(7, 0.1));
  EXPECT_EQ(equal.mean, 0.1);
  EXPECT_EQ(equal.sd, 0.0);
}

TEST(DescribeTest, AMeansIntervalIsThatOfStudentsT) {
  // t.test(1:5)$conf.int in R.
  const Interval interval = MeanInterval(std::vector<double>{1, 2, 3, 4, 5}, 0.95);
  EXPECT_NEAR(interval.low, 1.036757, 1e-6);
  EXPECT_NEAR(interval.high, 4.963243, 1e-6);
}

TEST(DescribeTest, KeepsDigitsOfValuesFarFromZero) {
  const Description description = Describe(std::vector<double>{1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16});
  EXPECT_EQ(description.mean, 1e9 + 10);
  EXPECT_DOUBLE_EQ(*description.sd, std::sqrt(30.0));
}

TEST(QuantileTest, AgreesWithREveryTypeByItsName) {
  for (const ReferenceRow& row : ReadReference("boxplot.csv")) {
    const std::vector<double> values = row.List("values");
    const auto expect = [&](const char* column, double probability, QuantileType type) {
      EXPECT_NEAR(Quantile(values, probability, type), row.Number(column), 1e-12)
          << row.Text("case") << column;
    };
    expect("median", 0.5, QuantileType::k7);
    expect("q1_type7", 0.25, QuantileType::k7);
    expect("q3_type7", 0.75, QuantileType::k7);
    expect("q1_type5_matlab", 0.25, QuantileType::k5);
    expect("q3_type5_matlab", 0.75, QuantileType::k5);
    expect("q1_type6", 0.25, QuantileType::k6);
    expect("q3_type6", 0.75, QuantileType::k6);
    expect("q1_type8", 0.25, QuantileType::k8);
    expect("q3_type8", 0.75, QuantileType::k8);
  }
}

TEST(QuantileTest, FoodPerTwoMinutesAgreesWithR) {
  const auto samples = ReadReference("food_per_bin_samples.csv");
  for (const ReferenceRow& row : ReadReference("food_per_bin_percentiles.csv")) {
    std::vector<double> bin;
    for (const ReferenceRow& run : samples) bin.push_back(run.Number("X" + row.Text("bin")));
    for (const int percent : {0, 5, 25, 50, 75, 95, 100}) {
      EXPECT_NEAR(Quantile(bin, percent / 100.0), row.Number("X" + std::to_string(percent) + "."), 1e-12);
    }
    EXPECT_NEAR(Describe(bin).mean, row.Number("mean"), 1e-12);
  }
}

TEST(BoxPlotTest, AgreesWithRAndNamesItsRule) {
  for (const ReferenceRow& row : ReadReference("boxplot.csv")) {
    const std::string& name = row.Text("case");
    const BoxPlot box = MakeBoxPlot(row.List("values"));
    EXPECT_EQ(box.rule, BoxRule::kTukeyHinges);
    EXPECT_NEAR(box.lower_whisker, row.Number("R_whisker_lo"), 1e-12) << name;
    EXPECT_NEAR(box.lower_quartile, row.Number("R_hinge_lo"), 1e-12) << name;
    EXPECT_NEAR(box.median, row.Number("median"), 1e-12) << name;
    EXPECT_NEAR(box.upper_quartile, row.Number("R_hinge_hi"), 1e-12) << name;
    EXPECT_NEAR(box.upper_whisker, row.Number("R_whisker_hi"), 1e-12) << name;
    EXPECT_NEAR(box.lower_notch, row.Number("R_notch_lo"), 1e-12) << name;
    EXPECT_NEAR(box.upper_notch, row.Number("R_notch_hi"), 1e-12) << name;
    EXPECT_EQ(box.outliers, row.List("R_outliers")) << name;
    const BoxPlot other = MakeBoxPlot(row.List("values"), BoxRule::kQuartiles7);
    EXPECT_NEAR(other.lower_quartile, row.Number("q1_type7"), 1e-12) << name;
    EXPECT_NEAR(other.upper_quartile, row.Number("q3_type7"), 1e-12) << name;
    EXPECT_NEAR(other.lower_whisker, row.Number("whisker_lo_type7"), 1e-12) << name;
    EXPECT_NEAR(other.upper_whisker, row.Number("whisker_hi_type7"), 1e-12) << name;
  }
  EXPECT_EQ(std::string(NameOf(BoxRule::kTukeyHinges)),
            "Tukey's hinges; whiskers to the last value within 1.5 box lengths");
}

RC_GTEST_PROP(QuantileProperty, LiesInsideTheValuesAndRisesWithTheProbability, (std::vector<int> whole)) {
  RC_PRE(!whole.empty());
  const std::vector<double> values(whole.begin(), whole.end());
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  for (const QuantileType type : {QuantileType::k5, QuantileType::k6, QuantileType::k7, QuantileType::k8}) {
    double before = *smallest;
    for (const double probability : {0.0, 0.1, 0.25, 0.5, 0.77, 0.9, 1.0}) {
      const double quantile = Quantile(values, probability, type);
      RC_ASSERT(quantile >= before && quantile <= *largest);
      before = quantile;
    }
    RC_ASSERT(Quantile(values, 1.0, type) == *largest);
  }
}

}  // namespace
}  // namespace gauntlet::analysis
