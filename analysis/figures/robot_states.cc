#include "analysis/figures/robot_states.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/robot/foot_bot.h"

namespace gauntlet::analysis {
namespace {

std::vector<std::string> SplitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

RobotStates StatesOf(const sim::RunResult& result) {
  RobotStates states;
  const double end = result.ticks * sim::kTickSeconds;
  for (const sim::Annotation& line : result.annotations) {
    if (line.kind != "states" || line.robots.size() != 1 || line.robots.front() < 0) continue;
    if (states.names.empty()) states.names = SplitAtCommas(line.label);
    const int robot = line.robots.front();
    bool first = true;
    for (const sim::Vec2& change : line.points) {
      if (!(change.x() >= 0.0 && change.x() <= end && change.y() >= 0.0) ||
          change.y() >= static_cast<double>(states.names.size())) {
        continue;
      }
      if (!first) states.spells.back().end = change.x();
      states.spells.push_back({robot, static_cast<int>(change.y()), change.x(), end});
      first = false;
      states.robots = std::max(states.robots, robot + 1);
    }
  }
  std::stable_sort(states.spells.begin(), states.spells.end(),
                   [](const StateSpell& a, const StateSpell& b) { return a.robot < b.robot; });
  return states;
}

std::string_view StateColor(int state) {
  constexpr std::array<std::string_view, 7> kColors = {"#d3dae2", "#56b4e9", "#f0d442", "#e69f00",
                                                       "#009e73", "#22272e", "#b565c4"};
  return kColors[static_cast<std::size_t>(state) % kColors.size()];
}

}  // namespace gauntlet::analysis
