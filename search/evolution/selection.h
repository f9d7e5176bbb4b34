// Who becomes a parent and who stays (thesis 3.2.3.3). Lower fitness is fitter; of equals the
// younger one, the one with the larger id, is preferred.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "search/search_algorithm.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

// Whether `a` ranks before `b`.
bool Fitter(const Individual& a, const Individual& b);

// Leaves the `count` fittest, in order of birth. count <= individuals.size().
void KeepFittest(std::vector<Individual>& individuals, std::size_t count);

// Indices of the two fittest, the fittest first. At least two individuals.
std::array<std::size_t, 2> TwoFittest(const std::vector<Individual>& individuals);

// Two different indices below `count`, uniformly. count >= 2.
std::array<std::size_t, 2> TwoAtRandom(std::size_t count, sim::RandomStream& random);

// 0 .. count-1 in random order (Fisher and Yates 1938; Durstenfeld 1964).
std::vector<std::size_t> Shuffled(std::size_t count, sim::RandomStream& random);

}  // namespace gauntlet
