#include "sim/physics/nearby_boxes.h"

namespace gauntlet::sim {
namespace {

// How far a robot may move before its list is renewed, m: about two seconds of driving.
constexpr double kSlack = 0.2;

}  // namespace

void NearbyBoxes::AddBox(const OrientedBox& box) {
  boxes_.push_back(box);
  SetRobots(static_cast<int>(lists_.size()));
}

void NearbyBoxes::SetRobots(int robots) {
  lists_.assign(static_cast<std::size_t>(robots), List{});
  entries_.assign(static_cast<std::size_t>(robots) * boxes_.size(), 0);
}

std::span<const std::size_t> NearbyBoxes::Near(RobotIndex robot, const Vec2& position) {
  List& list = lists_[static_cast<std::size_t>(robot)];
  const std::span<std::size_t> entries =
      std::span(entries_).subspan(static_cast<std::size_t>(robot) * boxes_.size(), boxes_.size());
  if (!list.valid || (position - list.anchor).squaredNorm() > kSlack * kSlack) {
    list = {.anchor = position, .valid = true, .size = 0};
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (Distance(boxes_[i], position) <= reach_ + kSlack) entries[list.size++] = i;
    }
  }
  return entries.first(list.size);
}

}  // namespace gauntlet::sim
