#include "controllers/site_selection/site_selection_metrics.h"

#include "controllers/failure_descriptor.h"  // kNotMeasured

namespace gauntlet::controllers::site_selection {

double ShareFor(const StateLog& log, int robots, Site site, sim::Tick tick) {
  int count = 0;
  for (sim::RobotIndex robot = 0; robot < robots; ++robot) count += IsFor(site, log.At(robot, tick)) ? 1 : 0;
  return static_cast<double>(count) / robots;
}

sim::Tick DecisionTick(const StateLog& log, int robots, double decided) {
  constexpr sim::Tick kHeld = 60 * sim::kTicksPerSecond;
  std::array<sim::Tick, 2> since = {0, 0};  // per site
  for (sim::Tick tick = 0; tick < log.ticks(); tick += sim::kTicksPerSecond) {
    for (const Site site : {Site::kA, Site::kB}) {
      sim::Tick& first = since[static_cast<std::size_t>(site)];
      if (ShareFor(log, robots, site, tick) < decided) first = tick + sim::kTicksPerSecond;
      if (tick - first >= kHeld) return first;
    }
  }
  return -1;
}

Trips TripsTo(const StateLog& log, int robots, Site site) {
  const std::uint8_t go = Logged(SiteState::kGo, site);
  const std::uint8_t survey = Logged(SiteState::kSurvey, site);
  const Site other = site == Site::kA ? Site::kB : Site::kA;
  int visitors = 0;
  int travellers = 0;
  int turned = 0;
  int arrivals = 0;
  sim::Tick travelled = 0;
  for (sim::RobotIndex robot = 0; robot < robots; ++robot) {
    sim::Tick since = 0;
    const int arrivals_before = arrivals;
    std::uint8_t last = 0;
    for (sim::Tick tick = 1; tick < log.ticks(); ++tick) {
      const std::uint8_t now = log.At(robot, tick);
      if (now == go && last != go) since = tick;
      if (now == survey && last == go) {
        ++arrivals;
        travelled += tick - since;
      }
      if (IsFor(other, last) && IsFor(site, now)) ++turned;
      last = now;
    }
    if (arrivals > arrivals_before) ++visitors;
    if (last == go || last == Logged(SiteState::kBack, site)) ++travellers;
  }
  const double count = robots;
  return {visitors / count, arrivals / count,
          arrivals == 0 ? kNotMeasured : travelled * sim::kTickSeconds / arrivals, travellers / count,
          turned};
}

}  // namespace gauntlet::controllers::site_selection
