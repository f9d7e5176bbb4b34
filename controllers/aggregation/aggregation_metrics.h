// How well a swarm has gathered. Pure functions of positions, m.
#pragma once

#include <span>
#include <vector>

#include "controllers/common/clusters.h"
#include "sim/arena/arena.h"
#include "sim/observer.h"

namespace gauntlet::controllers::aggregation {

// Second moment of the positions about their mean in units of (2 r)^2, r = the robots' radius (the measure of
// how tightly discs are packed of R. L. Graham and N. J. A. Sloane, "Penny-packing and two-dimensional
// codes", Discrete & Computational Geometry 5, 1990). 0 of nobody.
double Dispersion(std::span<const sim::Vec2> robots);

// Sum of the distances of all pairs, m.
double TotalDistance(std::span<const sim::Vec2> robots);

// Size of the cluster that a robot picked at random is in: the mean, robots.
double ExpectedClusterSize(std::span<const int> sizes);

// The clusters at a moment. A robot's cluster is an index into `sizes`.
struct Groups {
  std::vector<int> sizes;
  std::vector<int> members;
  int first = 0;    // the largest cluster
  int second = -1;  // the next largest; of equal ones that with the first robot; -1: all are in one

  double Share(int cluster) const;  // of all robots; 0 of cluster -1
  std::vector<sim::Vec2> Robots(int cluster, std::span<const sim::Vec2> positions) const;
};
Groups FindGroups(Clusters& clusters, std::span<const sim::Vec2> robots, const sim::Arena& arena,
                  double link_range, std::span<const sim::Vec2> obstacles);

// Mean position; there is at least one robot.
sim::Vec2 Centroid(std::span<const sim::Vec2> robots);

// Whether a robot of one group has one of the other in sight and within `range` m.
bool InSight(std::span<const sim::Vec2> group, std::span<const sim::Vec2> other, const sim::Arena& arena,
             double range, std::span<const sim::Vec2> obstacles);

}  // namespace gauntlet::controllers::aggregation
