// Reads the reference data beside the tests: where they come from stands in data/README.md.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace gauntlet::analysis {

// A row of a CSV file: cell by column.
class ReferenceRow {
 public:
  explicit ReferenceRow(std::map<std::string, std::string> cells) : cells_(std::move(cells)) {}
  // What is not there is a failure of the test (std::out_of_range).
  const std::string& Text(const std::string& column) const { return cells_.at(column); }
  double Number(const std::string& column) const;  // NaN for R's NA
  std::uint32_t Count(const std::string& column) const;
  std::vector<double> List(const std::string& column) const;  // separated by ;

 private:
  std::map<std::string, std::string> cells_;
};

std::vector<ReferenceRow> ReadReference(const std::string& file);

struct SamplePair {
  std::vector<double> x;
  std::vector<double> y;
};
std::map<std::string, SamplePair> ReadMannWhitneySamples();

// Tolerances of the data's README are relative.
void ExpectRelativelyNear(double actual, double expected, double tolerance, const std::string& what);

}  // namespace gauntlet::analysis
