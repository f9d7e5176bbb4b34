#include "controllers/aggregation/aggregation_metrics.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers::aggregation {

sim::Vec2 Centroid(std::span<const sim::Vec2> robots) {
  sim::Vec2 sum = sim::Vec2::Zero();
  for (const sim::Vec2& robot : robots) sum += robot;
  return sum / static_cast<double>(robots.size());
}

double Dispersion(std::span<const sim::Vec2> robots) {
  if (robots.empty()) return 0.0;
  const sim::Vec2 center = Centroid(robots);
  double sum = 0.0;
  for (const sim::Vec2& robot : robots) sum += (robot - center).squaredNorm();
  return sum / (4.0 * sim::foot_bot::kRadius * sim::foot_bot::kRadius);
}

double TotalDistance(std::span<const sim::Vec2> robots) {
  double sum = 0.0;
  for (std::size_t a = 0; a < robots.size(); ++a) {
    for (std::size_t b = a + 1; b < robots.size(); ++b)
      sum += std::sqrt((robots[a] - robots[b]).squaredNorm());
  }
  return sum;
}

double ExpectedClusterSize(std::span<const int> sizes) {
  double robots = 0.0;
  double squares = 0.0;
  for (const int size : sizes) {
    robots += size;
    squares += static_cast<double>(size) * size;
  }
  return robots > 0.0 ? squares / robots : 0.0;
}

double Groups::Share(int cluster) const {
  if (cluster < 0) return 0.0;
  return static_cast<double>(sizes[static_cast<std::size_t>(cluster)]) / static_cast<double>(members.size());
}

std::vector<sim::Vec2> Groups::Robots(int cluster, std::span<const sim::Vec2> positions) const {
  std::vector<sim::Vec2> robots;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i] == cluster) robots.push_back(positions[i]);
  }
  return robots;
}

Groups FindGroups(Clusters& clusters, std::span<const sim::Vec2> robots, const sim::Arena& arena,
                  double link_range, std::span<const sim::Vec2> obstacles) {
  Groups groups;
  const auto sizes = clusters.SizesOf(robots, arena, link_range, obstacles);
  groups.sizes.assign(sizes.begin(), sizes.end());
  groups.members.assign(clusters.members().begin(), clusters.members().end());
  groups.first = clusters.Largest();
  for (int i = 0; i < static_cast<int>(sizes.size()); ++i) {
    if (i != groups.first && groups.Share(i) > groups.Share(groups.second)) groups.second = i;
  }
  return groups;
}

bool InSight(std::span<const sim::Vec2> group, std::span<const sim::Vec2> other, const sim::Arena& arena,
             double range, std::span<const sim::Vec2> obstacles) {
  return std::ranges::any_of(group, [&](const sim::Vec2& a) {
    return std::ranges::any_of(other, [&](const sim::Vec2& b) {
      return (a - b).squaredNorm() <= range * range && arena.LineOfSight(a, b, obstacles);
    });
  });
}

}  // namespace gauntlet::controllers::aggregation
