// How often robots begin to touch something: one another, an obstacle or a wall.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/observer.h"

namespace gauntlet::sim {

class Contacts {
 public:
  Contacts(const Arena& arena, int robots);

  // The newest tick. Who touches at the start has not begun to.
  void Add(const Observer& observer);
  // Contacts that began: of two robots one, not two.
  int begun() const { return begun_; }

 private:
  void Note(std::size_t pair, bool touches);

  std::vector<OrientedBox> boxes_;  // the moving ones first
  std::size_t moving_ = 0;
  std::vector<std::uint8_t> touching_;  // robot by robot, then robot by box
  int begun_ = 0;
  bool first_ = true;
};

}  // namespace gauntlet::sim
