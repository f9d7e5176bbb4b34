// Virtual pheromone (Payton et al. 2001; Hoff et al. 2010; thesis 2.4.2.2, 5.2.1): a number that beacons
// keep, that passing robots raise and that evaporates.
//
// A level phi in [0, 1] is kept as its staleness -ln(phi): infinity for none, 0 for 1. Then evaporation by
// exp(-t / tau) is an addition, the larger of two levels is the smaller staleness, and no tick needs an
// exponential.
#pragma once

#include <limits>

#include "sim/geometry/trigonometry.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

struct PheromoneSettings {
  double decay_time = 0.0;  // s, a level falls to 1/e in this time
  double trail_time = 0.0;  // s, what a robot lays falls to 1/e when its way took this much longer
  double speed = 0.0;       // m/s, turns the distance to a beacon into time
};

inline constexpr double kNoPheromone = std::numeric_limits<double>::infinity();

// Staleness of what a robot lays at a beacon at `distance` m when it left the place it comes from
// `seconds` ago: phi = exp(-(seconds + distance / speed) / trail_time).
inline double LaidStaleness(double seconds, double distance, const PheromoneSettings& settings) {
  return (seconds + distance / settings.speed) / settings.trail_time;
}
// Staleness of a beacon's own level towards the nest when it hears the nest at `distance` m, nearer than
// `range`: phi = 1 + (range - distance) / 100, so that among such beacons the nearest is the most attractive.
inline double NestStaleness(double distance, double range) {
  return -sim::Log(1.0 + 0.01 * (range - distance));
}

// One level of one beacon.
class Pheromone {
 public:
  double staleness() const { return staleness_; }
  void Set(double staleness) { staleness_ = staleness; }
  // Keeps the larger level.
  void Lay(double staleness) {
    if (staleness < staleness_) staleness_ = staleness;
  }
  void Evaporate(const PheromoneSettings& settings) { staleness_ += sim::kTickSeconds / settings.decay_time; }
  void Clear() { staleness_ = kNoPheromone; }

 private:
  double staleness_ = kNoPheromone;
};

}  // namespace gauntlet::controllers
