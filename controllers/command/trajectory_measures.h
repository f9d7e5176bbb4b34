// What the scenario `generic` measures of a swarm from where its robots are, of a program's trajectory.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "controllers/command/definition.h"
#include "sim/observer.h"
#include "sim/run_spec.h"

namespace gauntlet::controllers::command {

// In `from` of a metric, before the measure's name.
inline constexpr std::string_view kTrajectorySource = "trajectory:";
// "center_x", "dispersion_mean", ...: those that need positions alone.
const std::vector<std::string>& TrajectoryMeasureNames();

// The robots' speeds are their mean ones over a second. `trajectory` as below.
sim::Observer ObserverOf(std::span<const std::vector<sim::RobotState>> trajectory);

// By name. `trajectory`: [tick][robot], not empty. The goal is the definition's last point; what is near and
// who is linked are as the defaults of `generic` say.
std::map<std::string, double> TrajectoryMeasures(const Definition& definition, const sim::RunSpec& spec,
                                                 std::span<const std::vector<sim::RobotState>> trajectory);

}  // namespace gauntlet::controllers::command
