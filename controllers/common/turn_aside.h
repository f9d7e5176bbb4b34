// Avoiding obstacles by turning to one side and driving on (Hoff et al. 2010 as quoted in thesis 5.2.1:
// "usually by simply turning left and moving forward"). Walls, obstacles and robots are all the same to it.
#pragma once

#include <optional>

#include "controllers/common/proximity.h"
#include "controllers/common/steering.h"
#include "sim/random/random_stream.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

struct TurnAsideSettings {
  double near_distance = 0.0;   // m beyond the body: something nearer in front is avoided
  double clear_distance = 0.0;  // m, turns until nothing in front is nearer; at least near_distance
  double front_angle = 0.0;     // rad to either side of the heading
  double speed = 0.0;           // m/s
  double turn_rate = 0.0;       // rad/s, on the spot
  sim::Tick escape_ticks = 0;   // then drives straight on for this long
  bool random_side = false;     // left or right by chance, once per encounter; false: always left
};

// One robot's avoidance. An encounter lasts from the first turn until the way on is over undisturbed.
class TurnAside {
 public:
  explicit TurnAside(const TurnAsideSettings& settings);

  // What to do in this tick; nothing when nothing is to be avoided. Draws once from `random` at the beginning
  // of an encounter when the side is random.
  std::optional<DriveCommand> Next(const ProximityReadings& readings, sim::RandomStream& random);
  // Forgets an encounter, because something else has steered.
  void Reset() { phase_ = Phase::kIdle; }

 private:
  enum class Phase { kIdle, kTurning, kEscaping };

  TurnAsideSettings settings_;
  double near_reading_;
  double clear_reading_;
  Phase phase_ = Phase::kIdle;
  double side_ = 1.0;  // 1 = left, -1 = right
  sim::Tick escape_left_ = 0;
};

}  // namespace gauntlet::controllers
