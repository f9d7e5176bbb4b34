#include "controllers/generic/items.h"

#include <algorithm>
#include <utility>

namespace gauntlet::controllers::generic {
namespace {

bool InOneOf(const std::vector<Area>& areas, const sim::Vec2& place) {
  return std::ranges::any_of(areas, [&](const Area& area) { return area.Holds(place); });
}

}  // namespace

Items::Items(std::vector<Area> sources, std::vector<Area> nests)
    : sources_(std::move(sources)), nests_(std::move(nests)) {}

void Items::Begin(std::vector<bool> grips) {
  carries_.assign(grips.size(), 0);
  grips_ = std::move(grips);
}

void Items::Move(const sim::Interaction& interaction) {
  if (sources_.empty()) return;
  const std::span<const sim::RobotState> robots = interaction.observer.Latest();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const auto robot = static_cast<sim::RobotIndex>(i);
    const sim::Vec2 place = robots[i].position();
    const bool closed = grips_[i] && interaction.grippers.Closed(robot);
    if (carries_[i] == 0) {
      if ((grips_[i] && !closed) || !InOneOf(sources_, place)) continue;
      carries_[i] = 1;
      ++count_.taken;
      if (grips_[i]) interaction.grippers.Give(robot);
      continue;
    }
    const bool in_nest = InOneOf(nests_, place);
    if (grips_[i] ? closed : !in_nest) continue;
    carries_[i] = 0;
    if (grips_[i]) interaction.grippers.Take(robot);
    if (!in_nest) continue;
    if (count_.brought++ == 0) count_.first = interaction.observer.last_tick();
  }
}

}  // namespace gauntlet::controllers::generic
