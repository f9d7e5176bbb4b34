// What a program asks of its arenas.
#pragma once

#include "controllers/command/definition.h"
#include "sim/arena/validity.h"

namespace gauntlet::controllers::command {

// A kilobot's arena may be as small, m.
inline constexpr double kLeastArenaSide = 0.1;

// Of a right definition. Its arenas may lie anywhere.
sim::ArenaRequirements RequirementsOf(const Definition& definition);

}  // namespace gauntlet::controllers::command
