// What is measured of a swarm that nothing is known of, from where its robots are. Formulas speak of measures
// by name, and each is a metric of the run.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/clusters.h"
#include "sim/arena/arena.h"
#include "sim/contacts.h"
#include "sim/observer.h"

namespace gauntlet::controllers::generic {

struct MeasureSettings {
  int robots = 0;
  sim::Vec2 goal = sim::Vec2::Zero();  // m
  double goal_radius = 0.0;            // m
  double link_range = 0.0;             // m between the centres of robots in one cluster
  sim::Tick trapped_window = 0;        // a robot is trapped when it kept within trapped_radius for this long
  double trapped_radius = 0.0;         // m around its mean position
};

// What can be said of one moment. Each of these names stands for the value at the end; with _mean, _min and
// _max behind it for that of all seconds of the run.
inline constexpr std::size_t kMoments = 9;
using Moment = std::array<double, kMoments>;

// What has been counted of items.
struct ItemCount {
  int taken = 0;
  int brought = 0;
  sim::Tick first = -1;  // when the first was brought, -1 = none was
};

// All metrics, in the order of Measures::Values.
const std::vector<MetricInfo>& Metrics();
// What formulas that judge a whole run may use: "robots" and "time" (s), then the metrics.
const std::vector<std::string>& NamesAtTheEnd();
// What formulas that are looked at during a run may use: "robots", "time" and "items_brought" so far, then
// what can be said of a moment.
const std::vector<std::string>& NamesAtAMoment();

class Measures {
 public:
  // The arena outlives it.
  Measures(const sim::Arena& arena, const MeasureSettings& settings);

  // After every tick. True when it was the end of a second, of which moment() tells then.
  bool Add(const sim::Observer& observer);
  const Moment& moment() const { return moment_; }

  // The values of Metrics(), once the run is over. `reached`: when what it was to reach was reached, -1 =
  // never.
  std::vector<double> Values(const sim::Observer& observer, const ItemCount& items, sim::Tick reached);
  // Per robot: the tick from which on it was trapped to the end; -1 = it was not.
  std::vector<sim::Tick> TrappedSince(const sim::Observer& observer) const;

 private:
  Moment Look(const sim::Observer& observer);

  const sim::Arena& arena_;
  MeasureSettings settings_;
  sim::Contacts contacts_;
  Clusters clusters_;
  std::vector<sim::Vec2> places_;  // of the robots, at the moment
  Moment moment_{};
  Moment sum_{};
  Moment min_{};
  Moment max_{};
  int seconds_ = 0;
};

}  // namespace gauntlet::controllers::generic
