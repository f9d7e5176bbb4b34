// BugS (thesis 6.5.2.1, Figure 6.7): Bug2 of Lumelsky and Stepanov 1986 without its line and its memory. A
// robot that meets an obstacle on its way follows the obstacle's edge, and leaves it as soon as it sees no
// obstacle between itself and the goal. It can circle for ever in a trap that is deeper than the scanner
// reaches.
#pragma once

#include <optional>
#include <span>

#include "controllers/common/proximity.h"
#include "controllers/common/steering.h"
#include "sim/geometry/trigonometry.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers {

struct BugSettings {
  double speed = 0.0;           // m/s
  double goal_angle = 0.0;      // rad to either side of the goal's bearing: what lies there is in the way
  double meet_distance = 0.0;   // m beyond the body: an obstacle this near in the way is followed
  double wall_distance = 0.0;   // m beyond the body, kept to the obstacle on the right
  double wall_gain = 0.0;       // rad/s per m
  double wall_turn = 0.0;       // rad/s, limit of that
  double front_angle = 0.0;     // rad to either side of the heading
  double front_distance = 0.0;  // m: something nearer in front: turns left on the spot
  double turn_rate = 0.0;       // rad/s, on the spot
  double lost_turn = 0.0;       // rad/s, round a corner
  sim::Tick clear_ticks = 0;    // the way must be seen clear for this long before it leaves
};

// What one tick shows of obstacles; robots are left out (WithoutBodies).
struct BugView {
  ProximityReadings proximity{};
  std::span<const sim::ScannerReading> scan;  // short range
  std::span<const SeenBody> bodies;           // robots: what the scanner sees of them is no obstacle
  double goal_bearing = 0.0;                  // rad
  double goal_distance = 0.0;                 // m from the robot's centre
};

class BugWalk {
 public:
  explicit BugWalk(const BugSettings& settings) : settings_(settings) {}

  // What to do in this tick; nothing when the way to the goal is free.
  std::optional<DriveCommand> Next(const BugView& view);
  bool following() const { return following_; }
  // Another way begins.
  void Reset() { following_ = false; }

  // How the scanner is to be driven while following: a whole turn per tick and a bit, so that the next rays
  // fall between the last ones.
  static constexpr double kScannerSpeed = (sim::kPi + sim::kPi / 18.0) / sim::kTickSeconds;  // rad/s

 private:
  DriveCommand Follow(const BugView& view) const;
  bool WayIsClear(const BugView& view) const;

  BugSettings settings_;
  bool following_ = false;
  sim::Tick clear_ = 0;
};

}  // namespace gauntlet::controllers
