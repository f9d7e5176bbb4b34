#include "sim/geometry/oriented_box.h"

namespace gauntlet::sim {

std::array<Vec2, 4> Corners(const OrientedBox& box) {
  const Vec2 along = box.half_extents.x() * box.axis;
  const Vec2 across = box.half_extents.y() * LeftOf(box.axis);
  return {box.center - along - across, box.center + along - across, box.center + along + across,
          box.center - along + across};
}

bool Contains(const OrientedBox& box, const Vec2& p) {
  const Vec2 local = ToLocal(box, p);
  return std::fabs(local.x()) <= box.half_extents.x() + kContainsTolerance &&
         std::fabs(local.y()) <= box.half_extents.y() + kContainsTolerance;
}

bool ContainsBox(const OrientedBox& outer, const OrientedBox& inner) {
  for (const Vec2& corner : Corners(inner)) {
    if (!Contains(outer, corner)) return false;
  }
  return true;
}

double Distance(const OrientedBox& box, const Vec2& p) {
  return std::sqrt(SquaredDistance(box, p));
}

}  // namespace gauntlet::sim
