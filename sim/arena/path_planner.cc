#include "sim/arena/path_planner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace gauntlet::sim {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

class ThetaStar {
 public:
  ThetaStar(const OccupancyGrid& grid, const Vec2& start, const Vec2& goal)
      : grid_(grid),
        start_point_(start),
        goal_point_(goal),
        start_(grid.Index(grid.CellAt(start))),
        goal_(grid.Index(grid.CellAt(goal))),
        nodes_(static_cast<std::size_t>(grid.columns()) * static_cast<std::size_t>(grid.rows())) {}

  // Requires that both ends are connected.
  std::vector<Vec2> Search() {
    nodes_[start_].length = 0.0;
    nodes_[start_].parent = start_;
    Push(start_, start_point_);
    while (!open_.empty()) {
      const std::size_t node = open_.top().second;
      open_.pop();
      if (node == goal_) return Waypoints();
      if (nodes_[node].closed) continue;  // an entry from before the node was improved
      nodes_[node].closed = true;
      Expand(node);
    }
    return {};
  }

 private:
  struct Node {
    double length = std::numeric_limits<double>::infinity();  // m, of the best known path from the start
    std::size_t parent = kNone;
    bool closed = false;
  };

  Cell CellOf(std::size_t node) const {
    // The largest grid has fewer than 2^22 cells, and dividing 32 bits is several times faster than 64.
    const auto columns = static_cast<std::uint32_t>(grid_.columns());
    const auto index = static_cast<std::uint32_t>(node);
    return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
  }

  // The ends stand at their exact points, every other node at its cell's centre.
  Vec2 PointOf(std::size_t node, Cell cell) const {
    if (node == start_) return start_point_;
    if (node == goal_) return goal_point_;
    return grid_.CenterOf(cell);
  }

  void Push(std::size_t node, const Vec2& point) {
    open_.emplace(nodes_[node].length + (goal_point_ - point).norm(), node);
  }

  void Expand(std::size_t node) {
    const Cell cell = CellOf(node);
    const std::size_t parent = nodes_[node].parent;
    const Vec2 point = PointOf(node, cell);
    const Vec2 parent_point = PointOf(parent, CellOf(parent));
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell next = {cell.column + dx, cell.row + dy};
        if ((dx == 0 && dy == 0) || !grid_.Free(next)) continue;
        const bool cuts_corner =
            dx != 0 && dy != 0 &&
            !(grid_.Free({next.column, cell.row}) && grid_.Free({cell.column, next.row}));
        if (cuts_corner) continue;
        Relax(node, point, parent, parent_point, next);
      }
    }
  }

  void Relax(std::size_t node, const Vec2& point, std::size_t parent, const Vec2& parent_point, Cell next) {
    const std::size_t successor = grid_.Index(next);
    Node& target = nodes_[successor];
    if (target.closed) return;
    const Vec2 next_point = PointOf(successor, next);
    // Straight from the parent is never longer than by way of the node (triangle inequality): where even that
    // is no improvement, the costly line of sight need not be looked at.
    const double straight = nodes_[parent].length + (next_point - parent_point).norm();
    if (!(straight < target.length)) return;
    if (PathIsFree(grid_, parent_point, next_point)) {
      target.length = straight;
      target.parent = parent;
    } else {
      const double by_way_of_node = nodes_[node].length + (next_point - point).norm();
      if (!(by_way_of_node < target.length)) return;
      target.length = by_way_of_node;
      target.parent = node;
    }
    Push(successor, next_point);
  }

  std::vector<Vec2> Waypoints() const {
    std::vector<Vec2> waypoints = {goal_point_};
    for (std::size_t node = goal_; node != start_; node = nodes_[node].parent) {
      const std::size_t parent = nodes_[node].parent;
      waypoints.push_back(PointOf(parent, CellOf(parent)));
    }
    std::reverse(waypoints.begin(), waypoints.end());
    return waypoints;
  }

  const OccupancyGrid& grid_;
  Vec2 start_point_;
  Vec2 goal_point_;
  std::size_t start_;
  std::size_t goal_;
  std::vector<Node> nodes_;
  // Cells by the length of the whole path through them, m: the least on top, the lower index among equals.
  using Open = std::pair<double, std::size_t>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

}  // namespace

bool PathIsFree(const OccupancyGrid& grid, const Vec2& a, const Vec2& b) {
  if (!grid.Free(grid.CellAt(a)) || !grid.Free(grid.CellAt(b))) return false;
  const double apart = std::min(kPathSampleDistance, kPathSampleCells * grid.cell_size());
  const int steps = static_cast<int>(std::ceil((b - a).norm() / apart));
  if (steps == 0) return true;
  // Coordinates in units of cells with 32 binary places: exact sums, and shifting gives the index. All
  // samples lie between two points of the grid, so none needs a check against its edges.
  constexpr double kOne = 4294967296.0;
  const Vec2 from = (a - grid.origin()) / grid.cell_size() * kOne;
  const Vec2 step = (b - a) / grid.cell_size() * (kOne / steps);
  auto x = static_cast<std::int64_t>(from.x());
  auto y = static_cast<std::int64_t>(from.y());
  const auto step_x = static_cast<std::int64_t>(step.x());
  const auto step_y = static_cast<std::int64_t>(step.y());
  const std::int64_t columns = grid.columns();
  const std::uint8_t* blocked = grid.blocked().data();
  for (int i = 1; i < steps; ++i) {
    x += step_x;
    y += step_y;
    if (blocked[(y >> 32) * columns + (x >> 32)] != 0) return false;
  }
  return true;
}

std::vector<Vec2> PlanPath(const OccupancyGrid& grid, const Vec2& start, const Vec2& goal) {
  const Cell start_cell = grid.CellAt(start);
  const Cell goal_cell = grid.CellAt(goal);
  // Moving diagonally without cutting corners reaches exactly what moving along the axes reaches.
  if (!grid.Connected(start_cell, goal_cell)) return {};
  if (start_cell == goal_cell) return {start, goal};
  return ThetaStar(grid, start, goal).Search();
}

}  // namespace gauntlet::sim
