#include "controllers/common/clusters.h"

#include <algorithm>

namespace gauntlet::controllers {

std::span<const int> Clusters::SizesOf(std::span<const sim::Vec2> robots, const sim::Arena& arena,
                                       double link_range, std::span<const sim::Vec2> obstacles) {
  constexpr int kUnseen = -1;
  members_.assign(robots.size(), kUnseen);
  sizes_.clear();
  for (std::size_t first = 0; first < robots.size(); ++first) {
    if (members_[first] != kUnseen) continue;
    const auto cluster = static_cast<int>(sizes_.size());
    sizes_.push_back(0);
    members_[first] = cluster;
    open_.push_back(first);
    while (!open_.empty()) {
      const sim::Vec2& from = robots[open_.back()];
      open_.pop_back();
      ++sizes_.back();
      for (std::size_t to = 0; to < robots.size(); ++to) {
        if (members_[to] != kUnseen || (robots[to] - from).squaredNorm() >= link_range * link_range) continue;
        if (!arena.LineOfSight(from, robots[to], obstacles)) continue;
        members_[to] = cluster;
        open_.push_back(to);
      }
    }
  }
  return sizes_;
}

int Clusters::Largest() const {
  return static_cast<int>(std::ranges::max_element(sizes_) - sizes_.begin());
}

}  // namespace gauntlet::controllers
