#include "controllers/flocking/flocking_metrics.h"

#include <cmath>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {

double AngularOrder(std::span<const double> headings) {
  if (headings.empty()) return 0.0;
  // Turning all headings by the same angle changes no length; measured from the first one, equal headings
  // give exactly (1, 0) each, so an aligned flock has order 1 to the last bit.
  sim::Vec2 sum = sim::Vec2::Zero();
  for (const double heading : headings) sum += sim::UnitVector(heading - headings.front());
  return std::sqrt(sum.x() * sum.x() + sum.y() * sum.y()) / static_cast<double>(headings.size());
}

double FlockingFitness(double angular_order, int remaining, int total, int min_swarm) {
  if (remaining < min_swarm) return 0.0;
  return (1.0 + angular_order) * remaining / (2.0 * total);
}

}  // namespace gauntlet::controllers
