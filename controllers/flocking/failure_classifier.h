// Why a flock fell apart: finds every split of a finished run and classifies the last one by the relative
// angle and the relative speed of the two clusters (thesis 4.4).
#pragma once

#include <string>
#include <vector>

#include "controllers/flocking/swarm_links.h"
#include "sim/arena/arena.h"
#include "sim/observer.h"

namespace gauntlet::controllers {

struct SplitRule {
  LinkRule link;
  sim::Tick rejoin = 0;       // ticks; whoever is back within them was never lost
  sim::Tick half_window = 0;  // ticks before and after the split over which velocities are taken
};

// A set of birds that left the main cluster together.
struct SplitEvent {
  sim::Tick detected = 0;                  // first tick without a link to the main cluster
  sim::Tick tick = 0;                      // the last tick with an edge between them and the others
  std::vector<sim::RobotIndex> birds;      // who left, ascending
  std::vector<sim::RobotIndex> remaining;  // birds of the main cluster at `detected`, else the prey
};

struct SplitHistory {
  std::vector<SplitEvent> events;  // in order of detection
  RobotFlags main_cluster;         // the prey's component at the last tick
};

// The main cluster of a tick is the prey's component of the link graph; all robots but the prey are birds.
// Birds outside it once the links have had time to form (tick link.memory) count as split at tick 0. A set
// has rejoined when each of its birds was back in the main cluster within rule.rejoin ticks; then it is no
// event.
SplitHistory FindSplits(const sim::Observer& observer, const sim::Arena& arena, sim::RobotIndex prey,
                        const SplitRule& rule);

// The split that counts: the latest, of these the one with most birds, of these the one with the lowest bird,
// nullptr when there is none.
const SplitEvent* LastSplit(const std::vector<SplitEvent>& events);

// The velocities of two clusters compared.
struct RelativeMotion {
  double angle = 0.0;        // rad in [0, pi] between the mean headings
  double speed_ratio = 1.0;  // slower / faster mean speed; 1 when both are below 1 mm/s
};
RelativeMotion CompareMotion(const sim::Observer& observer, const SplitEvent& split, sim::Tick half_window);

inline constexpr int kFailureTypes = 20;
// 0..9: the angle in steps of 10 degrees (the last: above 90), slower cluster at least half as fast as the
// faster one; 10..19: the same angles, slower than half.
int FailureTypeOf(const RelativeMotion& motion);
// In words: "10-20 degrees apart, one cluster slower than half the other".
std::string FailureLabel(int type);
// Its parts: "10-20", and "one cluster slower than half the other".
std::string FailureDegrees(int type);
std::string FailureSpeeds(int type);

}  // namespace gauntlet::controllers
