// Items of the generic scenario: robots take them in a source, one at a time, and lay them down. Sources
// never run out. A robot with a gripper takes one where it closes the gripper, and lays it down where it
// opens it; a robot without takes one by being in a source, and lays it down by being in a nest.
#pragma once

#include <cstdint>
#include <vector>

#include "controllers/generic/definition.h"
#include "controllers/generic/measures.h"
#include "sim/scenario.h"

namespace gauntlet::controllers::generic {

class Items {
 public:
  Items(std::vector<Area> sources, std::vector<Area> nests);

  // grips[i]: robot i has a gripper.
  void Begin(std::vector<bool> grips);
  void Move(const sim::Interaction& interaction);
  const ItemCount& count() const { return count_; }

 private:
  std::vector<Area> sources_;
  std::vector<Area> nests_;
  std::vector<bool> grips_;
  std::vector<std::uint8_t> carries_;
  ItemCount count_;
};

}  // namespace gauntlet::controllers::generic
