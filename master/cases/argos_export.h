// Test cases as ARGoS3 experiment files.
#pragma once

#include <string>

#include "base/result.h"
#include "sim/arena/test_case.h"

namespace gauntlet::master {

// An .argos file with the case's arena, its walls and obstacles, and its foot-bots where the case says how
// many start where; ParseArgos reads the same case out of it, but for its name. The controllers are for the
// reader to add. Error: what such a file cannot say, obstacles that move or carry lights among it.
Result<std::string> WriteArgos(const sim::TestCase& test_case);

}  // namespace gauntlet::master
