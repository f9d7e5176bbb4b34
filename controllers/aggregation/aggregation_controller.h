// Aggregation by one bit of sensing (M. Gauci, J. Chen, W. Li, T. J. Dodd, R. Gross, "Self-organized
// aggregation without computation", International Journal of Robotics Research 33(8), 2014): a robot sees
// whether another one is straight ahead. If not, it drives backwards on a circle; if so, it turns on the
// spot.
#pragma once

#include <span>

#include "controllers/common/random_walk.h"
#include "controllers/common/turn_aside.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers::aggregation {

// Speeds of the wheels as shares of `speed`, -1 to 1.
struct AggregationSettings {
  double speed = 0.0;       // m/s
  double alone_left = 0.0;  // while nobody is straight ahead
  double alone_right = 0.0;
  double seeing_left = 0.0;  // while somebody is
  double seeing_right = 0.0;
  // Improved:
  double near_range = 0.0;   // m: robots that are nearer are neighbours
  int quorum = 0;            // a robot with fewer neighbours may leave; 0 = it never does
  double leave_rate = 0.0;   // 1/s
  sim::Tick walk_ticks = 0;  // a robot that leaves walks at random for this long
};

// Whether a robot is straight ahead: a red light whose body the ray ahead passes through.
bool SeesRobotAhead(std::span<const sim::Blob> blobs);

// Robots in sight within `range` m.
int CountNeighbours(std::span<const sim::Blob> blobs, double range);

// Not for sharing between threads.
class AggregationController : public sim::Controller {
 public:
  explicit AggregationController(const AggregationSettings& settings);

  sim::DeviceSet Devices() const override;
  void Step(const sim::ControlStep& step) override;
  bool walking() const { return walk_left_ > 0; }

 private:
  // Away from what is near, else the random walk.
  DriveCommand Walk(const sim::ControlStep& step);

  AggregationSettings settings_;
  RandomWalk walk_;
  TurnAside avoidance_;
  sim::Tick walk_left_ = 0;
};

}  // namespace gauntlet::controllers::aggregation
