// The arena as cells, by default of 0.05 m, that a robot's centre may or may not be in (obstacles are
// inflated, by default by 0.10 m), with the connected components of the free cells.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/arena/arena.h"

namespace gauntlet::sim {

struct Cell {
  int column = 0;  // along x
  int row = 0;     // along y
  bool operator==(const Cell&) const = default;
};

// Const functions may be called from several threads at once.
class OccupancyGrid {
 public:
  static constexpr double kCellSize = 0.05;          // m
  static constexpr double kDefaultInflation = 0.10;  // m: body 0.085 + 0.015 margin

  // A cell is blocked when its centre is less than `inflation` metres from an obstacle or a wall's inner
  // face, or beyond the wall. The grid spans the walls' centre lines; inflation >= 0, cell_size (m) > 0.
  OccupancyGrid(const Arena& arena, double inflation, double cell_size = kCellSize);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double inflation() const { return inflation_; }
  double cell_size() const { return cell_size_; }
  // Adds one more obstacle, as after a gene was appended. Blocked cells only grow. Touches only the cells
  // near the box.
  void AddObstacle(const OrientedBox& box) { AddObstacle(RoundedBox{box}); }
  void AddObstacle(const RoundedBox& shape);

  bool InGrid(Cell cell) const {
    return cell.column >= 0 && cell.row >= 0 && cell.column < columns_ && cell.row < rows_;
  }
  bool Free(Cell cell) const { return InGrid(cell) && blocked_[Index(cell)] == 0; }
  // Row-major, columns() * rows(): 1 = blocked.
  const std::vector<std::uint8_t>& blocked() const { return blocked_; }
  Vec2 CenterOf(Cell cell) const {
    return {origin_.x() + (cell.column + 0.5) * cell_size_, origin_.y() + (cell.row + 0.5) * cell_size_};
  }
  // The lower left corner of cell (0, 0), m.
  const Vec2& origin() const { return origin_; }
  // May lie outside the grid.
  Cell CellAt(const Vec2& p) const;
  // Distance from p to the nearest obstacle or inner face of a wall, m; not of cells but exact. 0 or less
  // inside them.
  double Clearance(const Vec2& p) const;

  // Whether two free cells are 4-connected through free cells.
  bool Connected(Cell a, Cell b) const;
  // 1 for every cell 4-connected to `start` (row-major, columns() * rows()), 0 elsewhere; all 0 when `start`
  // is blocked.
  std::vector<std::uint8_t> Reachable(Cell start) const;
  std::size_t Index(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(cell.column);
  }

 private:
  void BlockWalls();

  Vec2 interior_min_;
  Vec2 interior_max_;
  double inflation_;
  double cell_size_;
  int columns_;
  int rows_;
  Vec2 origin_;
  std::vector<RoundedBox> obstacles_;
  std::vector<std::uint8_t> blocked_;  // row-major, 0 or 1
};

}  // namespace gauntlet::sim
