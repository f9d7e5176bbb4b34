#include "controllers/common/stillness.h"

namespace gauntlet::controllers {
namespace {

sim::Vec2 MeanPlace(const sim::Observer& observer, sim::RobotIndex robot, sim::Tick window) {
  const sim::Tick last = observer.last_tick();
  sim::Vec2 sum = sim::Vec2::Zero();
  for (sim::Tick tick = last - window; tick <= last; ++tick) {
    sum += observer.At(tick)[static_cast<std::size_t>(robot)].position();
  }
  return sum / static_cast<double>(window + 1);
}

}  // namespace

sim::Tick StillSince(const sim::Observer& observer, sim::RobotIndex robot, sim::Tick window, double radius) {
  const sim::Vec2 center = MeanPlace(observer, robot, window);
  sim::Tick since = observer.last_tick() + 1;
  while (since > 0) {
    const sim::Vec2 offset = observer.At(since - 1)[static_cast<std::size_t>(robot)].position() - center;
    if (offset.squaredNorm() > radius * radius) break;
    --since;
  }
  return since;
}

bool KeptWithin(const sim::Observer& observer, sim::RobotIndex robot, sim::Tick window, double radius) {
  const sim::Tick first = observer.last_tick() - window;
  return first >= 0 && StillSince(observer, robot, window, radius) <= first;
}

}  // namespace gauntlet::controllers
