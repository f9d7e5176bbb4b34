// What can stand between two points: boxes and robots' bodies, all of limited height, so that a rising or
// falling ray may pass above them (facts measured in ARGoS: tests/golden/argos/sensors/*_occ*.csv).
#pragma once

#include <span>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/geometry/oriented_box.h"
#include "sim/geometry/trigonometry.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

// A robot's body as sensors see it: its direction is computed once per tick and shared by all of them.
struct BodyFrame {
  Vec2 position = Vec2::Zero();
  double heading = 0.0;         // rad in (-pi, pi]
  Vec2 direction = {1.0, 0.0};  // unit vector of the heading

  BodyFrame() = default;
  explicit BodyFrame(const Pose& pose)
      : position(pose.position), heading(pose.heading), direction(UnitVector(pose.heading)) {}

  // A point given in the robot's frame (x forward, y left), in the world's.
  Vec2 ToWorld(const Vec2& point) const {
    return {position.x() + direction.x() * point.x() - direction.y() * point.y(),
            position.y() + direction.y() * point.x() + direction.x() * point.y()};
  }
  // A way given in the world's frame, in the robot's.
  Vec2 FromWorld(const Vec2& way) const {
    return {direction.x() * way.x() + direction.y() * way.y(), Cross(direction, way)};
  }
};

// A point above the floor.
struct Point3 {
  Vec2 position;
  double height;  // m
};

// Walls and obstacles of an arena are this high, m: robots neither see nor hear over them.
inline constexpr double kBoxHeight = 1.0;

// What is known of a line between two places.
struct Sight {
  bool clear = false;
  double holds = 0.0;  // m, how far each of its ends may move before that may change
};

// What somebody knows of the line from where it was to a place that does not move.
struct SightMemory {
  Sight sight;
  Vec2 from = Vec2::Zero();
  Vec2 to = Vec2::Zero();
};

// What robots know of the lines to some places.
class SightMemories {
 public:
  // Allocates when there are more places than before.
  void SetPlaces(std::size_t robots, std::size_t places) {
    if (memories_.size() != robots * places) memories_.assign(robots * places, SightMemory{});
    places_ = places;
  }
  std::span<SightMemory> Of(std::size_t robot) {
    return std::span(memories_).subspan(robot * places_, places_);
  }

 private:
  std::vector<SightMemory> memories_;  // [robot][place]
  std::size_t places_ = 0;
};

class Occluders {
 public:
  Occluders() = default;
  explicit Occluders(const Arena& arena);

  void AddBox(const OrientedBox& box, double height = kBoxHeight);
  // The boxes that move, where they are now, all of the usual height. The answers below count them in. Does
  // not allocate for as many as the arena has.
  void SetMoving(std::span<const OrientedBox> boxes);
  // Every box is higher than any device or lamp, so heights need not be asked for.
  bool all_high() const { return all_high_; }
  bool any_move() const { return !moving_.empty(); }

  // Whether one of these boxes (numbered in the order they were added) that is higher than any device stands
  // on the line. The answer is the same in both directions. Boundary counts. Boxes that move are not asked.
  // Looks at boxes up to kLongest from the line, and no answer holds longer.
  static constexpr double kLongest = 0.3;  // m
  Sight SightBetween(std::span<const std::size_t> boxes, const Vec2& a, const Vec2& b) const;
  // The same of the boxes that move.
  bool MovingBoxBetween(const Vec2& a, const Vec2& b) const;
  // Of the fixed boxes.
  std::size_t size() const { return boxes_.size(); }
  const OrientedBox& box(std::size_t index) const { return boxes_[index].box; }
  // Whether the straight line from a to b meets a box, at or below the box's height.
  bool BoxBetween(const Point3& a, const Point3& b) const;
  // The same, for somebody at a who asks for the same b tick by tick: `memory` saves looking at fixed boxes.
  bool BoxBetween(const Point3& a, const Point3& b, SightMemory& memory) const;

 private:
  struct Box {
    OrientedBox box;
    double height;
    Vec2 min;  // m, axis-aligned bounds
    Vec2 max;
  };

  static Box Bounded(const OrientedBox& box, double height);
  static bool Touches(const Box& box, const Vec2& a, const Vec2& b, const Vec2& min, const Vec2& max);
  static bool LowBoxBetween(const Box& box, const Point3& a, const Point3& b);

  std::vector<Box> boxes_;
  std::vector<std::size_t> all_;  // their numbers
  std::vector<Box> moving_;
  bool all_high_ = true;
};

// Whether the line from a to b meets the body of a robot other than `self` and `other` (-1 = none).
bool BodyBetween(std::span<const BodyFrame> robots, const Point3& a, const Point3& b, RobotIndex self,
                 RobotIndex other);

// How far, in m, the nearest such body is from a line that is lower than robots; negative: how far the line
// goes into it. While the line's ends and all bodies move less than half of that, BodyBetween says the same.
double BodyRoom(std::span<const Vec2> robots, const Vec2& a, const Vec2& b, RobotIndex self,
                RobotIndex other);

}  // namespace gauntlet::sim
