// How texts speak of a scenario's swarm and how pictures draw its annotations. A scenario declares it, so
// that what writes and draws need not know the scenarios.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gauntlet::sim {

// What a picture shows of an annotation.
enum class Mark : std::uint8_t {
  kArea,   // the outline of an area, by its corners
  kPlan,   // a dashed line: the way that the guide is to take
  kChain,  // a dashed line from robot to robot
  kGoal,   // a place, by its centre and radius; so are the next two
  kNest,
  kFood,
  kSplit,         // where robots left the swarm, who and when; of several the latest
  kTransfer,      // where an item changed hands
  kBeacon,        // a robot that ends as a beacon
  kFormerBeacon,  // where one stood before, of annotations "states"
};

struct AnnotationStyle {
  std::string kind;   // of the annotation
  std::string label;  // only of annotations with this label, or the name of a state; "" = of all
  Mark mark = Mark::kGoal;
  std::string legend;  // its words in the legend; "" = the annotation's label
  bool operator==(const AnnotationStyle&) const = default;
};

// Annotations "trapped" (a robot, from its tick on), "states" (its time-line) and "violated" (a requirement,
// by which comparison, and when) mean the same everywhere.
struct RunStyle {
  std::string member = "robot";  // one of those under test, singular
  std::string lost = "lost";     // what RobotSummary::lost says of it
  bool lost_is_failure = true;   // total failure means that too many were lost, not something of its own
  std::string guide = "guide";   // the robot that a planned path is for, which is not under test
  std::vector<AnnotationStyle> annotations = {};
  bool operator==(const RunStyle&) const = default;
};

}  // namespace gauntlet::sim
