// An ARGoS project as an experiment of Gauntlet: a table [command] with what was seen of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/adopt/argos_installation.h"
#include "cli/adopt/trial_run.h"
#include "search/cases/argos_template.h"

namespace gauntlet {

struct AdoptedProject {
  std::string name;  // of the experiment
  std::string argos_file;
  std::string own;                       // the folder of what is ours, beside the experiment
  std::vector<std::string> environment;  // "NAME=value": how this shell finds ARGoS and its libraries
  ArgosTemplate form;
  double seconds = 0.0;          // that a run took
  std::string score;             // where it stands
  std::vector<double> scores;    // of runs without obstacles
  std::vector<Pose> poses;       // that the robots had in these runs
  std::vector<ArenaBody> fixed;  // robots that begin at the same place whatever the seed, and movable things
  std::vector<ArenaBody> robots;
  std::vector<ArenaBody> standing;
};

// The rectangle in which obstacles are laid: the arena, where the robots went.
sim::Rectangle ObstacleArea(const AdoptedProject& project);

// The width of an obstacle that matters there, m; lengths are multiples of it.
double ObstacleStep(const sim::Rectangle& area);

// Half the larger side of the largest robot's bounding box, m.
double RobotRadius(const AdoptedProject& project);

// An obstacle that would stand most in the way of robots that went so, without touching anything at its
// beginning; nothing when there is no place for one.
std::optional<sim::ObstacleGene> ObstacleInTheWay(const AdoptedProject& project, const TrialRun& run);

// The experiment, as TOML.
std::string AdoptedExperimentText(const AdoptedProject& project);

}  // namespace gauntlet
