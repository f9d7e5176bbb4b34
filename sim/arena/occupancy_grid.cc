#include "sim/arena/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "base/check.h"

namespace gauntlet::sim {
namespace {

constexpr std::size_t kNoRun = std::numeric_limits<std::size_t>::max();

int CellsAcross(double metres, double cell_size) {
  // 6.0 / 0.05 is 120 up to rounding; a part of a cell counts as one.
  return static_cast<int>(std::ceil(metres / cell_size - 1e-9));
}

// Index of the cell that holds `offset` metres from the grid's edge; -1 or `count` outside, also for numbers
// that no int can hold.
int CellIndex(double offset, double cell_size, int count) {
  const double index = std::floor(offset / cell_size);
  if (!(index >= 0.0)) return -1;
  return index < count ? static_cast<int>(index) : count;
}

// The free cells as maximal horizontal runs, and which of them hang together.
class FreeRuns {
 public:
  FreeRuns(const std::vector<std::uint8_t>& blocked, int columns, int rows) {
    runs_.reserve(static_cast<std::size_t>(rows) * 6);
    row_begin_.reserve(static_cast<std::size_t>(rows) + 1);
    const auto width = static_cast<std::size_t>(columns);
    for (int row = 0; row < rows; ++row) {
      row_begin_.push_back(runs_.size());
      const std::uint8_t* cells = blocked.data() + static_cast<std::size_t>(row) * width;
      for (std::size_t begin = NextValue(cells, 0, width, 0); begin < width;) {
        const std::size_t end = NextValue(cells, begin, width, 1);
        runs_.push_back({begin, end, runs_.size()});
        begin = NextValue(cells, end, width, 0);
      }
      if (row > 0) JoinLastTwoRows();
    }
    row_begin_.push_back(runs_.size());
  }

  // kNoRun when the cell is blocked.
  std::size_t ComponentOf(Cell cell) {
    const auto column = static_cast<std::size_t>(cell.column);
    const auto row = static_cast<std::size_t>(cell.row);
    for (std::size_t i = row_begin_[row]; i < row_begin_[row + 1]; ++i) {
      if (runs_[i].begin <= column && column < runs_[i].end) return Root(i);
    }
    return kNoRun;
  }

  // Sets the cells of the component to 1.
  void Mark(std::size_t component, std::size_t columns, std::vector<std::uint8_t>& marks) {
    for (std::size_t row = 0; row + 1 < row_begin_.size(); ++row) {
      for (std::size_t i = row_begin_[row]; i < row_begin_[row + 1]; ++i) {
        if (Root(i) != component) continue;
        std::memset(marks.data() + row * columns + runs_[i].begin, 1, runs_[i].end - runs_[i].begin);
      }
    }
  }

 private:
  struct Run {
    std::size_t begin;  // first column
    std::size_t end;    // one past the last column
    std::size_t parent;
  };

  static std::size_t NextValue(const std::uint8_t* cells, std::size_t from, std::size_t width, int value) {
    const void* found = std::memchr(cells + from, value, width - from);
    return found == nullptr ? width
                            : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - cells);
  }

  std::size_t Root(std::size_t run) {
    while (runs_[run].parent != run) {
      runs_[run].parent = runs_[runs_[run].parent].parent;
      run = runs_[run].parent;
    }
    return run;
  }

  // Joins every run of the newest row with the runs of the row before that share a column with it.
  void JoinLastTwoRows() {
    const std::size_t above_begin = row_begin_.back();
    std::size_t below = row_begin_[row_begin_.size() - 2];
    for (std::size_t above = above_begin; above < runs_.size();) {
      if (below == above_begin) return;
      if (runs_[below].end <= runs_[above].begin) {
        ++below;
      } else if (runs_[above].end <= runs_[below].begin) {
        ++above;
      } else {
        runs_[Root(above)].parent = Root(below);
        // The one that ends first can share no further column.
        if (runs_[below].end < runs_[above].end) {
          ++below;
        } else {
          ++above;
        }
      }
    }
  }

  std::vector<Run> runs_;
  std::vector<std::size_t> row_begin_;
};

}  // namespace

OccupancyGrid::OccupancyGrid(const Arena& arena, double inflation, double cell_size)
    : interior_min_(arena.interior_min()),
      interior_max_(arena.interior_max()),
      inflation_(inflation),
      cell_size_(cell_size),
      columns_(CellsAcross(arena.walls()[2].center.x() - arena.walls()[3].center.x(), cell_size)),
      rows_(CellsAcross(arena.walls()[0].center.y() - arena.walls()[1].center.y(), cell_size)),
      origin_(arena.walls()[3].center.x(), arena.walls()[1].center.y()),
      blocked_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {
  GAUNTLET_CHECK(inflation >= 0.0 && std::isfinite(inflation), "inflation " + std::to_string(inflation));
  GAUNTLET_CHECK(cell_size > 0.0, "cells of " + std::to_string(cell_size) + " m");
  BlockWalls();
  for (const OrientedBox& box : arena.obstacles()) AddObstacle(box);
}

void OccupancyGrid::BlockWalls() {
  for (int row = 0; row < rows_; ++row) {
    const double y = CenterOf({0, row}).y();
    const bool free = y - interior_min_.y() >= inflation_ && interior_max_.y() - y >= inflation_;
    if (!free) std::fill_n(blocked_.begin() + row * columns_, columns_, std::uint8_t{1});
  }
  for (int column = 0; column < columns_; ++column) {
    const double x = CenterOf({column, 0}).x();
    if (x - interior_min_.x() >= inflation_ && interior_max_.x() - x >= inflation_) continue;
    for (int row = 0; row < rows_; ++row) blocked_[Index({column, row})] = 1;
  }
}

void OccupancyGrid::AddObstacle(const RoundedBox& shape) {
  const OrientedBox& box = shape.box;
  const double inflation = inflation_ + shape.radius;
  obstacles_.push_back(shape);
  // One cell more on every side, so that rounding here cannot leave out a cell that the distance includes.
  const double reach = inflation + cell_size_;
  const Vec2 half = BoundingHalfExtents(box) + Vec2(reach, reach);
  const Cell first = CellAt(box.center - half);
  const Cell last = CellAt(box.center + half);
  const int column_begin = std::max(first.column, 0);
  const int column_end = std::min(last.column + 1, columns_);
  const int row_begin = std::max(first.row, 0);
  const int row_end = std::min(last.row + 1, rows_);
  const double squared_inflation = inflation * inflation;
  for (int row = row_begin; row < row_end; ++row) {
    for (int column = column_begin; column < column_end; ++column) {
      const double squared_distance = SquaredDistance(box, CenterOf({column, row}));
      // Without inflation, what the box covers is blocked all the same.
      const bool hit = squared_distance < squared_inflation || squared_distance == 0.0;
      blocked_[Index({column, row})] |= static_cast<std::uint8_t>(hit);
    }
  }
}

Cell OccupancyGrid::CellAt(const Vec2& p) const {
  return {CellIndex(p.x() - origin_.x(), cell_size_, columns_),
          CellIndex(p.y() - origin_.y(), cell_size_, rows_)};
}

double OccupancyGrid::Clearance(const Vec2& p) const {
  double clearance = std::min(std::min(p.x() - interior_min_.x(), interior_max_.x() - p.x()),
                              std::min(p.y() - interior_min_.y(), interior_max_.y() - p.y()));
  for (const RoundedBox& one : obstacles_) clearance = std::min(clearance, Distance(one.box, p) - one.radius);
  return clearance;
}

bool OccupancyGrid::Connected(Cell a, Cell b) const {
  if (!Free(a) || !Free(b)) return false;
  FreeRuns runs(blocked_, columns_, rows_);
  return runs.ComponentOf(a) == runs.ComponentOf(b);
}

std::vector<std::uint8_t> OccupancyGrid::Reachable(Cell start) const {
  std::vector<std::uint8_t> marks(blocked_.size(), 0);
  if (!Free(start)) return marks;
  FreeRuns runs(blocked_, columns_, rows_);
  runs.Mark(runs.ComponentOf(start), static_cast<std::size_t>(columns_), marks);
  return marks;
}

}  // namespace gauntlet::sim
