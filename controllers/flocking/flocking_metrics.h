// How good a flock is (thesis 4.2, 4.5.2). Pure functions.
#pragma once

#include <span>

namespace gauntlet::controllers {

// Angular order (equation 4.1): the length of the mean of the headings' unit vectors. 1 = all face the same
// way (exactly, whatever the way), 0 = no common direction; 0 of nobody.
double AngularOrder(std::span<const double> headings);

// Fitness (equation 4.2): (1 + angular order) * remaining / (2 * total), or 0 when fewer than `min_swarm`
// remain, which is a total failure (thesis 4.1.1). Lower means a tougher test case.
double FlockingFitness(double angular_order, int remaining, int total, int min_swarm);

}  // namespace gauntlet::controllers
