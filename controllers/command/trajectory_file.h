// The trajectory that a program leaves: a CSV file with a row for each robot and time.
#pragma once

#include <string>

#include "base/result.h"
#include "sim/run_result.h"

namespace gauntlet::controllers::command {

// Columns: time (s), robot (any text), kind (any text), x, y (m), heading (rad); with a first row of names in
// any order, of which kind and heading may be missing. Times do not fall. Fills the robots' summaries, ticks
// and trajectory_hash, and `trajectory` when `record`: with a robot's place before it came where it first
// was, and after it went where it last was. Error: the row and what is wrong with it; `name` is the file's
// in messages.
Status ReadTrajectory(const std::string& path, const std::string& name, bool record, sim::RunResult& result);

}  // namespace gauntlet::controllers::command
