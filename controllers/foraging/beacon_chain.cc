#include "controllers/foraging/beacon_chain.h"

#include <algorithm>

namespace gauntlet::controllers {

std::vector<sim::Vec2> FindBeaconChain(const sim::Arena& arena, const ChainEnds& ends,
                                       std::span<const sim::Vec2> beacons, double range,
                                       std::span<const sim::Vec2> obstacles) {
  constexpr int kUnseen = -2;
  constexpr int kNest = -1;
  const auto linked = [&](const sim::Vec2& a, const sim::Vec2& b) {
    return (b - a).squaredNorm() < range * range && arena.LineOfSight(a, b, obstacles);
  };
  std::vector<int> previous(beacons.size(), kUnseen);
  std::vector<std::size_t> open;  // breadth first
  for (std::size_t i = 0; i < beacons.size(); ++i) {
    if (!linked(ends.nest, beacons[i])) continue;
    previous[i] = kNest;
    open.push_back(i);
  }
  for (std::size_t next = 0; next < open.size(); ++next) {
    const std::size_t current = open[next];
    if (linked(beacons[current], ends.food)) {
      std::vector<sim::Vec2> chain = {ends.food};
      for (int i = static_cast<int>(current); i != kNest; i = previous[static_cast<std::size_t>(i)]) {
        chain.push_back(beacons[static_cast<std::size_t>(i)]);
      }
      chain.push_back(ends.nest);
      std::reverse(chain.begin(), chain.end());
      return chain;
    }
    for (std::size_t i = 0; i < beacons.size(); ++i) {
      if (previous[i] != kUnseen || !linked(beacons[current], beacons[i])) continue;
      previous[i] = static_cast<int>(current);
      open.push_back(i);
    }
  }
  return {};
}

}  // namespace gauntlet::controllers
