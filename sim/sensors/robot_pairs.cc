#include "sim/sensors/robot_pairs.h"

#include <algorithm>
#include <cmath>

namespace gauntlet::sim {
namespace {

constexpr std::size_t kManyNeighbours = 64;
// Up to this many robots the boxes inside the rectangle around all of them are few.
constexpr std::size_t kFewRobots = 40;
// m; a list of pairs holds for two seconds of driving or more.
constexpr double kSlack = 0.4;

double LargestReach(std::span<const RobotSensors> robots) {
  double largest = 0.0;
  for (const RobotSensors& robot : robots) {
    const double diagonal = std::sqrt(2.0) * (robot.CameraReach() + foot_bot::kRingRadius);
    largest = std::max({largest, diagonal, robot.RadioReach()});
  }
  return largest;
}

}  // namespace

RobotPairs::RobotPairs(std::span<const RobotSensors> robots, std::span<const OrientedBox> fixed_boxes)
    : largest_reach_(LargestReach(robots)),
      near_(kSlack),
      boxes_(largest_reach_),
      first_(robots.size()),
      count_(robots.size()) {
  for (const RobotSensors& robot : robots) reaches_.push_back({robot.CameraReach(), robot.RadioReach()});
  neighbours_.reserve(robots.size() * std::min(robots.size(), kManyNeighbours));
  framed_.reserve(fixed_boxes.size());
  if (robots.size() <= kFewRobots) return;
  for (const OrientedBox& box : fixed_boxes) boxes_.AddBox(box);
  boxes_.SetVisitors(robots.size());
}

// Everybody gets room for the neighbours on the list, side by side.
void RobotPairs::MakeRoom() {
  std::ranges::fill(count_, std::size_t{0});
  for (const auto& [a, b] : near_.pairs()) {
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

void RobotPairs::Update(std::span<const Vec2> positions, const Occluders& occluders, bool ring_seen) {
  const double extra = ring_seen ? foot_bot::kRingRadius : 0.0;
  if (near_.Update(positions, largest_reach_)) MakeRoom();
  std::ranges::fill(count_, std::size_t{0});
  const bool few = positions.size() <= kFewRobots;
  if (few) occluders.FindHighBoxes(positions, framed_);
  std::span<const std::size_t> boxes = framed_;
  std::size_t asked = positions.size();  // whose boxes these are
  for (const auto& [a, b] : near_.pairs()) {
    const Vec2 offset = positions[b] - positions[a];
    const double side = std::max(std::abs(offset.x()), std::abs(offset.y()));
    const double camera = std::max(reaches_[a].camera, reaches_[b].camera);
    const double radio = std::max(reaches_[a].radio, reaches_[b].radio);
    const double squared = offset.squaredNorm();
    if (!(camera > 0.0 && side < camera + extra) && !(squared < radio * radio)) continue;
    // Whatever stands between a and somebody in its reach is in its reach.
    if (!few && a != asked) boxes = boxes_.Near(asked = a, positions[a]);
    const bool clear = !occluders.BoxBetween(boxes, positions[a], positions[b]);
    const double distance = clear ? std::sqrt(squared) : 0.0;
    neighbours_[first_[a] + count_[a]++] = {static_cast<RobotIndex>(b), offset, clear, distance};
    neighbours_[first_[b] + count_[b]++] = {static_cast<RobotIndex>(a), -offset, clear, distance};
  }
}

}  // namespace gauntlet::sim
