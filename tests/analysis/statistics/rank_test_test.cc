#include "analysis/statistics/rank_test.h"
#include "tests/support/paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace gauntlet::analysis {
namespace {

std::vector<std::string> SplitCsvLine(const std::string& line) {
  std::vector<std::string> fields;
  std::string field;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.push_back(field);
      field.clear();
    } else {
      field += c;
    }
  }
  fields.push_back(field);
  return fields;
}

std::vector<std::map<std::string, std::string>> ReadCsv(const std::string& name) {
  std::ifstream in(std::string(GAUNTLET_SOURCE_DIR) + "/tests/golden/statistics/" + name);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = SplitCsvLine(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = SplitCsvLine(line);
    std::map<std::string, std::string>& row = rows.emplace_back();
    for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = fields[i];
  }
  return rows;
}

void ExpectRelativelyNear(double actual, const std::string& expected, double tolerance,
                          const std::string& what) {
  const double value = std::stod(expected);
  EXPECT_NEAR(actual, value, tolerance * std::abs(value)) << what;
}

TEST(RankTestTest, AgreesWithRAndIsExactInRanks) {
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> samples;
  for (auto& row : ReadCsv("mannwhitney_samples.csv")) {
    auto& [x, y] = samples[row["case"]];
    (row["sample"] == "x" ? x : y).push_back(std::stod(row["value"]));
  }
  int compared = 0;
  for (auto& row : ReadCsv("mannwhitney_results.csv")) {
    const auto& [x, y] = samples.at(row["case"]);
    const RankTest test = MannWhitney(x, y);
    EXPECT_EQ(test.rank_sum1, std::stod(row["R1"])) << row["case"];
    EXPECT_EQ(test.rank_sum2, std::stod(row["R2"])) << row["case"];
    EXPECT_EQ(test.u1, std::stod(row["W_R_U1"])) << row["case"];
    EXPECT_EQ(test.u2, std::stod(row["U2"])) << row["case"];
    EXPECT_NEAR(test.a, std::stod(row["A_xy"]), 1e-12) << row["case"];
    if (std::isnan(std::stod(row["p_asym_cc_two"]))) {  // R's answer when all values are equal
      EXPECT_EQ(test.p_greater, 1.0) << row["case"];
      EXPECT_EQ(test.p_two_sided, 1.0) << row["case"];
      continue;
    }
    ExpectRelativelyNear(test.p_greater, row["p_asym_cc_greater"], 1e-10, row["case"]);
    ExpectRelativelyNear(test.p_less, row["p_asym_cc_less"], 1e-10, row["case"]);
    ExpectRelativelyNear(test.p_two_sided, row["p_asym_cc_two"], 1e-10, row["case"]);
    ++compared;
  }
  EXPECT_GE(compared, 9);
}

TEST(RankTestTest, TiedValuesShareTheMeanOfTheirRanks) {
  EXPECT_THAT(MidRanks(std::vector<double>{3, 1, 3, 2, 3}), testing::ElementsAre(4, 1, 4, 2, 4));
}

RC_GTEST_PROP(RankTestProperty, AIsTheShareOfPairsWithTiesCountingHalf, ()) {
  const auto value = rc::gen::map(rc::gen::inRange(0, 9), [](int i) { return static_cast<double>(i); });
  const auto x = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(value));
  const auto y = *rc::gen::nonEmpty(rc::gen::container<std::vector<double>>(value));
  double pairs = 0.0;
  for (const double a : x) {
    for (const double b : y) pairs += a > b ? 1.0 : (a == b ? 0.5 : 0.0);
  }
  const RankTest test = MannWhitney(x, y);
  RC_ASSERT(test.u1 == pairs);
  RC_ASSERT(std::abs(test.a + MannWhitney(y, x).a - 1.0) < 1e-12);
}

}  // namespace
}  // namespace gauntlet::analysis
