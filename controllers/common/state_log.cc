#include "controllers/common/state_log.h"

#include <algorithm>

namespace gauntlet::controllers {

void StateLog::Begin(int robots, sim::Tick tick_limit, std::uint8_t state) {
  robots_ = static_cast<std::size_t>(robots);
  states_.reserve(robots_ * (static_cast<std::size_t>(tick_limit) + 1));
  states_.assign(robots_, state);
}

void StateLog::AddMeans(std::vector<std::pair<std::string, double>>& metrics) const {
  std::vector<double> counts(names_.size(), 0.0);
  for (const std::uint8_t state : states_) counts[state] += 1.0;
  for (std::size_t state = 0; state < counts.size(); ++state) {
    metrics.emplace_back("mean_robots_" + std::string(names_[state]), counts[state] / ticks());
  }
}

bool StateLog::OccurredInSecondBefore(sim::RobotIndex robot, sim::Tick tick, std::uint8_t state) const {
  for (sim::Tick past = std::max(0, tick - sim::kTicksPerSecond + 1); past <= tick; ++past) {
    if (At(robot, past) == state) return true;
  }
  return false;
}

sim::Annotation StateLog::Line(sim::RobotIndex robot, std::optional<std::uint8_t> brief) const {
  std::string names;
  for (const std::string_view name : names_) names.append(names.empty() ? "" : ",").append(name);
  sim::Annotation line{"states", names, {}, 0.0, -1, {robot}};
  for (sim::Tick tick = 0; tick < ticks(); tick += sim::kTicksPerSecond) {
    const bool short_one = brief && OccurredInSecondBefore(robot, tick, *brief);
    const double state = short_one ? *brief : At(robot, tick);
    if (line.points.empty() || line.points.back().y() != state) {
      line.points.emplace_back(tick * sim::kTickSeconds, state);
    }
  }
  return line;
}

}  // namespace gauntlet::controllers
