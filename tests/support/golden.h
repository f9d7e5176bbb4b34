// Whole outputs, kept as files in the repository: what was printed is held against them.
#pragma once

#include <string>

namespace gauntlet::testing_support {

// `text` is what the file holds (a path below the repository's root); else the test fails, with the
// difference by lines. With GAUNTLET_WRITE_GOLDENS=1 in the environment the file is written instead.
void ExpectGolden(const std::string& file, const std::string& text);

}  // namespace gauntlet::testing_support
