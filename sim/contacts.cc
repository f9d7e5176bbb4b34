#include "sim/contacts.h"

#include "sim/geometry/oriented_box.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {
namespace {

// Bodies that are no farther apart touch, m: what the physics leaves between two that lean on each other is
// less.
constexpr double kTouchGap = 0.001;
constexpr double kRobotsTouch = 2.0 * foot_bot::kRadius + kTouchGap;
constexpr double kBoxTouches = foot_bot::kRadius + kTouchGap;

}  // namespace

Contacts::Contacts(const Arena& arena, int robots) : moving_(arena.moving().size()) {
  for (const Arena::Moving& moving : arena.moving()) boxes_.push_back(arena.obstacles()[moving.obstacle]);
  boxes_.insert(boxes_.end(), arena.fixed_boxes().begin(), arena.fixed_boxes().end());
  const auto count = static_cast<std::size_t>(robots);
  touching_.assign(count * (count + boxes_.size()), 0);
}

void Contacts::Note(std::size_t pair, bool touches) {
  if (touches && touching_[pair] == 0 && !first_) ++begun_;
  touching_[pair] = touches ? 1 : 0;
}

void Contacts::Add(const Observer& observer) {
  const std::span<const RobotState> robots = observer.Latest();
  const std::span<const Vec2> centers = observer.ObstaclesAt(observer.last_tick());
  for (std::size_t i = 0; i < moving_; ++i) boxes_[i].center = centers[i];
  std::size_t pair = 0;
  for (std::size_t a = 0; a < robots.size(); ++a) {
    for (std::size_t b = a + 1; b < robots.size(); ++b) {
      const double squared = (robots[a].position() - robots[b].position()).squaredNorm();
      Note(pair++, squared <= kRobotsTouch * kRobotsTouch);
    }
    for (const OrientedBox& box : boxes_)
      Note(pair++, SquaredDistance(box, robots[a].position()) <= kBoxTouches * kBoxTouches);
  }
  first_ = false;
}

}  // namespace gauntlet::sim
