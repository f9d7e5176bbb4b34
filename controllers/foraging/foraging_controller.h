// The foraging robot (thesis 2.4.2.1, 5.2.1, 5.5.2): searches for food, takes an item,
// brings it to the nest; some robots stop as beacons that keep virtual pheromone for the others. Four
// variants differ in settings only: basic (no pheromone), VP, VP with a random side, improved VP (potential
// field).
#pragma once

#include <optional>
#include <span>

#include "controllers/behaviour.h"
#include "controllers/common/potential_field.h"
#include "controllers/common/random_walk.h"
#include "controllers/common/steering.h"
#include "controllers/common/turn_aside.h"
#include "controllers/foraging/pheromone.h"
#include "controllers/foraging/radio_message.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers {

// Rules about beacons; the basic algorithm has none.
struct BeaconSettings {
  PheromoneSettings pheromone;
  double follow_staleness = 0.0;  // Following needs a level towards the food above exp(-this)
  double home_staleness = 0.0;    // F-Homing needs a level towards the nest above exp(-this)
  double reached_distance = 0.0;  // m between centres: a beacon is reached
  sim::Tick bar_ticks = 0;     // no following of that kind for this long after a beacon was reached in vain
  double become_chance = 0.0;  // per tick, when fewer than two beacons are in range
  double leave_chance = 0.0;   // per tick, when more than two are
};

struct ForagerSettings {
  double speed = 0.0;  // m/s
  SteeringThresholds steering;
  RandomWalkParameters wander;
  TurnAsideSettings avoidance;
  std::optional<PotentialFieldSettings> field;  // improved VP: how it avoids with a target in view
  sim::Tick food_memory = 0;                    // Gathering ends when the food was out of sight for longer
  std::optional<BeaconSettings> beacons;
};

// One robot. Sees the food's light with the camera, hears beacons and the nest by range-and-bearing, knows
// the nest by the dark floor under it, and has an item in its gripper or not. Not for sharing between
// threads.
class ForagingController : public sim::Controller {
 public:
  ForagingController(const ForagerSettings& settings, const ControllerContext& context);

  sim::DeviceSet Devices() const override;
  void Step(const sim::ControlStep& step) override;

  ForagingState state() const { return state_; }

 private:
  // A beacon in range.
  struct Target {
    const sim::Message* message = nullptr;  // none: there is no such beacon
    double staleness = kNoPheromone;

    explicit operator bool() const { return message != nullptr; }
    void reset() { message = nullptr; }
    // Whether this one says a larger level than the one before.
    void Prefer(const sim::Message& other, double others_staleness) {
      if (message == nullptr || others_staleness < staleness) *this = {&other, others_staleness};
    }
    double range() const { return message->range; }
  };
  // What the readings of one tick mean.
  struct View {
    const sim::Blob* food = nullptr;     // none: it is not seen
    const sim::Message* nest = nullptr;  // none: it is not heard
    Target food_beacon;                  // the beacon with the largest level towards the food
    Target nest_beacon;
    int beacons = 0;  // in range, the nest counts as one
    bool in_nest = false;
    bool carrying = false;
  };

  View Look(const sim::SensorReadings& readings) const;
  void KeepTime(const View& view);
  void KeepPheromone(const View& view, std::span<const sim::Message> messages);
  void ChangeState(const View& view, sim::RandomStream& random);
  bool LacksBeacons(const View& view, sim::RandomStream& random) const;
  void BecomeBeacon();
  void TakeHome();
  DriveCommand Move(const View& view, const sim::ControlStep& step);
  DriveCommand DriveTo(const SeenBody& target, bool has_body, const sim::ControlStep& step);
  DriveCommand Walk(const sim::ControlStep& step);
  bool AtFood(const View& view) const;
  RadioMessage Say(const View& view) const;

  ForagerSettings settings_;
  double pickup_distance_;      // m from the food's centre: stops and waits for an item
  double communication_range_;  // m
  RandomWalk walk_;
  TurnAside turn_aside_;
  ForagingState state_ = ForagingState::kWandering;
  sim::Tick since_nest_ = 0;  // ticks; a run begins at the nest
  sim::Tick since_food_ = 0;
  sim::Tick food_unseen_ = 0;
  sim::Tick follow_barred_ = 0;  // ticks left
  sim::Tick home_barred_ = 0;
  Pheromone to_nest_;
  Pheromone to_food_;
};

}  // namespace gauntlet::controllers
