#include "controllers/common/stillness.h"

namespace gauntlet::controllers {

bool KeptWithin(const sim::Observer& observer, sim::RobotIndex robot, sim::Tick window, double radius) {
  const sim::Tick last = observer.last_tick();
  const sim::Tick first = last - window;
  const auto index = static_cast<std::size_t>(robot);
  if (first < 0) return false;
  sim::Vec2 sum = sim::Vec2::Zero();
  for (sim::Tick tick = first; tick <= last; ++tick) sum += observer.At(tick)[index].position();
  const sim::Vec2 center = sum / static_cast<double>(last - first + 1);
  for (sim::Tick tick = first; tick <= last; ++tick) {
    const sim::Vec2 offset = observer.At(tick)[index].position() - center;
    if (offset.squaredNorm() > radius * radius) return false;
  }
  return true;
}

}  // namespace gauntlet::controllers
