#include "controllers/common/random_walk.h"

namespace gauntlet::controllers {

double RandomWalk::Next(sim::RandomStream& random) {
  if (random.Chance(parameters_.turn_probability)) {
    remaining_ = random.Uniform(-parameters_.turn_limit, parameters_.turn_limit);
  }
  return remaining_;
}

}  // namespace gauntlet::controllers
