// Test cases from files, whatever their format.
#pragma once

#include <filesystem>

#include "base/result.h"
#include "master/cases/argos_import.h"

namespace gauntlet::master {

// Reads a case file: .json (proto/README.md) or .argos by its extension, any other by its content. A case
// without a name is named after the file. Error: no such file, larger than 16 MiB, or "FILE:LINE:COLUMN:
// ...".
Result<LoadedCase> LoadCase(const std::filesystem::path& path);

}  // namespace gauntlet::master
