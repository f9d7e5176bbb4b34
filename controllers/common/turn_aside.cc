#include "controllers/common/turn_aside.h"

namespace gauntlet::controllers {

TurnAside::TurnAside(const TurnAsideSettings& settings)
    : settings_(settings),
      near_reading_(ProximityReadingAt(settings.near_distance)),
      clear_reading_(ProximityReadingAt(settings.clear_distance)) {}

std::optional<DriveCommand> TurnAside::Next(const ProximityReadings& readings, sim::RandomStream& random) {
  const double front = FrontReading(readings, settings_.front_angle);
  const bool near = front > near_reading_;
  if (phase_ == Phase::kIdle) {
    if (!near) return std::nullopt;
    side_ = settings_.random_side && random.Chance(0.5) ? -1.0 : 1.0;
    phase_ = Phase::kTurning;
  } else if (phase_ == Phase::kEscaping && near) {
    phase_ = Phase::kTurning;
  }
  if (phase_ == Phase::kTurning) {
    if (front >= clear_reading_) return DriveCommand{0.0, side_ * settings_.turn_rate};
    phase_ = Phase::kEscaping;
    escape_left_ = settings_.escape_ticks;
  }
  if (escape_left_ == 0) {
    phase_ = Phase::kIdle;
    return std::nullopt;
  }
  --escape_left_;
  return DriveCommand{settings_.speed, 0.0};
}

}  // namespace gauntlet::controllers
