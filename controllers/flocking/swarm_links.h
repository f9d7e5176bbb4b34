// Who follows whom: the graph of robots that see each other, with a short memory. Both
// the metrics at the end of a run and the search for splits stand on it.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/observer.h"

namespace gauntlet::controllers {

struct LinkRule {
  double range = 0.0;    // m between centres, at most
  sim::Tick memory = 1;  // ticks that an edge counts on, so that flicker behind a box's corner cuts no link
};

// One flag per robot.
using RobotFlags = std::vector<std::uint8_t>;

// Reads a finished (or growing) trajectory. Looks at as few lines of sight as the questions need. Not for
// sharing between threads.
class SwarmLinks {
 public:
  // `observer` and `arena` outlive the object.
  SwarmLinks(const sim::Observer& observer, const sim::Arena& arena, const LinkRule& rule);

  // Within range and in sight of each other at `tick`.
  bool Edge(sim::RobotIndex a, sim::RobotIndex b, sim::Tick tick) const;
  // An edge in any of the last rule.memory ticks up to `tick`. Ticks must not decrease from call to call.
  bool Linked(sim::RobotIndex a, sim::RobotIndex b, sim::Tick tick);
  // The robots connected with `start` by links at `tick` through robots of `among`; `start` is one of them.
  RobotFlags Component(sim::RobotIndex start, sim::Tick tick, const RobotFlags& among);

 private:
  struct PairMemory {
    sim::Tick last_edge = kNever;  // the newest edge up to `scanned`
    sim::Tick scanned = -1;
  };
  static constexpr sim::Tick kNever = -1'000'000;

  const sim::Observer& observer_;
  const sim::Arena& arena_;
  LinkRule rule_;
  std::size_t robots_;
  std::vector<PairMemory> pairs_;  // [a * robots_ + b], a < b
  std::vector<sim::RobotIndex> open_;
};

}  // namespace gauntlet::controllers
