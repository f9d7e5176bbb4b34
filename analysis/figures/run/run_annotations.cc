#include "analysis/figures/run/run_annotations.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "sim/robot/foot_bot.h"

namespace gauntlet::analysis {

std::vector<const sim::Annotation*> MarkedBy(const RunFigure& figure, const sim::AnnotationStyle& style) {
  std::vector<const sim::Annotation*> marked;
  for (const sim::Annotation& annotation : figure.result.annotations) {
    if (annotation.kind != style.kind || annotation.points.empty()) continue;
    if (style.label.empty() || annotation.label == style.label) marked.push_back(&annotation);
  }
  return marked;
}

std::vector<const sim::Annotation*> MarkedAs(const RunFigure& figure, sim::Mark mark) {
  std::vector<const sim::Annotation*> marked;
  for (const sim::AnnotationStyle& style : figure.style.annotations) {
    if (style.mark != mark) continue;
    const auto some = MarkedBy(figure, style);
    marked.insert(marked.end(), some.begin(), some.end());
  }
  return marked;
}

const sim::Annotation* LatestMarkedAs(const RunFigure& figure, sim::Mark mark) {
  const auto marked = MarkedAs(figure, mark);
  const auto latest = std::max_element(marked.begin(), marked.end(),
                                       [](const auto* a, const auto* b) { return a->tick <= b->tick; });
  return latest == marked.end() ? nullptr : *latest;
}

const sim::Annotation* FirstViolation(const sim::RunResult& result) {
  const sim::Annotation* first = nullptr;
  for (const sim::Annotation& annotation : result.annotations) {
    if (annotation.kind == "violated" && (first == nullptr || annotation.tick < first->tick))
      first = &annotation;
  }
  return first;
}

RobotStates StatesOf(const sim::RunResult& result) {
  RobotStates states;
  const double end = result.ticks * sim::kTickSeconds;
  for (const sim::Annotation& line : result.annotations) {
    if (line.kind != "states" || line.robots.size() != 1 || line.robots.front() < 0) continue;
    if (states.names.empty()) {
      std::istringstream names(line.label);
      for (std::string name; std::getline(names, name, ',');) states.names.push_back(name);
    }
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
