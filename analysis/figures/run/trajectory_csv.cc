#include "analysis/figures/run/trajectory_csv.h"

#include <iterator>

#include <fmt/format.h>

namespace gauntlet::analysis {

std::string WriteTrajectoryCsv(const std::vector<std::vector<sim::RobotState>>& trajectory) {
  std::string out = "tick,time_s,robot,x,y,heading,speed\n";
  for (std::size_t tick = 0; tick < trajectory.size(); ++tick) {
    for (std::size_t robot = 0; robot < trajectory[tick].size(); ++robot) {
      const sim::RobotState& s = trajectory[tick][robot];
      // tick / 10 exactly as a decimal number: 0.1 * 3 would read 0.30000000000000004.
      fmt::format_to(std::back_inserter(out), "{},{}.{},{},{},{},{},{}\n", tick, tick / sim::kTicksPerSecond,
                     tick % sim::kTicksPerSecond, robot, s.x, s.y, s.heading, s.speed);
    }
  }
  return out;
}

}  // namespace gauntlet::analysis
