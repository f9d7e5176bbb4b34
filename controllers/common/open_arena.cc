#include "controllers/common/open_arena.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "controllers/common/nest_and_food.h"  // StillSince
#include "sim/arena/spawn.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::controllers {

sim::ArenaRequirements OpenArena::Requirements(const sim::TestCase& test_case) const {
  const sim::Vec2 start(test_case.side_x / 2.0 - corner_distance, test_case.side_y / 2.0 - corner_distance);
  return {.start = start, .goal = -start, .open_share = open_share};
}

Result<std::vector<sim::Pose>> StartPoses(const sim::TestCase& test_case, int robots,
                                          const sim::Rectangle& area, const sim::Vec2& start,
                                          std::uint64_t seed) {
  if (!test_case.start_poses.empty()) return test_case.start_poses;
  const int count = test_case.robots.value_or(robots);
  if (count < 1 || count > sim::kMaxRobots) {
    return InvalidInput("swarm-size: " + std::to_string(count) + " robots; from 1 to " +
                        std::to_string(sim::kMaxRobots) + " can be tested");
  }
  const sim::SpawnRequest request = {.count = count,
                                     .area = test_case.spawn_area.value_or(area),
                                     .robot_radius = sim::foot_bot::kRadius,
                                     .start = start};
  return sim::Spawn(request, sim::Arena(test_case), seed);
}

std::vector<sim::Vec2> PositionsAt(const sim::Observer& observer, sim::Tick tick) {
  std::vector<sim::Vec2> positions;
  for (const sim::RobotState& state : observer.At(tick)) positions.push_back(state.position());
  return positions;
}

std::vector<sim::Tick> LastSeconds(const sim::Observer& observer, sim::Tick window) {
  std::vector<sim::Tick> ticks;
  for (sim::Tick back = 0; back <= std::min(window, observer.last_tick()); back += sim::kTicksPerSecond)
    ticks.push_back(observer.last_tick() - back);
  std::ranges::reverse(ticks);
  return ticks;
}

bool IsStuck(const sim::Observer& observer, sim::RobotIndex robot) {
  constexpr double kRadius = 0.05;  // m
  const sim::Tick first = observer.last_tick() - kStuckTicks;
  return first >= 0 && StillSince(observer, robot, kStuckTicks, kRadius) <= first;
}

int PlaceOf(const sim::Vec2& point, const sim::Arena& arena) {
  const auto third = [](double value, double min, double max) {
    return std::clamp(static_cast<int>(std::floor(3.0 * (value - min) / (max - min))), 0, 2);
  };
  const sim::Vec2& min = arena.interior_min();
  const sim::Vec2& max = arena.interior_max();
  return 3 * third(point.y(), min.y(), max.y()) + third(point.x(), min.x(), max.x());
}

std::string_view NameOfPlace(int place) {
  constexpr std::array<std::string_view, kPlaces> kNames = {"lower left",  "lower middle", "lower right",
                                                            "middle left", "middle",       "middle right",
                                                            "upper left",  "upper middle", "upper right"};
  return kNames.at(static_cast<std::size_t>(place));
}

}  // namespace gauntlet::controllers
