#include "sim/geometry/nearby_boxes.h"

#include <algorithm>
#include <cmath>

namespace gauntlet::sim {
namespace {

// How far a visitor may move before its list is renewed, m: about two seconds of driving.
constexpr double kSlack = 0.2;
constexpr double kLeastCell = 1.0;  // m
constexpr int kMostCells = 64;      // per axis
// Up to this many boxes it costs less to ask every box than to keep a grid.
constexpr std::size_t kFewBoxes = 16;

}  // namespace

void NearbyBoxes::SetVisitors(std::size_t visitors) {
  lists_.assign(visitors, List{});
  entries_.assign(visitors * boxes_.size(), 0);
  FillCells();
}

int NearbyBoxes::Cell(double coordinate, int axis) const {
  const double cell = std::floor((coordinate - origin_[axis]) / cell_);
  return static_cast<int>(std::clamp(cell, 0.0, cells_[static_cast<std::size_t>(axis)] - 1.0));
}

void NearbyBoxes::FillCells() {
  cells_ = {1, 1};
  in_reach_.assign(1, {});
  if (boxes_.empty()) return;
  if (boxes_.size() > kFewBoxes) {
    Vec2 max = boxes_[0].center;
    origin_ = max;
    for (const OrientedBox& box : boxes_) {
      origin_ = origin_.cwiseMin(box.center);
      max = max.cwiseMax(box.center);
    }
    const Vec2 extent = max - origin_;
    cell_ = std::max(kLeastCell, extent.maxCoeff() / (kMostCells - 1));
    for (int axis = 0; axis < 2; ++axis) {
      cells_[static_cast<std::size_t>(axis)] = static_cast<int>(extent[axis] / cell_) + 1;
    }
    in_reach_.assign(static_cast<std::size_t>(cells_[0]) * static_cast<std::size_t>(cells_[1]), {});
  }
  // What lies beyond the grid belongs to the nearest cell, boxes and places alike.
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Vec2 half = BoundingHalfExtents(boxes_[i]) + Vec2(reach_ + kSlack, reach_ + kSlack);
    const Vec2 low = boxes_[i].center - half;
    const Vec2 high = boxes_[i].center + half;
    for (int row = Cell(low.y(), 1); row <= Cell(high.y(), 1); ++row) {
      for (int column = Cell(low.x(), 0); column <= Cell(high.x(), 0); ++column) {
        in_reach_[static_cast<std::size_t>(row * cells_[0] + column)].push_back(i);
      }
    }
  }
}

std::span<const std::size_t> NearbyBoxes::Near(std::size_t visitor, const Vec2& position) {
  List& list = lists_[visitor];
  const std::span<std::size_t> entries = std::span(entries_).subspan(visitor * boxes_.size(), boxes_.size());
  if (!list.valid || (position - list.anchor).squaredNorm() > kSlack * kSlack) {
    list = {.anchor = position, .valid = true, .size = 0};
    const double farthest = reach_ + kSlack;
    const std::size_t cell =
        static_cast<std::size_t>(Cell(position.y(), 1) * cells_[0] + Cell(position.x(), 0));
    for (const std::size_t i : in_reach_[cell]) {
      if (SquaredDistance(boxes_[i], position) <= farthest * farthest) entries[list.size++] = i;
    }
  }
  return entries.first(list.size);
}

}  // namespace gauntlet::sim
