// Whole swarms of the light flocking example against the same swarms in ARGoS. Definitions and margins stand
// in docs/validation.md; they were written down before the first comparison.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "sim/arena/test_case.h"
#include "sim/geometry/vec2.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::golden {

inline constexpr std::array<sim::Tick, 5> kDeviationTicks = {10, 50, 200, 600, 2000};
inline constexpr sim::Tick kLastTick = 2000;
inline constexpr double kAlpha = 0.05;
// m; largest mean over the cases of the deviation at 1 s and 5 s.
inline constexpr std::array<double, 2> kEarlyDeviation = {0.01, 0.03};

struct SwarmCase {
  std::string name;
  sim::TestCase test_case;
  std::map<sim::Tick, std::vector<sim::Pose>> argos;  // the measured poses of all robots
};

// One metric of the end state of one swarm.
struct Ending {
  double light_distance = 0.0;  // m
  double stopped = 0.0;         // share of robots
  double clusters = 0.0;
};

struct CaseComparison {
  std::string name;
  std::array<double, kDeviationTicks.size()> deviation{};  // m, median over robots at kDeviationTicks
  Ending argos;
  Ending ours;
};

struct EndMetric {
  std::string name;
  double Ending::*value;
  double margin;
};
const std::vector<EndMetric>& EndMetrics();

// Where the layouts are (files of the thesis' author, not part of the repository): $GAUNTLET_ARGOS_CASES,
// else beside the repository.
std::filesystem::path LayoutDirectory();
// The poses that the repository keeps.
std::filesystem::path RecordedDirectory();

// A case for every CSV file of `recorded` (tick,robot,x,y,heading), by name; the layout of envN.csv is
// envN.argos or environmentN.argos of `layouts`. Error: a layout or a tick is missing, with its name.
Result<std::vector<SwarmCase>> LoadSwarmCases(const std::filesystem::path& recorded,
                                              const std::filesystem::path& layouts);

// The light flocking example with its defaults.
controllers::ControllerFactory BuiltInFlockers();

// Simulates the case from ARGoS' start poses.
CaseComparison Compare(const SwarmCase& swarm_case,
                       const controllers::ControllerFactory& flockers = BuiltInFlockers());

struct Verdict {
  std::string table;  // Markdown
  bool holds = false;
};
Verdict Judge(const std::vector<CaseComparison>& comparisons);

}  // namespace gauntlet::golden
