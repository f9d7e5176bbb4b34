#include "controllers/common/clusters.h"

namespace gauntlet::controllers {

std::span<const int> Clusters::SizesOf(std::span<const sim::Vec2> robots, const sim::Arena& arena,
                                       double link_range, std::span<const sim::Vec2> obstacles) {
  seen_.assign(robots.size(), false);
  sizes_.clear();
  for (std::size_t first = 0; first < robots.size(); ++first) {
    if (seen_[first]) continue;
    sizes_.push_back(0);
    seen_[first] = true;
    open_.push_back(first);
    while (!open_.empty()) {
      const sim::Vec2& from = robots[open_.back()];
      open_.pop_back();
      ++sizes_.back();
      for (std::size_t to = 0; to < robots.size(); ++to) {
        if (seen_[to] || (robots[to] - from).squaredNorm() >= link_range * link_range) continue;
        if (!arena.LineOfSight(from, robots[to], obstacles)) continue;
        seen_[to] = true;
        open_.push_back(to);
      }
    }
  }
  return sizes_;
}

}  // namespace gauntlet::controllers
