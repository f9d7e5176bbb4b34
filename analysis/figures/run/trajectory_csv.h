// A run's trajectory as a table for other programs.
#pragma once

#include <string>
#include <vector>

#include "sim/observer.h"

namespace gauntlet::analysis {

// Header "tick,time_s,robot,x,y,heading,speed" (m, rad, m/s), then one line per tick and robot, in that
// order. Numbers are the shortest that read back as the same double. `trajectory` is [tick][robot].
std::string WriteTrajectoryCsv(const std::vector<std::vector<sim::RobotState>>& trajectory);

}  // namespace gauntlet::analysis
