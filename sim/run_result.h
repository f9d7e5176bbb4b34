// What one run returns.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/canonical_encoder.h"
#include "sim/observer.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

// How the run ended as a computation. Stored: do not renumber.
enum class Verdict : int {
  kCompleted = 1,    // simulated to its end
  kRefused = 2,      // the spec is invalid; `message` names the rule
  kCrashed = 3,      // the runner died of it, reproducibly
  kHung = 4,         // it exceeded the limit of CPU time, reproducibly
  kOutOfMemory = 5,  // it exceeded the limit of memory, reproducibly
  kInvalidCommand =
      6,        // a controller gave a command that cannot be carried out, such as a wheel speed of NaN
  kKilled = 7,  // its process was ended from outside in every attempt, which may be the machine's doing
};

// How the swarm did, apart from its fitness.
struct SwarmFailure {
  bool total = false;  // total failure as the scenario defines it
  int type = -1;       // failure type, -1 = none or not classified
  std::string label;   // the type in words, "" when type = -1
};

// One robot's way in a few numbers.
struct RobotSummary {
  Pose start;
  Pose end;
  double path_length = 0.0;     // m
  bool lost = false;            // not with the swarm at the end, as the scenario defines it
  std::vector<Vec2> waypoints;  // position every kSummaryTicks ticks, from tick 0
};
inline constexpr Tick kSummaryTicks = 50;

// Something a picture of the run should show: a planned path, a goal, the place of a split.
struct Annotation {
  std::string kind;  // "path", "disc", "split", ...
  std::string label;
  std::vector<Vec2> points;        // a path's points; a disc's centre
  double radius = 0.0;             // m, of a disc
  Tick tick = -1;                  // when it happened, -1 = always
  std::vector<RobotIndex> robots;  // who was concerned
  bool operator==(const Annotation&) const = default;
};

struct RunResult {
  Verdict verdict = Verdict::kCompleted;
  std::string message;   // of a verdict other than completed
  double fitness = 0.0;  // lower = tougher test case; meaningless unless completed
  std::vector<std::pair<std::string, double>> metrics;  // in the scenario's order
  SwarmFailure failure;
  Tick ticks = 0;  // simulated
  std::vector<RobotSummary> robots;
  std::vector<Annotation> annotations;
  std::uint64_t trajectory_hash = 0;  // over the bits of every pose of every tick
  std::uint64_t hash = 0;             // HashOf(*this)

  // Not part of the hash:
  bool without_ways = false;  // the robots' waypoints and the annotations are not here; the hash covers them
  std::uint64_t hash_without_ways = 0;              // HashWithoutWays(*this); 0: nobody has computed it
  std::vector<std::vector<RobotState>> trajectory;  // [tick][robot], only when record_trajectory
  double cpu_seconds = 0.0;                         // user CPU of the simulation, filled by whoever measures
  int contacts = -1;  // that robots began, with one another, an obstacle or a wall; -1: nobody has counted
};

// Hash of the canonical encoding of all fields above the "not part of the hash" line but `hash` itself.
std::uint64_t HashOf(const RunResult& result);
// The same of all but the waypoints and annotations, and of `hash`, which tells them.
std::uint64_t HashWithoutWays(const RunResult& result);
// Sets both.
void SetHashes(RunResult& result);

}  // namespace gauntlet::sim
