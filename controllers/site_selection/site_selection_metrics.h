// How a swarm decided, from what its robots said in every tick. Pure functions of a log.
#pragma once

#include <array>
#include <string_view>

#include "controllers/common/state_log.h"
#include "controllers/site_selection/site_selection_controller.h"

namespace gauntlet::controllers::site_selection {

// States in the log: 0 = the robot has said nothing, which all have at tick 0.
inline constexpr std::array<std::string_view, 9> kLoggedStates = {
    "silent",       "goes to A",    "goes to B",  "surveys A", "surveys B",
    "comes from A", "comes from B", "tells of A", "tells of B"};
constexpr std::uint8_t Logged(SiteState state, Site opinion) {
  return static_cast<std::uint8_t>(1 + 2 * static_cast<int>(state) + static_cast<int>(opinion));
}
// Whether it is the opinion of a robot that has something logged.
constexpr bool IsFor(Site site, std::uint8_t logged) {
  return logged != 0 && (logged - 1) % 2 == static_cast<int>(site);
}

// Share of the robots whose opinion is `site` at a tick, 0 to 1.
double ShareFor(const StateLog& log, int robots, Site site, sim::Tick tick);
// The first whole second from which on at least `decided` of the robots were for one site for 60 s, in ticks;
// -1: there is none. 0.5 < decided <= 1.
sim::Tick DecisionTick(const StateLog& log, int robots, double decided);

// What robots did in a whole run with one opinion.
struct Trips {
  double visited = 0.0;     // share of the robots that ever came to the site
  double trips = 0.0;       // arrivals per robot
  double travel = 0.0;      // s from the opinion to the arrival, mean of all arrivals; -1 = none
  double travelling = 0.0;  // share of the robots on the way there or back at the end
  int turned = 0;           // changes to this opinion, of all robots
};
Trips TripsTo(const StateLog& log, int robots, Site site);

}  // namespace gauntlet::controllers::site_selection
