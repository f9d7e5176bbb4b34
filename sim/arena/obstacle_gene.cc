#include "sim/arena/obstacle_gene.h"

#include <cmath>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {

OrientedBox BoxOf(const ObstacleGene& gene) {
  // Quarter turns are taken off in degrees, where they are exact, so that 90, 180 and 270 degrees give exact
  // axes.
  const double degrees = std::fmod(gene.orientation_deg, 360.0);
  const double quarters = std::floor(degrees / 90.0 + 0.5);
  Vec2 axis = UnitVector((degrees - 90.0 * quarters) * kDegree);
  for (int turns = (static_cast<int>(quarters) + 4) % 4; turns > 0; --turns) axis = LeftOf(axis);
  return {{gene.x, gene.y}, {gene.length / 2.0, gene.width / 2.0}, axis};
}

}  // namespace gauntlet::sim
