// Finds the robots near a point without asking all of them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/sensors/body_frame.h"

namespace gauntlet::sim {

class NeighbourGrid {
 public:
  // For up to `robots` robots and searches within `reach` metres.
  NeighbourGrid(double reach, std::size_t robots);

  // Sorts the robots into cells. Allocates nothing.
  void Update(std::span<const BodyFrame> robots);
  // Indices, in increasing order, of a superset of the robots within the reach of `point`. Valid until the
  // next call.
  std::span<const std::size_t> Near(const Vec2& point);

 private:
  static constexpr int kMaxCells = 128;  // per axis

  int Cell(double coordinate, int axis) const;

  double reach_;
  double cell_ = 1.0;  // m, at least reach_
  Vec2 origin_ = Vec2::Zero();
  std::array<int, 2> cells_{1, 1};
  std::vector<std::size_t> first_;    // [cell], where its robots begin in members_
  std::vector<std::size_t> members_;  // by cell, then by index
  std::vector<std::size_t> cell_of_;
  std::vector<std::size_t> near_;
};

}  // namespace gauntlet::sim
