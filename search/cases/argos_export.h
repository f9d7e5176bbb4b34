// Runs as ARGoS3 experiment files.
#pragma once

#include <string>
#include <vector>

#include "search/cases/argos_controllers.h"
#include "sim/run_spec.h"
#include "sim/run_start.h"

namespace gauntlet {

struct ArgosFile {
  std::string text;
  // What the run has and ARGoS has not, a sentence each; they stand in the file too.
  std::vector<std::string> notices;
};

// A file that ARGoS3 (3.0.0-beta59 and later) loads and runs as it is, and of which ParseArgos makes the
// spec's test case again. It has the arena, walls, obstacles, lamps, every robot at its start pose, the seed
// and the length. `title` begins its comment, in words. Without `controllers` the robots get one that does
// nothing, for which ARGoS must know Lua; devices are those of `start`.
ArgosFile WriteArgos(const sim::RunSpec& spec, const sim::RunStart& start,
                     const ArgosControllers* controllers, const std::string& title);

}  // namespace gauntlet
