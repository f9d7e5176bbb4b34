// The campaign that tests of pages show.
#pragma once

#include <string>

#include "tests/support/process.h"

namespace gauntlet::testing_support {

// For the files of all tests of one process.
const TemporaryDirectory& Scratch();
// Sixty random runs of flocking, more than pages show at once; some of the cases fail. Made when first asked
// for.
const std::string& Campaign();

}  // namespace gauntlet::testing_support
