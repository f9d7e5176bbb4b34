#include "controllers/command/requirements.h"

#include <algorithm>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers::command {
namespace {

std::vector<sim::RoundedBox> BoxesOf(const std::vector<Shape>& shapes) {
  std::vector<sim::RoundedBox> boxes;
  for (const Shape& shape : shapes) {
    const sim::Vec2 center(shape.x, shape.y);
    if (shape.radius > 0.0) {
      boxes.push_back({{center, sim::Vec2::Zero()}, shape.radius});
    } else {
      boxes.push_back({BoxOf(sim::ObstacleGene{shape.x, shape.y, shape.length, shape.width, shape.degrees})});
    }
  }
  return boxes;
}

}  // namespace

sim::ArenaRequirements RequirementsOf(const Definition& definition) {
  sim::ArenaRequirements asked;
  asked.inflation = definition.robot_radius;
  asked.keep_outs = BoxesOf(definition.keep_outs);
  asked.standing = BoxesOf(definition.standing);
  asked.least_side = kLeastArenaSide;
  asked.anywhere = true;
  asked.asks_for_path = !definition.points.empty();
  if (!asked.asks_for_path) return asked;
  asked.cell_size = std::min(sim::OccupancyGrid::kCellSize, definition.robot_radius / 2.0);
  const auto place = [](const Point& point) { return sim::Vec2(point.x, point.y); };
  asked.start = place(definition.points.front());
  // A single point is its own goal: it only has to be free.
  asked.goal = place(definition.points[definition.points.size() > 1 ? 1 : 0]);
  for (std::size_t i = 2; i < definition.points.size(); ++i)
    asked.further_goals.push_back(place(definition.points[i]));
  return asked;
}

}  // namespace gauntlet::controllers::command
