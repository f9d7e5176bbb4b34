// Runs of somebody's ARGoS project, to see what it does.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet {

// What stands in the arena when the experiment begins; m, in the file's coordinates.
struct ArenaBody {
  std::string id;
  std::string kind;  // as ARGoS calls it: "foot-bot", "box", "cylinder"
  bool robot = false;
  bool movable = false;
  double x = 0.0;
  double y = 0.0;
  double x_min = 0.0;  // of its bounding box
  double x_max = 0.0;
  double y_min = 0.0;
  double y_max = 0.0;
};

struct LoadedLibrary {
  std::string path;   // without links
  std::string named;  // absolute, as it was loaded
};

// Of one robot at one time.
struct Pose {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;  // rad
  double time = 0.0;     // s
  std::string robot = {};
};

struct TrialRun {
  std::string folder;
  double seconds = 0.0;  // that it took
  std::string out;       // of what ARGoS printed, what came after the experiment's beginning
  std::string err;
  std::string trajectory;   // the recorder's file
  std::vector<Pose> poses;  // of all robots at all recorded times
  std::vector<ArenaBody> bodies;
  std::vector<LoadedLibrary> libraries;
};

// Runs `command`, for /bin/sh, in the folder, where the recorder tells of the world in kWorldFile. `said`
// gets the last lines that it printed when it fails. Error: it did not come to its end within ten minutes.
inline constexpr const char* kTrajectoryFile = "gauntlet-trajectory.csv";
inline constexpr const char* kWorldFile = "gauntlet-world.txt";
Result<TrialRun> RunTrial(const std::string& folder, const std::string& command, std::ostream& said);

}  // namespace gauntlet
