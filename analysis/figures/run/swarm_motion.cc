#include "analysis/figures/run/swarm_motion.h"

#include <algorithm>

#include <fmt/format.h>

#include "sim/geometry/trigonometry.h"

namespace gauntlet::analysis {
namespace {

constexpr std::size_t kMoments = 200;

struct Moment {
  double spread = 0.0;     // m
  double agreement = 0.0;  // 0 to 1
  double speed = 0.0;      // m/s, over the time since the moment before
};

// `before`: the robots some ticks earlier, `seconds` apart; the same ones at the start.
Moment MomentOf(const std::vector<sim::RobotState>& robots, const std::vector<sim::RobotState>& before,
                double seconds, int guide) {
  Moment moment;
  sim::Vec2 middle = sim::Vec2::Zero();
  sim::Vec2 heading = sim::Vec2::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (static_cast<int>(i) == guide) continue;
    count += 1.0;
    middle += robots[i].position();
    heading += sim::UnitVector(robots[i].heading);
    if (seconds > 0.0) moment.speed += (robots[i].position() - before[i].position()).norm() / seconds;
  }
  if (count == 0.0) return moment;
  middle /= count;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (static_cast<int>(i) != guide) moment.spread += (robots[i].position() - middle).norm() / count;
  }
  moment.agreement = heading.norm() / count;
  moment.speed /= count;
  return moment;
}

}  // namespace

LineFigure SwarmMotion(const RunFigure& figure) {
  const std::string swarm = fmt::format("{}s", figure.style.member);
  LineFigure motion{
      .title = fmt::format("{}: how the swarm moved", figure.run),
      .outcome = DescribeOutcome(figure),
      .x_name = "time, s",
      .panels = {{.axis_name = fmt::format("mean distance of the {} from their middle, m", swarm),
                  .lines = {{.name = "spread"}},
                  .least = 0.0,
                  .most = 0.5},
                 {.axis_name = "agreement of their headings (1 = all the same way)",
                  .lines = {{.name = "agreement"}},
                  .least = 0.0,
                  .most = 1.0},
                 {.axis_name = "mean speed, m/s", .lines = {{.name = "speed"}}, .least = 0.0, .most = 0.05}}};
  const auto& ticks = figure.result.trajectory;
  const int guide = GuideOf(figure);
  const std::size_t step = std::max<std::size_t>(1, ticks.size() / kMoments);
  for (std::size_t tick = 0; tick < ticks.size(); tick += step) {
    const std::size_t earlier = tick < step ? tick : tick - step;
    const double seconds = static_cast<double>(tick - earlier) * sim::kTickSeconds;
    const Moment moment = MomentOf(ticks[tick], ticks[earlier], seconds, guide);
    const double values[] = {moment.spread, moment.agreement, moment.speed};
    for (std::size_t i = 0; i < motion.panels.size(); ++i) {
      motion.panels[i].lines.front().x.push_back(static_cast<double>(tick) * sim::kTickSeconds);
      motion.panels[i].lines.front().y.push_back(values[i]);
    }
  }
  return motion;
}

}  // namespace gauntlet::analysis
