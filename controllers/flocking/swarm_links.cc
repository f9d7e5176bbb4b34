#include "controllers/flocking/swarm_links.h"

#include <algorithm>
#include <utility>

namespace gauntlet::controllers {

SwarmLinks::SwarmLinks(const sim::Observer& observer, const sim::Arena& arena, const LinkRule& rule)
    : observer_(observer),
      arena_(arena),
      rule_(rule),
      robots_(static_cast<std::size_t>(observer.robots())),
      pairs_(robots_ * robots_) {
  open_.reserve(robots_);
}

bool SwarmLinks::Edge(sim::RobotIndex a, sim::RobotIndex b, sim::Tick tick) const {
  const auto states = observer_.At(tick);
  const sim::Vec2 pa = states[static_cast<std::size_t>(a)].position();
  const sim::Vec2 pb = states[static_cast<std::size_t>(b)].position();
  return (pb - pa).squaredNorm() <= rule_.range * rule_.range &&
         arena_.LineOfSight(pa, pb, observer_.ObstaclesAt(tick));
}

bool SwarmLinks::Linked(sim::RobotIndex a, sim::RobotIndex b, sim::Tick tick) {
  if (a > b) std::swap(a, b);
  PairMemory& pair = pairs_[static_cast<std::size_t>(a) * robots_ + static_cast<std::size_t>(b)];
  const sim::Tick oldest = std::max<sim::Tick>(0, tick - rule_.memory + 1);
  if (pair.last_edge >= oldest) return true;
  for (sim::Tick t = tick; t >= oldest && t > pair.scanned; --t) {
    if (!Edge(a, b, t)) continue;
    pair.last_edge = t;
    break;
  }
  pair.scanned = std::max(pair.scanned, tick);
  return pair.last_edge >= oldest;
}

RobotFlags SwarmLinks::Component(sim::RobotIndex start, sim::Tick tick, const RobotFlags& among) {
  RobotFlags members(robots_, 0);
  members[static_cast<std::size_t>(start)] = 1;
  open_.assign(1, start);
  while (!open_.empty()) {
    const sim::RobotIndex robot = open_.back();
    open_.pop_back();
    for (std::size_t other = 0; other < robots_; ++other) {
      if (members[other] != 0 || among[other] == 0) continue;
      if (!Linked(robot, static_cast<sim::RobotIndex>(other), tick)) continue;
      members[other] = 1;
      open_.push_back(static_cast<sim::RobotIndex>(other));
    }
  }
  return members;
}

}  // namespace gauntlet::controllers
