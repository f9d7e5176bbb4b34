// A simulator that is a program of the user's: what an experiment's table [command] says of it. It is kept as
// canonical JSON, whose SHA-256 names it as that of a library names a plug-in.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/key.h"
#include "base/result.h"
#include "controllers/failure_descriptor.h"
#include "controllers/parameters.h"
#include "sim/geometry/vec2.h"

namespace gauntlet::controllers::command {

// The scenario of all commands, and the one controller that they have: the parameters of the program.
inline constexpr const char* kScenario = "command";
inline constexpr const char* kController = "program";
// The scenario's one parameter.
inline constexpr const char* kWallLimit = "wall_limit";
// Before the SHA-256 of a definition: what its probe prints stands for it among golden hashes.
inline constexpr const char* kGoldenPrefix = "command:";
// In pictures, the label of Definition::standing.
inline constexpr const char* kStanding = "standing";
inline constexpr std::size_t kMostFileBytes = std::size_t{256} << 20;

// What lies in the folder of every run.
struct File {
  std::string name;  // relative, of plain parts
  std::string hash;  // SHA-256
  bool executable = false;
};

// One number of a run. Without `from` and `formula`: what the JSON object has under this name.
struct Metric {
  std::string name;
  std::string from;     // "log:PATTERN" or "csv:FILE:COLUMN"
  std::string formula;  // of metrics that stand before it
  std::string unit;
};

// Places are in the program's coordinates, m.
struct Point {
  std::string name;
  double x = 0.0;
  double y = 0.0;
};
// With a radius a disc, else a rectangle.
struct Shape {
  double x = 0.0;
  double y = 0.0;
  double radius = 0.0;
  double length = 0.0;   // along x before it is turned
  double width = 0.0;    // along y
  double degrees = 0.0;  // counter-clockwise
};

struct Definition {
  std::vector<std::string> run;    // arguments, with placeholders (placeholders.h)
  std::vector<std::string> names;  // of `files`, as the table has them: files and folders
  std::vector<File> files;
  std::string case_template;  // one of the files; "": the case is written as JSON
  std::vector<Metric> metrics;
  std::string fitness;  // formulas of metrics
  std::string failure;
  double cpu_limit = 0.0;     // s of all its processes; 0: wall_limit times cores
  double wall_limit = 600.0;  // s
  int memory = 2048;          // MB of all its processes
  int disk = 1024;            // MB in its folder
  int cores = 1;              // that it uses
  int at_once = 0;            // on one host; 0: no limit
  std::string setup;          // commands for bash
  std::vector<std::string> probe;
  std::string trajectory;  // a CSV file in the run's folder
  bool confine = true;
  std::vector<ParameterInfo> parameters;
  std::vector<std::string> refused;  // patterns
  double robot_radius = 0.1;         // m
  std::vector<Point> points;         // a robot's path leads from the first to each of the others
  std::vector<Shape> keep_outs;      // no obstacle touches them
  std::vector<Shape> standing;       // what blocks a robot in the arena itself
  std::vector<DescriptorAxis> axes;
  std::optional<FailurePlace> place;

  // Those that the program itself reports, in order.
  std::vector<std::string> Reported() const;
};

// What is wrong with a definition, and with which key of it ("metric.2.from").
struct Complaint {
  std::string path;
  std::string what;
};

// Reads the table, or the canonical JSON, which has `file` besides. Complaints are about single values and
// about what contradicts something else.
struct ReadDefinition {
  Definition definition;
  std::optional<Complaint> complaint;
};
ReadDefinition Read(const nlohmann::json& table);
// Error: it is no canonical JSON of a right definition.
Result<Definition> Parse(std::string_view canonical);

// Every value written out, in one order.
std::string CanonicalText(const Definition& definition);

// What can be said, for who lists it: "wall_limit", and of an element of a list "metric.1.name".
std::vector<KeyInfo> Keys();

}  // namespace gauntlet::controllers::command
