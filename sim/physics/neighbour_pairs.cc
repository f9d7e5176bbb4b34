#include "sim/physics/neighbour_pairs.h"

#include <algorithm>

namespace gauntlet::sim {
namespace {

// How much more than asked for is listed, m: two robots that drive at each other use it up in 0.5 s.
constexpr double kSlack = 0.1;
// Discs of a foot-bot's size that touch nobody else than neighbours in the listed reach: about 40. Twice that
// is room for crowds that overlap.
constexpr std::size_t kPairsPerRobot = 40;

}  // namespace

void NeighbourPairs::SetRobots(std::size_t robots) {
  listed_reach_ = -1.0;
  anchors_.resize(robots);
  by_x_.resize(robots);
  for (std::size_t i = 0; i < robots; ++i) by_x_[i] = i;
  pairs_.reserve(robots == 0 ? 0 : std::min(robots * (robots - 1) / 2, kPairsPerRobot * robots));
}

bool NeighbourPairs::StillHolds(std::span<const Vec2> positions, double reach) const {
  const double room = (listed_reach_ - reach) / 2.0;
  if (room < 0.0) return false;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if ((positions[i] - anchors_[i]).squaredNorm() > room * room) return false;
  }
  return true;
}

std::span<const NeighbourPairs::Pair> NeighbourPairs::Find(std::span<const Vec2> positions, double reach) {
  if (StillHolds(positions, reach)) return pairs_;
  listed_reach_ = reach + kSlack;
  std::ranges::copy(positions, anchors_.begin());
  // Robots keep their order along x from one list to the next but for a few.
  for (std::size_t k = 1; k < by_x_.size(); ++k) {
    const std::size_t robot = by_x_[k];
    std::size_t place = k;
    for (; place > 0 && anchors_[by_x_[place - 1]].x() > anchors_[robot].x(); --place)
      by_x_[place] = by_x_[place - 1];
    by_x_[place] = robot;
  }
  pairs_.clear();
  for (std::size_t k = 0; k < by_x_.size(); ++k) {
    const std::size_t i = by_x_[k];
    for (std::size_t l = k + 1; l < by_x_.size(); ++l) {
      const std::size_t j = by_x_[l];
      const Vec2 apart = anchors_[j] - anchors_[i];
      if (apart.x() >= listed_reach_) break;
      if (apart.squaredNorm() < listed_reach_ * listed_reach_)
        pairs_.push_back({std::min(i, j), std::max(i, j)});
    }
  }
  std::ranges::sort(pairs_);
  return pairs_;
}

}  // namespace gauntlet::sim
