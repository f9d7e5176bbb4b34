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
      first_(reaches.size() + 1),
      next_(reaches.size()) {
  const std::size_t neighbours = reaches.empty() ? 0 : std::min(reaches.size() - 1, kManyNeighbours);
  pairs_.reserve(reaches.size() * neighbours / 2 + 1);
  neighbours_.reserve(reaches.size() * neighbours);
}

void RobotPairs::TryPair(std::span<const BodyFrame> robots, const Occluders& occluders, double extra,
                         std::size_t a, std::size_t b) {
  const Vec2 offset = robots[b].position - robots[a].position;
  const double side = std::max(std::abs(offset.x()), std::abs(offset.y()));
  const double camera = std::max(reaches_[a].camera, reaches_[b].camera);
  const double radio = std::max(reaches_[a].radio, reaches_[b].radio);
  if (!(camera > 0.0 && side < camera + extra) && !(offset.squaredNorm() < radio * radio)) return;
  Pair pair{.a = a, .b = b, .view = {.robot = static_cast<RobotIndex>(b), .offset = offset}};
  pair.view.clear = !occluders.BoxBetweenRobots(robots[a].position, robots[b].position);
  if (pair.view.clear) {
    pair.view.distance = std::sqrt(offset.squaredNorm());
    pair.view.bearing = AngleOf(offset);
  }
  pairs_.push_back(pair);
}

void RobotPairs::Update(std::span<const BodyFrame> robots, const Occluders& occluders, bool ring_seen) {
  const double extra = ring_seen ? foot_bot::kRingRadius : 0.0;
  pairs_.clear();
  if (robots.size() <= kFewRobots) {
    for (std::size_t a = 0; a < robots.size(); ++a) {
      for (std::size_t b = a + 1; b < robots.size(); ++b) TryPair(robots, occluders, extra, a, b);
    }
  } else {
    grid_.Update(robots);
    for (std::size_t a = 0; a < robots.size(); ++a) {
      for (const std::size_t b : grid_.Near(robots[a].position)) {
        if (b > a) TryPair(robots, occluders, extra, a, b);
      }
    }
  }

  std::fill(first_.begin(), first_.end(), std::size_t{0});
  for (const Pair& pair : pairs_) {
    ++first_[pair.a + 1];
    ++first_[pair.b + 1];
  }
  for (std::size_t i = 0; i < next_.size(); ++i) {
    first_[i + 1] += first_[i];
    next_[i] = first_[i];
  }
  neighbours_.resize(2 * pairs_.size());
  for (const Pair& pair : pairs_) {
    neighbours_[next_[pair.a]++] = pair.view;
    Neighbour back = pair.view;
    back.robot = static_cast<RobotIndex>(pair.a);
    back.offset = -back.offset;
    back.bearing = back.bearing > 0.0 ? back.bearing - kPi : back.bearing + kPi;
    neighbours_[next_[pair.b]++] = back;
  }
}

}  // namespace gauntlet::sim
