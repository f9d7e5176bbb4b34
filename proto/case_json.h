// User-facing case files (proto/README.md).
#pragma once

#include <string>

#include "base/result.h"
#include "sim/run_spec.h"

namespace gauntlet::proto {

// Keys may be written as in run.proto (orientation_deg) or in camel case (orientationDeg); numbers may be
// quoted; null leaves the default. Error (kInvalidInput): names the file, and the place of what is no JSON or
// the path of an unknown key (with the nearest known one) or of a value of the wrong kind.
Result<sim::TestCase> ParseCaseJson(const std::string& text, const std::string& file_name);
std::string WriteCaseJson(const sim::TestCase& test_case);

}  // namespace gauntlet::proto
