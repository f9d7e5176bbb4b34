#include "sim/geometry/neighbour_pairs.h"

#include <algorithm>
#include <numeric>

namespace gauntlet::sim {
namespace {

// Discs of a foot-bot's size that touch nobody else than neighbours within 0.4 m: about 40. Twice that is
// room for crowds that overlap.
constexpr std::size_t kPairsPerPoint = 40;

}  // namespace

bool NeighbourPairs::StillHolds(std::span<const Vec2> positions, double reach) const {
  const double room = (listed_reach_ - reach) / 2.0;
  if (room < 0.0 || positions.size() != anchors_.size()) return false;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if ((positions[i] - anchors_[i]).squaredNorm() > room * room) return false;
  }
  return true;
}

bool NeighbourPairs::Update(std::span<const Vec2> positions, double reach) {
  if (StillHolds(positions, reach)) return false;
  listed_reach_ = reach + slack_;
  if (const std::size_t points = positions.size(); points != by_x_.size()) {
    by_x_.resize(points);
    std::iota(by_x_.begin(), by_x_.end(), std::size_t{0});
    pairs_.reserve(points == 0 ? 0 : std::min(points * (points - 1) / 2, kPairsPerPoint * points));
  }
  anchors_.assign(positions.begin(), positions.end());
  // Points keep their order along x from one list to the next but for a few.
  for (std::size_t k = 1; k < by_x_.size(); ++k) {
    const std::size_t point = by_x_[k];
    std::size_t place = k;
    for (; place > 0 && anchors_[by_x_[place - 1]].x() > anchors_[point].x(); --place)
      by_x_[place] = by_x_[place - 1];
    by_x_[place] = point;
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
  return true;
}

}  // namespace gauntlet::sim
