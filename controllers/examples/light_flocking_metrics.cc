#include "controllers/examples/light_flocking_metrics.h"

#include <cmath>

namespace gauntlet::controllers::light_flocking {

double MeanDistance(std::span<const sim::Vec2> robots, const sim::Vec2& point) {
  if (robots.empty()) return 0.0;
  double sum = 0.0;
  for (const sim::Vec2& robot : robots) sum += std::sqrt((robot - point).squaredNorm());
  return sum / static_cast<double>(robots.size());
}

int CountClusters(std::span<const sim::Vec2> robots, const sim::Arena& arena, double link_range,
                  std::span<const sim::Vec2> obstacles) {
  std::vector<bool> seen(robots.size(), false);
  std::vector<std::size_t> open;
  int clusters = 0;
  for (std::size_t first = 0; first < robots.size(); ++first) {
    if (seen[first]) continue;
    ++clusters;
    seen[first] = true;
    open.push_back(first);
    while (!open.empty()) {
      const sim::Vec2& from = robots[open.back()];
      open.pop_back();
      for (std::size_t to = 0; to < robots.size(); ++to) {
        if (seen[to] || (robots[to] - from).squaredNorm() >= link_range * link_range) continue;
        if (!arena.LineOfSight(from, robots[to], obstacles)) continue;
        seen[to] = true;
        open.push_back(to);
      }
    }
  }
  return clusters;
}

double ShareStopped(const std::vector<std::vector<sim::Vec2>>& samples, double threshold) {
  if (samples.empty() || samples.front().empty()) return 0.0;
  const std::size_t robots = samples.front().size();
  std::size_t stopped = 0;
  for (std::size_t robot = 0; robot < robots; ++robot) {
    bool moved = false;
    for (const std::vector<sim::Vec2>& sample : samples) {
      moved = moved || (sample[robot] - samples.front()[robot]).squaredNorm() >= threshold * threshold;
    }
    if (!moved) ++stopped;
  }
  return static_cast<double>(stopped) / static_cast<double>(robots);
}

}  // namespace gauntlet::controllers::light_flocking
