// Where the archive search takes its next layouts from: pure functions from layouts that fail to layouts that
// may.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "search/evolution/genome_generator.h"
#include "sim/arena/genome.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

// The obstacles by the distance, m, of their nearest point to `place`, the nearest first; of equal ones the
// first.
std::vector<std::size_t> ByDistance(const sim::Genome& obstacles, const sim::Vec2& place);

// Those at `indices`, in the order of the layout.
sim::Genome Keep(const sim::Genome& obstacles, std::vector<std::size_t> indices);
sim::Genome Without(const sim::Genome& obstacles, std::size_t index);

// The line from where a swarm starts to where it is to arrive.
struct Way {
  sim::Vec2 start;  // m
  sim::Vec2 goal;   // m
};
// As ByDistance, to the line segment.
std::vector<std::size_t> ByDistanceToWay(const sim::Genome& obstacles, const Way& way);

// Reflected in the way: what traps a swarm on its left may trap it on its right.
sim::Vec2 Mirrored(const sim::Vec2& point, const Way& way);
// Nothing when the layout is not valid.
std::optional<sim::Genome> Mirrored(const sim::Genome& obstacles, const Way& way,
                                    const GenomeGenerator& generator);

// `count` obstacles side by side across the way, near `place`: long ones, which the swarm has to go around.
// Those at the ends lean forward or backward. Nothing when the layout is not valid.
std::optional<sim::Genome> Across(const sim::Vec2& place, int count, const Way& way,
                                  const GenomeGenerator& generator, sim::RandomStream& random);

// Every obstacle as long as any may be, or nearly, and turned a little. Nothing when the layout is not valid.
std::optional<sim::Genome> Longest(const sim::Genome& obstacles, const GenomeGenerator& generator,
                                   sim::RandomStream& random);

// Every obstacle moved, stretched and turned a little. Nothing when the layout is not valid.
std::optional<sim::Genome> Jittered(const sim::Genome& obstacles, const GenomeGenerator& generator,
                                    sim::RandomStream& random);

}  // namespace gauntlet
