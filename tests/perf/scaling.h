// What a robot-tick costs in small and large swarms.
#pragma once

#include <string>

namespace gauntlet::perf {

// Robots walking at random, 6 to 500 in proportionally larger arenas, with both physics engines in turns:
// prints user CPU per robot-tick. Draws it into `svg_file`, unless that is empty.
void ReportScaling(const std::string& svg_file);

}  // namespace gauntlet::perf
