// Test cases from files, whatever their format.
#pragma once

#include <filesystem>
#include <string>

#include "base/result.h"
#include "sim/arena/test_case.h"

namespace gauntlet::master {

struct LoadedCase {
  sim::TestCase test_case;
  std::string notice;  // one line: what was changed and ignored; "" when nothing
};

// Reads a case file: .json (proto/README.md) or .argos by its extension, any other by its content. A case
// without a name is named after the file. Error: no such file, larger than 16 MiB, or "FILE:LINE:COLUMN:
// ...".
Result<LoadedCase> LoadCase(const std::filesystem::path& path);

}  // namespace gauntlet::master
