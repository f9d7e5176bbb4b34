#include "controllers/coverage/coverage_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gauntlet::controllers::coverage {

CoverageMap::CoverageMap(const sim::Arena& arena, const sim::Vec2& start)
    : arena_(arena),
      grid_(arena, sim::OccupancyGrid::kDefaultInflation),
      reachable_(grid_.Reachable(grid_.CellAt(start))) {}

void CoverageMap::See(std::span<const sim::Vec2> robots, double radius, std::span<const sim::Vec2> obstacles,
                      CellMarks& seen) const {
  for (const sim::Vec2& robot : robots) {
    const auto in_reach = [&](const auto& box) {
      return sim::SquaredDistance(box, robot) <= radius * radius;
    };
    const bool may_hide = !obstacles.empty() || std::ranges::any_of(arena_.obstacles(), in_reach);
    const sim::Cell first = grid_.CellAt(robot - sim::Vec2(radius, radius));
    const sim::Cell last = grid_.CellAt(robot + sim::Vec2(radius, radius));
    sim::Cell cell;
    for (cell.row = std::max(first.row, 0); cell.row <= std::min(last.row, grid_.rows() - 1); ++cell.row) {
      for (cell.column = std::max(first.column, 0); cell.column <= std::min(last.column, grid_.columns() - 1);
           ++cell.column) {
        const std::size_t index = grid_.Index(cell);
        if (reachable_[index] == 0 || seen[index] != 0) continue;
        const sim::Vec2 center = grid_.CenterOf(cell);
        if ((center - robot).squaredNorm() > radius * radius) continue;
        if (!may_hide || arena_.LineOfSight(robot, center, obstacles)) seen[index] = 1;
      }
    }
  }
}

double CoverageMap::ShareOf(const CellMarks& seen) const {
  const auto cells = static_cast<double>(std::ranges::count(reachable_, 1));
  return cells == 0.0 ? 0.0 : static_cast<double>(std::ranges::count(seen, 1)) / cells;
}

Hole CoverageMap::LargestHole(const CellMarks& seen) const {
  CellMarks open = reachable_;
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = open[i] != 0 && seen[i] == 0 ? 1 : 0;
  const auto width = static_cast<std::size_t>(grid_.columns());
  Hole largest;
  std::vector<std::size_t> region;
  for (std::size_t first = 0; first < open.size(); ++first) {
    if (open[first] == 0) continue;
    open[first] = 0;
    region.assign(1, first);
    sim::Vec2 sum = sim::Vec2::Zero();
    for (std::size_t i = 0; i < region.size(); ++i) {
      const std::size_t cell = region[i];
      sum += grid_.CenterOf({static_cast<int>(cell % width), static_cast<int>(cell / width)});
      // The walls block the outermost cells, so that all four are in the grid.
      for (const std::size_t next : {cell - width, cell - 1, cell + 1, cell + width}) {
        if (open[next] != 0) region.push_back(next);
        open[next] = 0;
      }
    }
    const auto cells = static_cast<double>(region.size());
    const double area = cells * grid_.cell_size() * grid_.cell_size();
    if (area > largest.area) largest = {area, sum / cells};
  }
  return largest;
}

double NearestNeighbourDistance(std::span<const sim::Vec2> robots) {
  if (robots.size() < 2) return 0.0;
  double sum = 0.0;
  for (const sim::Vec2& robot : robots) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const sim::Vec2& other : robots) {
      if (&other != &robot) nearest = std::min(nearest, (other - robot).squaredNorm());
    }
    sum += std::sqrt(nearest);
  }
  return sum / static_cast<double>(robots.size());
}

}  // namespace gauntlet::controllers::coverage
