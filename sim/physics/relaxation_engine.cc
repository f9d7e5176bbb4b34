// The hand-written solver: the same drive model as in box2d_engine.cc, contacts by relaxation. In each half
// of a tick robots go where they drive, then overlaps are taken out a few times over, each pair sharing its
// overlap evenly. Without friction: an oracle and a measure of speed, not the model that results are
// published with.

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "sim/geometry/nearby_boxes.h"
#include "sim/geometry/neighbour_pairs.h"
#include "sim/geometry/trigonometry.h"
#include "sim/physics/box_motion.h"
#include "sim/physics/differential_drive.h"
#include "sim/physics/physics_engine.h"

namespace gauntlet::sim {
namespace {

constexpr int kPasses = 4;
constexpr double kHalfTick = kTickSeconds / kStepsPerTick;  // s
constexpr double kBoxReach = 0.4;  // m; > radius + what a robot can move in a tick, pushed or not
// Beyond what both drive, pairs this near (m) are watched: a crowd pushes robots further than they drive.
constexpr double kMargin = 0.05;
constexpr double kSlack = 0.1;  // m; two robots that drive at each other use it up in 0.5 s

// How a disc of a robot's radius at `p` gets out of the box by the shortest way; zero when it is not in it.
Vec2 WayOut(const OrientedBox& box, const Vec2& p) {
  const Vec2 local = ToLocal(box, p);
  const Vec2 closest = local.cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
  const Vec2 outward = local - closest;
  const double distance_squared = outward.squaredNorm();
  if (distance_squared >= foot_bot::kRadius * foot_bot::kRadius) return Vec2::Zero();
  Vec2 way;
  if (distance_squared > 0.0) {
    const double distance = std::sqrt(distance_squared);
    way = (foot_bot::kRadius - distance) / distance * outward;
  } else {  // the centre is in the box: through the nearest face
    const double x = box.half_extents.x() - std::abs(local.x()) + foot_bot::kRadius;
    const double y = box.half_extents.y() - std::abs(local.y()) + foot_bot::kRadius;
    way = x < y ? Vec2(local.x() < 0.0 ? -x : x, 0.0) : Vec2(0.0, local.y() < 0.0 ? -y : y);
  }
  return way.x() * box.axis + way.y() * LeftOf(box.axis);
}

struct Robot {
  double heading = 0.0;
  DriveState drive;
  DriveMotion motion;
  Vec2 start = Vec2::Zero();  // m, where the tick begins
  bool touched = false;       // in this tick
};

class RelaxationEngine final : public PhysicsEngine {
 public:
  RelaxationEngine() : nearby_(kBoxReach) {}

  void AddBox(const OrientedBox& box) override { nearby_.AddBox(box); }
  BoxIndex AddKinematicBox(const OrientedBox& box) override;
  RobotIndex AddRobot(const Pose& pose) override;
  void MoveBox(BoxIndex box, const Pose& end) override { moving_[static_cast<std::size_t>(box)].SendTo(end); }
  void Step(std::span<const WheelSpeeds> commands) override;
  Pose PoseOf(RobotIndex robot) const override {
    const auto index = static_cast<std::size_t>(robot);
    return {positions_[index], robots_[index].heading};
  }
  const OrientedBox& BoxAt(BoxIndex box) const override { return moving_[static_cast<std::size_t>(box)].box; }

 private:
  void PartRobots();
  void LeaveBoxes(std::size_t robot);

  NearbyBoxes nearby_;
  NeighbourPairs neighbours_{kSlack};
  std::vector<Vec2> positions_;
  std::vector<Vec2> from_;  // where a half begins
  std::vector<Robot> robots_;
  std::vector<BoxMotion> moving_;
  bool prepared_ = false;
};

BoxIndex RelaxationEngine::AddKinematicBox(const OrientedBox& box) {
  moving_.emplace_back(box);
  return static_cast<BoxIndex>(moving_.size()) - 1;
}

RobotIndex RelaxationEngine::AddRobot(const Pose& pose) {
  robots_.emplace_back();
  robots_.back().heading = pose.heading;
  positions_.push_back(pose.position);
  from_.push_back(pose.position);
  prepared_ = false;
  return static_cast<RobotIndex>(robots_.size()) - 1;
}

void RelaxationEngine::Step(std::span<const WheelSpeeds> commands) {
  GAUNTLET_CHECK(commands.size() == robots_.size(), "one command per robot");
  if (!prepared_) {
    nearby_.SetVisitors(robots_.size());
    prepared_ = true;
  }
  double longest_move = 0.0;  // squared
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    robot.touched = false;
    robot.start = positions_[i];
    robot.motion = Drive(robot.drive, commands[i], UnitVector(robot.heading));
    longest_move = std::max(longest_move, (robot.motion.halves[0] + robot.motion.halves[1]).squaredNorm());
  }
  neighbours_.Update(positions_, 2.0 * (foot_bot::kRadius + std::sqrt(longest_move)) + kMargin);

  for (std::size_t half = 0; half < kStepsPerTick; ++half) {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      from_[i] = positions_[i];
      positions_[i] += robots_[i].motion.halves[half];
    }
    for (BoxMotion& moving : moving_) {
      if (moving.Goes()) moving.Advance(kStepsPerTick - half);
    }
    for (int pass = 0; pass < kPasses; ++pass) {
      PartRobots();
      for (std::size_t i = 0; i < robots_.size(); ++i) LeaveBoxes(i);
    }
  }

  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    // Rounded once, as in the other engine.
    if (!robot.touched) positions_[i] = robot.start + (robot.motion.halves[0] + robot.motion.halves[1]);
    // What a contact leaves of the velocity; the drive's force builds it up again.
    robot.drive = robot.touched
                      ? DriveState{(positions_[i] - from_[i]) / kHalfTick, robot.motion.end.turn_rate}
                      : robot.motion.end;
    robot.heading = WrapAngle(robot.heading + robot.motion.turn);
  }
}

void RelaxationEngine::PartRobots() {
  constexpr double kContact = 2.0 * foot_bot::kRadius;
  for (const auto& [i, j] : neighbours_.pairs()) {
    const Vec2 apart = positions_[i] - positions_[j];
    const double distance_squared = apart.squaredNorm();
    if (distance_squared >= kContact * kContact || distance_squared == 0.0) continue;
    const double distance = std::sqrt(distance_squared);
    const Vec2 push = 0.5 * (kContact - distance) / distance * apart;
    positions_[i] += push;
    positions_[j] -= push;
    robots_[i].touched = true;
    robots_[j].touched = true;
  }
}

void RelaxationEngine::LeaveBoxes(std::size_t robot) {
  for (const BoxMotion& moving : moving_) {
    const Vec2 way = WayOut(moving.box, positions_[robot]);
    if (way == Vec2::Zero()) continue;
    positions_[robot] += way;
    robots_[robot].touched = true;
  }
  for (const std::size_t index : nearby_.Near(robot, positions_[robot])) {
    const Vec2 way = WayOut(nearby_.box(index), positions_[robot]);
    if (way == Vec2::Zero()) continue;
    positions_[robot] += way;
    robots_[robot].touched = true;
  }
}

}  // namespace

std::unique_ptr<PhysicsEngine> MakeRelaxationEngine() {
  return std::make_unique<RelaxationEngine>();
}

}  // namespace gauntlet::sim
