#include "controllers/foraging/pheromone.h"

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {

double LaidStaleness(double seconds, double distance, const PheromoneSettings& settings) {
  return (seconds + distance / settings.speed) / settings.trail_time;
}

double NestStaleness(double distance, double range) {
  return -sim::Log(1.0 + 0.01 * (range - distance));
}

}  // namespace gauntlet::controllers
