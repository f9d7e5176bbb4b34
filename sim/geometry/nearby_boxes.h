// Which boxes somebody could meet: a short list for each visitor, renewed only after the visitor has moved
// some way, from a grid of cells that know the boxes around them, so that it costs the same in an arena of
// any size.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/geometry/oriented_box.h"

namespace gauntlet::sim {

class NearbyBoxes {
 public:
  // Lists hold every box within `reach` metres of the visitor's centre and some beyond.
  explicit NearbyBoxes(double reach) : reach_(reach) {}

  void AddBox(const OrientedBox& box) { boxes_.push_back(box); }
  // Once all boxes are there. Allocates; Near() does not.
  void SetVisitors(std::size_t visitors);
  // A superset, in the order of AddBox, of the boxes within `reach` of the visitor's `position`.
  std::span<const std::size_t> Near(std::size_t visitor, const Vec2& position);
  const OrientedBox& box(std::size_t index) const { return boxes_[index]; }

 private:
  struct List {
    Vec2 anchor = Vec2::Zero();
    bool valid = false;
    std::size_t size = 0;
  };

  void FillCells();
  int Cell(double coordinate, int axis) const;

  double reach_;
  std::vector<OrientedBox> boxes_;
  Vec2 origin_ = Vec2::Zero();  // of the grid
  double cell_ = 1.0;           // m
  std::array<int, 2> cells_ = {1, 1};
  std::vector<std::vector<std::size_t>>
      in_reach_;  // [cell]: boxes that some place in it may have in its list
  std::vector<List> lists_;
  std::vector<std::size_t> entries_;  // [visitor][boxes_.size()]
};

}  // namespace gauntlet::sim
