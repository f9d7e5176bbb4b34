#include "controllers/flocking/failure_classifier.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/check.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::RobotIndex;
using sim::Tick;

constexpr double kStandingSpeed = 1e-3;  // m/s; slower clusters stand still
constexpr double kRounding = 1e-9;       // rad; keeps 10 degrees, computed from headings, in the bin up to 10

std::vector<RobotIndex> Listed(const RobotFlags& flags) {
  std::vector<RobotIndex> robots;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] != 0) robots.push_back(static_cast<RobotIndex>(i));
  }
  return robots;
}

// Walks through the run once and keeps the main cluster of every tick.
class SplitFinder {
 public:
  SplitFinder(const sim::Observer& observer, const sim::Arena& arena, RobotIndex prey, const SplitRule& rule)
      : observer_(observer),
        prey_(prey),
        rule_(rule),
        links_(observer, arena, rule.link),
        everybody_(static_cast<std::size_t>(observer.robots()), 1) {}

  SplitHistory Find() {
    const Tick last = observer_.last_tick();
    first_ = std::min(rule_.link.memory, last);
    clusters_.reserve(static_cast<std::size_t>(last - first_ + 1));
    for (Tick tick = first_; tick <= last; ++tick) {
      clusters_.push_back(links_.Component(prey_, tick, everybody_));
      AddDepartures(tick);
    }
    SplitHistory history;
    for (SplitEvent& event : departures_) {
      if (!Rejoined(event)) history.events.push_back(std::move(event));
    }
    history.main_cluster = std::move(clusters_.back());
    return history;
  }

 private:
  const RobotFlags& Cluster(Tick tick) const { return clusters_[static_cast<std::size_t>(tick - first_)]; }

  // Every connected set of birds that was in the main cluster a tick ago and is not any more. At the first
  // tick that has a main cluster, everybody was in it before.
  void AddDepartures(Tick tick) {
    const RobotFlags& now = Cluster(tick);
    const RobotFlags& before = tick == first_ ? everybody_ : Cluster(tick - 1);
    RobotFlags left(now.size(), 0);
    for (std::size_t i = 0; i < now.size(); ++i) left[i] = before[i] != 0 && now[i] == 0 ? 1 : 0;
    RobotFlags remaining = now;
    remaining[static_cast<std::size_t>(prey_)] = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (left[i] == 0) continue;
      const RobotFlags set = links_.Component(static_cast<RobotIndex>(i), tick, left);
      SplitEvent event;
      event.detected = tick;
      event.tick = tick == first_ ? 0 : LastEdge(set, before, tick);
      event.birds = Listed(set);
      event.remaining = Listed(remaining);
      if (event.remaining.empty()) event.remaining.push_back(prey_);
      for (const RobotIndex bird : event.birds) left[static_cast<std::size_t>(bird)] = 0;
      departures_.push_back(std::move(event));
    }
  }

  // The last tick up to `tick` with an edge between the set and the rest of the cluster it left.
  Tick LastEdge(const RobotFlags& set, const RobotFlags& cluster, Tick tick) const {
    for (Tick t = tick; t > 0; --t) {
      for (std::size_t i = 0; i < set.size(); ++i) {
        if (set[i] == 0) continue;
        for (std::size_t j = 0; j < set.size(); ++j) {
          if (set[j] != 0 || cluster[j] == 0) continue;
          if (links_.Edge(static_cast<RobotIndex>(i), static_cast<RobotIndex>(j), t)) return t;
        }
      }
    }
    return 0;
  }

  bool Rejoined(const SplitEvent& event) const {
    const Tick until = std::min(event.detected + rule_.rejoin, observer_.last_tick());
    return std::all_of(event.birds.begin(), event.birds.end(), [&](RobotIndex bird) {
      for (Tick tick = event.detected + 1; tick <= until; ++tick) {
        if (Cluster(tick)[static_cast<std::size_t>(bird)] != 0) return true;
      }
      return false;
    });
  }

  const sim::Observer& observer_;
  RobotIndex prey_;
  SplitRule rule_;
  SwarmLinks links_;
  RobotFlags everybody_;
  Tick first_ = 0;
  std::vector<RobotFlags> clusters_;  // main cluster from tick first_ on
  std::vector<SplitEvent> departures_;
};

struct ClusterMotion {
  double speed = 0.0;      // m/s
  double direction = 0.0;  // rad
};

ClusterMotion MotionOf(const sim::Observer& observer, const std::vector<RobotIndex>& robots, Tick from,
                       Tick to) {
  double path_length = 0.0;
  sim::Vec2 heading_sum = sim::Vec2::Zero();
  for (const RobotIndex robot : robots) {
    const auto index = static_cast<std::size_t>(robot);
    for (Tick tick = from; tick <= to; ++tick) {
      const sim::RobotState& state = observer.At(tick)[index];
      heading_sum += sim::UnitVector(state.heading);
      if (tick > from) path_length += (state.position() - observer.At(tick - 1)[index].position()).norm();
    }
  }
  const double robot_seconds = static_cast<double>(robots.size()) * (to - from) * sim::kTickSeconds;
  return {robot_seconds > 0.0 ? path_length / robot_seconds : 0.0, sim::AngleOf(heading_sum)};
}

}  // namespace

SplitHistory FindSplits(const sim::Observer& observer, const sim::Arena& arena, RobotIndex prey,
                        const SplitRule& rule) {
  GAUNTLET_CHECK(observer.last_tick() >= 0, "no tick was recorded");
  return SplitFinder(observer, arena, prey, rule).Find();
}

const SplitEvent* LastSplit(const std::vector<SplitEvent>& events) {
  const auto key = [](const SplitEvent& event) {
    return std::tuple(event.tick, event.birds.size(), -event.birds.front());
  };
  const auto last = std::max_element(events.begin(), events.end(),
                                     [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return last == events.end() ? nullptr : &*last;
}

RelativeMotion CompareMotion(const sim::Observer& observer, const SplitEvent& split, Tick half_window) {
  const Tick from = std::max<Tick>(0, split.tick - half_window);
  const Tick to = std::min(observer.last_tick(), split.tick + half_window);
  const ClusterMotion left = MotionOf(observer, split.birds, from, to);
  const ClusterMotion stayed = MotionOf(observer, split.remaining, from, to);
  RelativeMotion motion;
  motion.angle = std::fabs(sim::WrapAngle(left.direction - stayed.direction));
  const auto [slower, faster] = std::minmax(left.speed, stayed.speed);
  if (faster >= kStandingSpeed) motion.speed_ratio = slower / faster;
  return motion;
}

int FailureTypeOf(const RelativeMotion& motion) {
  int bin = 0;
  while (bin < 9 && motion.angle > (bin + 1) * 10.0 * sim::kDegree + kRounding) ++bin;
  return motion.speed_ratio < 0.5 ? 10 + bin : bin;
}

std::string FailureLabel(int type) {
  return FailureDegrees(type) + " degrees apart, " + FailureSpeeds(type);
}

std::string FailureDegrees(int type) {
  GAUNTLET_CHECK(type >= 0 && type < kFailureTypes, "no failure type " + std::to_string(type));
  const int bin = type % 10;
  return bin == 9 ? "over 90" : std::to_string(10 * bin) + "-" + std::to_string(10 * bin + 10);
}

std::string FailureSpeeds(int type) {
  GAUNTLET_CHECK(type >= 0 && type < kFailureTypes, "no failure type " + std::to_string(type));
  return type < 10 ? "similar speeds" : "one cluster slower than half the other";
}

}  // namespace gauntlet::controllers
