#include "controllers/examples/light_flocking_metrics.h"

#include <cmath>

#include "controllers/common/clusters.h"

namespace gauntlet::controllers::light_flocking {

double MeanDistance(std::span<const sim::Vec2> robots, const sim::Vec2& point) {
  if (robots.empty()) return 0.0;
  double sum = 0.0;
  for (const sim::Vec2& robot : robots) sum += std::sqrt((robot - point).squaredNorm());
  return sum / static_cast<double>(robots.size());
}

int CountClusters(std::span<const sim::Vec2> robots, const sim::Arena& arena, double link_range,
                  std::span<const sim::Vec2> obstacles) {
  return static_cast<int>(Clusters().SizesOf(robots, arena, link_range, obstacles).size());
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
