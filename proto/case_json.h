// User-facing case files (proto/README.md).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "sim/run_spec.h"

namespace gauntlet::proto {

// How often a test case has failed.
struct CaseFailures {
  int failures = 0;
  int runs = 0;                                 // with a result
  std::array<double, 2> interval = {0.0, 1.0};  // of the probability to fail (Wilson, 95 %): from, to
};

// A change on the way from one case to another, and how often what it gave failed.
struct CaseStep {
  std::string change;          // in words, "without obstacle 3"
  std::vector<int> obstacles;  // which of the parent's are left, the first is 1
  CaseFailures found;          // in the runs that decided for the step
};

// Where a case comes from that was made out of another one.
struct CaseLineage {
  std::string made_by;          // the command, "minimise"
  std::string failing;          // what counted as failing (controllers::ScenarioInfo::failing)
  sim::TestCase parent;         // with its name
  std::vector<CaseStep> steps;  // from the parent to the case; the first is the parent as it is
  CaseFailures verified;        // of the case, in runs that took no part in choosing it
};

struct CaseDocument {
  sim::TestCase test_case;
  std::optional<CaseLineage> lineage = {};
};

// Keys may be written as in run.proto (orientation_deg) or in camel case (orientationDeg); numbers may be
// quoted; null leaves the default. Error (kInvalidInput): names the file, and the place of what is no JSON or
// the path of an unknown key (with the nearest known one) or of a value of the wrong kind.
Result<CaseDocument> ParseCaseDocument(const std::string& text, const std::string& file_name);
std::string WriteCaseDocument(const CaseDocument& document);

// The same of the test case alone: a lineage is read and dropped.
Result<sim::TestCase> ParseCaseJson(const std::string& text, const std::string& file_name);
std::string WriteCaseJson(const sim::TestCase& test_case);

}  // namespace gauntlet::proto
