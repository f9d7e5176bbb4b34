// Groups of things that are near to each other.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace gauntlet::analysis {

// Complete linkage: the two nearest groups are joined as long as no two things of what they become are
// farther apart than `most`. Returns the group of each of `count` things; groups are numbered from 0 by their
// first thing. `distance` is symmetric and not negative. Takes time and memory of count^2.
std::vector<std::size_t> GroupByDistance(std::size_t count,
                                         const std::function<double(std::size_t a, std::size_t b)>& distance,
                                         double most);

}  // namespace gauntlet::analysis
