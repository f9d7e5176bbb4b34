// An ARGoS3 experiment file of somebody's project as the template of a command's runs
// (controllers/command/placeholders.h).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "sim/arena/test_case.h"

namespace gauntlet {

// A number of the file that a run may have another value for.
struct ArgosParameter {
  std::string name;  // its place: "wheel_turning.max_speed", "loop_functions.foraging.items"
  double value = 0.0;
};

struct ArgosLight {
  sim::Vec2 position = sim::Vec2::Zero();  // m
  double height = 0.0;                     // m
  double intensity = 1.0;
  std::string color;  // as the file names it
};

// What is not as the file has it, or cannot be.
struct ArgosRemark {
  std::string element;
  std::string meaning;
};

struct ArgosTemplateOptions {
  double length = 0.0;                                      // s; 0: the file's
  double height = 0.5;                                      // m, of obstacles
  double every = 1.0;                                       // s between recorded poses; 0: every tick
  std::map<std::string, std::string> moved_libraries = {};  // other paths for libraries that the file names
};

struct ArgosTemplate {
  std::string text;
  double length = 0.0;  // s
  sim::Rectangle arena;
  std::vector<ArgosParameter> parameters;
  std::vector<std::string> libraries;              // as the file names them
  std::map<std::string, sim::ObstacleGene> boxes;  // that stand in the arena, by id
  std::vector<ArgosLight> lights;                  // that stand there
  std::vector<std::string> controllers;            // the names of the elements of <controllers>
  std::vector<std::string> paths;                  // other values that may be those of files
  std::vector<std::string> taken_over;             // in words
  std::vector<ArgosRemark> differs;
  std::vector<ArgosRemark> unsupported;
};

// The file's elements, with the recorder (argos/recorder) in place of its visualization, no threads, no
// clock, the run's seed, a block of obstacles behind what is in the arena, and each numeric attribute below
// <params>, <sensors>, <actuators> and <loop_functions> replaced by a parameter. `file_name` stands in
// messages.
//
// Error "FILE:LINE:COLUMN: ..." for malformed XML, another root than <argos-configuration>, a missing or
// second <arena>, <controllers> that are missing, an arena without a size, and no length. An arena has at
// most three dimensions; a centre that is not given is the origin.
Result<ArgosTemplate> MakeArgosTemplate(const std::string& text, const std::string& file_name,
                                        const ArgosTemplateOptions& options);

// A filled template as a run's file for ARGoS itself: with the visualization that the project's file has, and
// nothing recorded.
std::string WithoutRecorder(const std::string& filled);

// A filled template that also tells, in the file `world` of the run's folder, what stands in the arena.
std::string WithWorld(const std::string& filled, const std::string& world);

}  // namespace gauntlet
