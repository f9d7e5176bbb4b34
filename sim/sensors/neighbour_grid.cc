#include "sim/sensors/neighbour_grid.h"

#include <algorithm>
#include <cmath>

#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

NeighbourGrid::NeighbourGrid(double reach, std::size_t robots)
    : reach_(std::max(reach, foot_bot::kRadius)), members_(robots), cell_of_(robots) {
  first_.reserve(kMaxCells * kMaxCells + 1);
  near_.reserve(robots);
}

int NeighbourGrid::Cell(double coordinate, int axis) const {
  const double cell = std::floor((coordinate - origin_[axis]) / cell_);
  return static_cast<int>(std::clamp(cell, 0.0, cells_[static_cast<std::size_t>(axis)] - 1.0));
}

void NeighbourGrid::Update(std::span<const BodyFrame> robots) {
  if (robots.empty()) return;
  Vec2 max = robots[0].position;
  origin_ = max;
  for (const BodyFrame& robot : robots) {
    origin_ = origin_.cwiseMin(robot.position);
    max = max.cwiseMax(robot.position);
  }
  const Vec2 extent = max - origin_;
  cell_ = std::max(reach_, extent.maxCoeff() / (kMaxCells - 1));
  for (int axis = 0; axis < 2; ++axis) {
    cells_[static_cast<std::size_t>(axis)] = static_cast<int>(extent[axis] / cell_) + 1;
  }
  first_.assign(static_cast<std::size_t>(cells_[0] * cells_[1]) + 1, 0);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Vec2& p = robots[i].position;
    cell_of_[i] = static_cast<std::size_t>(Cell(p.y(), 1) * cells_[0] + Cell(p.x(), 0));
    ++first_[cell_of_[i]];
  }
  std::size_t end = 0;
  for (std::size_t& first : first_) first = end += first;
  // Filled from each cell's end, so that first_ ends at its beginning and indices increase.
  for (std::size_t i = robots.size(); i-- > 0;) members_[--first_[cell_of_[i]]] = i;
}

std::span<const std::size_t> NeighbourGrid::Near(const Vec2& point) {
  near_.clear();
  const int left = Cell(point.x() - reach_, 0);
  const int right = Cell(point.x() + reach_, 0);
  for (int row = Cell(point.y() - reach_, 1); row <= Cell(point.y() + reach_, 1); ++row) {
    const std::size_t begin = first_[static_cast<std::size_t>(row * cells_[0] + left)];
    const std::size_t end = first_[static_cast<std::size_t>(row * cells_[0] + right) + 1];
    near_.insert(near_.end(), members_.begin() + static_cast<std::ptrdiff_t>(begin),
                 members_.begin() + static_cast<std::ptrdiff_t>(end));
  }
  std::sort(near_.begin(), near_.end());
  return near_;
}

}  // namespace gauntlet::sim
