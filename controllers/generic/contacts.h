// How often robots begin to touch something: one another, an obstacle or a wall.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/observer.h"

namespace gauntlet::controllers::generic {

// Bodies that are no farther apart touch, m: what the physics leaves between two that lean on each other is
// less.
inline constexpr double kTouching = 0.001;

class Contacts {
 public:
  Contacts(const sim::Arena& arena, int robots);

  // The newest tick. Who touches at the start has not begun to.
  void Add(const sim::Observer& observer);
  // Contacts that began: of two robots one, not two.
  int begun() const { return begun_; }

 private:
  void Note(std::size_t pair, bool touches);

  std::vector<sim::OrientedBox> boxes_;  // the moving ones first
  std::size_t moving_ = 0;
  std::vector<std::uint8_t> touching_;  // robot by robot, then robot by box
  int begun_ = 0;
  bool first_ = true;
};

}  // namespace gauntlet::controllers::generic
