#include "tests/analysis/statistics/reference_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "tests/support/paths.h"

namespace gauntlet::analysis {
namespace {

std::vector<std::string> SplitCsvLine(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

}  // namespace

double ReferenceRow::Number(const std::string& column) const {
  const std::string& text = Text(column);
  return text == "NA" ? std::numeric_limits<double>::quiet_NaN() : std::stod(text);
}

std::uint32_t ReferenceRow::Count(const std::string& column) const {
  return static_cast<std::uint32_t>(std::stoul(Text(column)));
}

std::vector<double> ReferenceRow::List(const std::string& column) const {
  std::vector<double> values;
  std::istringstream in(Text(column));
  for (std::string value; std::getline(in, value, ';');) values.push_back(std::stod(value));
  return values;
}

std::vector<ReferenceRow> ReadReference(const std::string& file) {
  std::ifstream in(std::string(GAUNTLET_SOURCE_DIR) + "/tests/analysis/statistics/data/" + file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = SplitCsvLine(line);
  std::vector<ReferenceRow> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = SplitCsvLine(line);
    std::map<std::string, std::string> cells;
    for (std::size_t i = 0; i < header.size(); ++i) cells[header[i]] = fields.at(i);
    rows.emplace_back(cells);
  }
  EXPECT_FALSE(rows.empty()) << file;
  return rows;
}

std::map<std::string, SamplePair> ReadMannWhitneySamples() {
  std::map<std::string, SamplePair> samples;
  for (const ReferenceRow& row : ReadReference("mannwhitney_samples.csv")) {
    SamplePair& pair = samples[row.Text("case")];
    (row.Text("sample") == "x" ? pair.x : pair.y).push_back(row.Number("value"));
  }
  return samples;
}

void ExpectRelativelyNear(double actual, double expected, double tolerance, const std::string& what) {
  EXPECT_NEAR(actual, expected, tolerance * std::abs(expected)) << what;
}

}  // namespace gauntlet::analysis
