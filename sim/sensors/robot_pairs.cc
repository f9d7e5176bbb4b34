#include "sim/sensors/robot_pairs.h"

#include <algorithm>
#include <cmath>

namespace gauntlet::sim {
namespace {

constexpr std::size_t kManyNeighbours = 64;
// Up to this many robots it costs less to ask every pair than to keep a grid.
constexpr std::size_t kFewRobots = 40;

double LargestReach(std::span<const RobotPairs::Reach> reaches) {
  double largest = 0.0;
  for (const RobotPairs::Reach& reach : reaches) {
    const double diagonal = std::sqrt(2.0) * (reach.camera + foot_bot::kRingRadius);
    largest = std::max({largest, diagonal, reach.radio});
  }
  return largest;
}

}  // namespace

RobotPairs::RobotPairs(std::span<const Reach> reaches)
    : reaches_(reaches.begin(), reaches.end()),
      largest_reach_(LargestReach(reaches)),
      grid_(largest_reach_, reaches.size()),
      boxes_(largest_reach_),
      first_(reaches.size()),
      count_(reaches.size()) {
  const std::size_t robots = reaches.size();
  if (robots > kFewRobots) {
    pairs_.reserve(robots * kManyNeighbours / 2);
    neighbours_.reserve(robots * kManyNeighbours);
  } else if (robots > 0) {
    neighbours_.resize(robots * (robots - 1));
    for (std::size_t i = 0; i < robots; ++i) first_[i] = i * (robots - 1);
  }
}

template <typename BoxBetween>
bool RobotPairs::Find(std::span<const BodyFrame> robots, const BoxBetween& box_between, double extra,
                      std::size_t a, std::size_t b, Neighbour& view) const {
  const Vec2 offset = robots[b].position - robots[a].position;
  const double side = std::max(std::abs(offset.x()), std::abs(offset.y()));
  const double camera = std::max(reaches_[a].camera, reaches_[b].camera);
  const double radio = std::max(reaches_[a].radio, reaches_[b].radio);
  const double squared = offset.squaredNorm();
  if (!(camera > 0.0 && side < camera + extra) && !(squared < radio * radio)) return false;
  view.robot = static_cast<RobotIndex>(b);
  view.offset = offset;
  view.clear = !box_between(robots[a].position, robots[b].position);
  if (view.clear) view.distance = std::sqrt(squared);
  return true;
}

// The same pair as b has it.
RobotPairs::Neighbour RobotPairs::Back(const Neighbour& view, std::size_t a) {
  return {.robot = static_cast<RobotIndex>(a),
          .offset = -view.offset,
          .clear = view.clear,
          .distance = view.distance};
}

void RobotPairs::Update(std::span<const BodyFrame> robots, const Occluders& occluders, bool ring_seen) {
  const double extra = ring_seen ? foot_bot::kRingRadius : 0.0;
  std::fill(count_.begin(), count_.end(), std::size_t{0});
  if (robots.size() <= kFewRobots) {
    UpdateFew(robots, occluders, extra);
  } else {
    UpdateMany(robots, occluders, extra);
  }
}

void RobotPairs::UpdateFew(std::span<const BodyFrame> robots, const Occluders& occluders, double extra) {
  const auto box_between = [&](const Vec2& p, const Vec2& q) { return occluders.BoxBetweenRobots(p, q); };
  for (std::size_t a = 0; a < robots.size(); ++a) {
    for (std::size_t b = a + 1; b < robots.size(); ++b) {
      Neighbour& view = neighbours_[first_[a] + count_[a]];
      if (!Find(robots, box_between, extra, a, b, view)) continue;
      ++count_[a];
      neighbours_[first_[b] + count_[b]++] = Back(view, a);
    }
  }
}

void RobotPairs::UpdateMany(std::span<const BodyFrame> robots, const Occluders& occluders, double extra) {
  pairs_.clear();
  grid_.Update(robots);
  if (boxes_.size() != occluders.size()) {
    for (std::size_t i = 0; i < occluders.size(); ++i) boxes_.AddBox(occluders.box(i));
    boxes_.SetRobots(static_cast<int>(robots.size()));
  }
  for (std::size_t a = 0; a < robots.size(); ++a) {
    // Whatever stands between a and somebody in its reach is in its reach.
    const std::span<const std::size_t> boxes = boxes_.Near(static_cast<RobotIndex>(a), robots[a].position);
    const auto box_between = [&](const Vec2& p, const Vec2& q) { return occluders.BoxBetween(boxes, p, q); };
    for (const std::size_t b : grid_.Near(robots[a].position)) {
      Neighbour view;
      if (b <= a || !Find(robots, box_between, extra, a, b, view)) continue;
      pairs_.push_back({.a = a, .b = b, .view = view});
      ++count_[a];
      ++count_[b];
    }
  }
  std::size_t end = 0;
  for (std::size_t i = 0; i < count_.size(); ++i) {
    first_[i] = end;
    end += count_[i];
    count_[i] = 0;
  }
  neighbours_.resize(end);
  for (const Pair& pair : pairs_) {
    neighbours_[first_[pair.a] + count_[pair.a]++] = pair.view;
    neighbours_[first_[pair.b] + count_[pair.b]++] = Back(pair.view, pair.a);
  }
}

}  // namespace gauntlet::sim
