#include "sim/sensors/robot_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gauntlet::sim {
namespace {

constexpr std::size_t kManyNeighbours = 64;
// Up to this many robots all pairs are listed for good, because looking whether a pair is due costs less than
// a list.
constexpr std::size_t kFewRobots = 40;
constexpr double kEverywhere = 1e6;  // m
// m; a list of pairs holds for two seconds of driving or more.
constexpr double kPairSlack = 0.4;
constexpr double kRounding = 1e-6;  // m, more than sums over a run's trajectory lose
constexpr double kDue = -std::numeric_limits<double>::infinity();

// Of a square that reaches so far, and whose lights may be on a ring.
double Diagonal(double half_side) {
  return std::sqrt(2.0) * (half_side + foot_bot::kRingRadius);
}

double LargestReach(std::span<const RobotSensors> robots) {
  double largest = 0.0;
  for (const RobotSensors& robot : robots) {
    largest = std::max({largest, Diagonal(robot.CameraReach()), robot.RadioReach()});
  }
  return largest;
}

}  // namespace

RobotPairs::RobotPairs(std::span<const RobotSensors> robots, std::span<const OrientedBox> fixed_boxes)
    : largest_reach_(LargestReach(robots)),
      near_(robots.size() <= kFewRobots ? kEverywhere : kPairSlack),
      boxes_(largest_reach_ + Occluders::kLongest),
      driven_(robots.size()),
      was_lit_(robots.size()),
      first_(robots.size()),
      count_(robots.size()) {
  for (const RobotSensors& robot : robots)
    reaches_.push_back({robot.CameraReach(), robot.RadioReach(), robot.EarReach()});
  neighbours_.reserve(robots.size() * std::min(robots.size(), kManyNeighbours));
  pairs_.reserve(neighbours_.capacity() / 2);
  for (const OrientedBox& box : fixed_boxes) boxes_.AddBox(box);
  boxes_.SetVisitors(robots.size());
}

void RobotPairs::Drive(std::span<const Vec2> positions) {
  if (positions_.empty()) positions_.assign(positions.begin(), positions.end());
  double farthest = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double way = std::sqrt((positions[i] - positions_[i]).squaredNorm());
    driven_[i] += way;
    farthest = std::max(farthest, way);
    positions_[i] = positions[i];
  }
  most_driven_ += farthest;
}

bool RobotPairs::SeeNewLights(std::span<const Signals> signals) {
  bool any = false;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (was_lit_[i] != 0 || (signals[i].beacon == Color::kBlack && !signals[i].RingLit())) continue;
    was_lit_[i] = 1;
    any = true;
  }
  return any;
}

// Everybody gets room for the neighbours on the list, side by side.
void RobotPairs::ListPairs() {
  pairs_.clear();
  std::ranges::fill(count_, std::size_t{0});
  for (const auto& [a, b] : near_.pairs()) {
    pairs_.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), Standing::kOutOfReach, kDue, kDue});
    ++count_[a];
    ++count_[b];
  }
  std::size_t end = 0;
  for (std::size_t i = 0; i < count_.size(); ++i) {
    first_[i] = end;
    end += count_[i];
  }
  neighbours_.resize(std::max(neighbours_.size(), end));
}

double RobotPairs::ReachOf(const Pair& pair) const {
  const auto& [camera_a, radio_a, ear_a] = reaches_[pair.a];
  const auto& [camera_b, radio_b, ear_b] = reaches_[pair.b];
  const double camera =
      std::max(was_lit_[pair.b] != 0 ? camera_a : 0.0, was_lit_[pair.a] != 0 ? camera_b : 0.0);
  return std::max(
      {camera > 0.0 ? Diagonal(camera) : 0.0, std::min(radio_a, ear_b), std::min(radio_b, ear_a)});
}

void RobotPairs::Judge(Pair& pair, std::span<const Vec2> positions, const Occluders& occluders) {
  const Vec2& a = positions[pair.a];
  const Vec2& b = positions[pair.b];
  const double beyond = std::sqrt((b - a).squaredNorm()) - ReachOf(pair);
  double holds = 0.5 * beyond;
  pair.standing = Standing::kOutOfReach;
  if (beyond <= 0.0) {
    // Whatever stands between the two is in the reach of each.
    const Sight sight = occluders.SightBetween(boxes_.Near(pair.a, a), a, b);
    holds = sight.holds;
    pair.standing = sight.clear ? Standing::kClear : Standing::kHidden;
  }
  pair.until_a = driven_[pair.a] + holds - kRounding;
  pair.until_b = driven_[pair.b] + holds - kRounding;
}

void RobotPairs::Update(std::span<const Vec2> positions, std::span<const Signals> signals,
                        const Occluders& occluders, bool ring_seen) {
  Drive(positions);
  if (near_.Update(positions, largest_reach_)) ListPairs();
  if (SeeNewLights(signals)) {
    for (Pair& pair : pairs_) pair.until_a = kDue;
  }
  std::ranges::fill(count_, std::size_t{0});
  const Standing least = ring_seen ? Standing::kHidden : Standing::kClear;
  const bool boxes_move = occluders.any_move();
  auto pair = pairs_.begin();
  for (std::size_t a = 0; a < positions.size(); ++a) {
    const Vec2 here = positions[a];
    const double driven = driven_[a];
    Neighbour* next = neighbours_.data() + first_[a] + count_[a];
    for (; pair != pairs_.end() && pair->a == a; ++pair) {
      const std::size_t b = pair->b;
      if (driven >= pair->until_a || driven_[b] >= pair->until_b) [[unlikely]] {
        Judge(*pair, positions, occluders);
      }
      if (pair->standing < least) continue;
      const Vec2 offset = positions[b] - here;
      const bool clear = pair->standing == Standing::kClear &&
                         !(boxes_move && occluders.MovingBoxBetween(here, positions[b]));
      const double distance = std::sqrt(offset.squaredNorm());
      *next++ = {offset, distance, static_cast<RobotIndex>(b), clear};
      neighbours_[first_[b] + count_[b]++] = {-offset, distance, static_cast<RobotIndex>(a), clear};
    }
    count_[a] = static_cast<std::size_t>(next - neighbours_.data()) - first_[a];
  }
}

}  // namespace gauntlet::sim
