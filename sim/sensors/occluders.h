// What can stand between two points: boxes and robots' bodies, all of limited height, so that a rising or
// falling ray may pass above them (facts measured in ARGoS: tests/golden/argos/sensors/*_occ*.csv).
#pragma once

#include <span>
#include <vector>

#include "sim/arena/arena.h"
#include "sim/geometry/oriented_box.h"
#include "sim/robot/foot_bot.h"
#include "sim/sensors/body_frame.h"

namespace gauntlet::sim {

// A point above the floor.
struct Point3 {
  Vec2 position;
  double height;  // m
};

// Walls and obstacles of an arena are this high, m: robots neither see nor hear over them.
inline constexpr double kBoxHeight = 1.0;

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

  // The numbers, in the order they were added, of the boxes that may stand between two of these places and
  // are higher than any device.
  void FindHighBoxes(std::span<const Vec2> places, std::vector<std::size_t>& found) const;
  // Whether one of these boxes that is higher than any device, or one that moves, stands on the line. The
  // answer is the same in both directions. Boundary counts.
  bool BoxBetween(std::span<const std::size_t> boxes, const Vec2& a, const Vec2& b) const;
  // Of the fixed boxes.
  std::size_t size() const { return boxes_.size(); }
  const OrientedBox& box(std::size_t index) const { return boxes_[index].box; }
  // Whether the straight line from a to b meets a box, at or below the box's height.
  bool BoxBetween(const Point3& a, const Point3& b) const;

 private:
  struct Box {
    OrientedBox box;
    double height;
    Vec2 min;  // m, axis-aligned bounds
    Vec2 max;
  };

  static Box Bounded(const OrientedBox& box, double height);
  static bool HighBoxBetween(const Box& box, const Vec2& a, const Vec2& b, const Vec2& min, const Vec2& max);
  static bool LowBoxBetween(const Box& box, const Point3& a, const Point3& b);

  std::vector<Box> boxes_;
  std::vector<Box> moving_;
  bool all_high_ = true;
};

// Whether the line from a to b meets the body of a robot other than `self` and `other` (-1 = none).
bool BodyBetween(std::span<const BodyFrame> robots, const Point3& a, const Point3& b, RobotIndex self,
                 RobotIndex other);

}  // namespace gauntlet::sim
