#include "controllers/foraging/foraging_controller.h"

#include <algorithm>

#include "controllers/common/nest_and_food.h"
#include "controllers/foraging/foraging_scenario.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {

using sim::Device;

namespace {

// Of what was seen or heard.
template <typename Seen>
SeenBody BodyOf(const Seen& seen) {
  return {seen.range, seen.Bearing()};
}

}  // namespace

ForagingController::ForagingController(const ForagerSettings& settings, const ControllerContext& context)
    : settings_(settings),
      pickup_distance_(context.pickup_distance),
      communication_range_(context.communication_range),
      walk_(settings.wander),
      turn_aside_(settings.avoidance) {
  if (settings_.beacons) settings_.beacons->pheromone.speed = settings_.speed;
}

sim::DeviceSet ForagingController::Devices() const {
  return Device::kWheels | Device::kProximity | Device::kOmnidirectionalCamera | Device::kRangeAndBearing |
         Device::kMotorGround | Device::kGripper;
}

void ForagingController::Step(const sim::ControlStep& step) {
  const View view = Look(step.readings);
  KeepTime(view);
  if (state_ == ForagingState::kBeacon) KeepPheromone(view, step.readings.range_and_bearing);
  ChangeState(view, step.random);

  const DriveCommand command = Move(view, step);
  step.actuators.Drive(command.forward, command.turn);
  step.actuators.gripper_closed = state_ != ForagingState::kDropping && (view.carrying || AtFood(view));
  step.actuators.message = Encode(Say(view));
}

ForagingController::View ForagingController::Look(const sim::SensorReadings& readings) const {
  View view;
  for (const sim::Blob& blob : readings.blobs) {
    if (blob.color == kFoodColor && (!view.food || blob.range < view.food->range)) view.food = &blob;
  }
  for (const sim::Message& message : readings.range_and_bearing) {
    if (ComesFromForager(message.payload)) continue;
    if (ComesFromNest(message.payload)) {
      view.nest = &message;
      ++view.beacons;
    } else if (ComesFromBeacon(message.payload)) {
      ++view.beacons;
      view.nest_beacon.Prefer(message, FirstIn(message.payload));
      view.food_beacon.Prefer(message, SecondIn(message.payload));
    }
  }
  if (settings_.beacons) {
    if (view.nest_beacon && view.nest_beacon.staleness >= settings_.beacons->home_staleness) {
      view.nest_beacon.reset();
    }
    if (view.food_beacon && view.food_beacon.staleness >= settings_.beacons->follow_staleness) {
      view.food_beacon.reset();
    }
  } else {
    view.nest_beacon.reset();
    view.food_beacon.reset();
  }
  view.in_nest = StandsInNest(readings);
  view.carrying = readings.holding_item;
  return view;
}

void ForagingController::KeepTime(const View& view) {
  ++since_food_;
  since_nest_ = view.in_nest ? 0 : since_nest_ + 1;
  food_unseen_ = view.food ? 0 : food_unseen_ + 1;
  follow_barred_ = std::max(0, follow_barred_ - 1);
  home_barred_ = std::max(0, home_barred_ - 1);
}

void ForagingController::KeepPheromone(const View& view, std::span<const sim::Message> messages) {
  const BeaconSettings& rules = *settings_.beacons;
  to_nest_.Evaporate(rules.pheromone);
  to_food_.Evaporate(rules.pheromone);
  for (const sim::Message& message : messages) {
    if (!ComesFromForager(message.payload)) continue;
    Pheromone& level = CarriesIn(message.payload) ? to_food_ : to_nest_;
    level.Lay(LaidStaleness(FirstIn(message.payload), message.range, rules.pheromone));
  }
  if (view.nest) to_nest_.Set(NestStaleness(view.nest->range, communication_range_));
}

// Whether this robot becomes a beacon now. By chance, because nobody sees another one's decision of the same
// tick: without it everybody at the nest would become one at once.
bool ForagingController::LacksBeacons(const View& view, sim::RandomStream& random) const {
  return settings_.beacons && !view.carrying && view.beacons < 2 &&
         random.Chance(settings_.beacons->become_chance);
}

void ForagingController::BecomeBeacon() {
  state_ = ForagingState::kBeacon;
  to_nest_.Set(LaidStaleness(since_nest_ * sim::kTickSeconds, 0.0, settings_.beacons->pheromone));
  to_food_.Clear();
}

void ForagingController::TakeHome() {
  state_ = ForagingState::kHoming;
  since_food_ = 0;
  walk_.TurnBy(sim::kPi);
}

// One row of the transition table per case; the first condition that holds decides.
void ForagingController::ChangeState(const View& view, sim::RandomStream& random) {
  using enum ForagingState;
  const auto reached = [&](const Target& beacon) {
    return beacon.range() < settings_.beacons->reached_distance;
  };
  switch (state_) {
    case kWandering:
      if (view.food) {
        state_ = kGathering;
      } else if (!view.in_nest && LacksBeacons(view, random)) {
        BecomeBeacon();
      } else if (view.food_beacon && follow_barred_ == 0) {
        state_ = kFollowing;
      }
      break;
    case kFollowing:
      if (view.food) {
        state_ = kGathering;
      } else if (LacksBeacons(view, random)) {
        BecomeBeacon();
      } else if (!view.food_beacon) {
        state_ = kWandering;
      } else if (reached(view.food_beacon)) {
        state_ = kWandering;
        follow_barred_ = settings_.beacons->bar_ticks;
      }
      break;
    case kGathering:
      if (view.carrying) {
        TakeHome();
      } else if (food_unseen_ > settings_.food_memory) {
        state_ = kWandering;
      }
      break;
    case kHoming:
      if (view.in_nest) {
        state_ = kDropping;
      } else if (settings_.beacons && (view.nest || (view.nest_beacon && home_barred_ == 0))) {
        state_ = kFollowingHome;
      }
      break;
    case kFollowingHome:
      if (view.in_nest) {
        state_ = kDropping;
      } else if (!view.nest && !view.nest_beacon) {
        state_ = kHoming;
      } else if (!view.nest && reached(view.nest_beacon)) {
        state_ = kHoming;
        home_barred_ = settings_.beacons->bar_ticks;
      }
      break;
    case kDropping:
      if (!view.carrying) {
        state_ = kWandering;
        walk_.TurnBy(sim::kPi);
      }
      break;
    case kBeacon:
      if (view.beacons > 2 && random.Chance(settings_.beacons->leave_chance)) {
        state_ = kWandering;
        to_nest_.Clear();
        to_food_.Clear();
      }
      break;
  }
}

bool ForagingController::AtFood(const View& view) const {
  return state_ == ForagingState::kGathering && view.food && view.food->range <= pickup_distance_;
}

DriveCommand ForagingController::Move(const View& view, const sim::ControlStep& step) {
  switch (state_) {
    case ForagingState::kDropping:
    case ForagingState::kBeacon:
      turn_aside_.Reset();
      return {};
    case ForagingState::kGathering:
      if (AtFood(view)) {
        turn_aside_.Reset();
        return {};
      }
      return view.food ? DriveTo(BodyOf(*view.food), false, step) : Walk(step);
    case ForagingState::kFollowing:
      return DriveTo(BodyOf(*view.food_beacon.message), true, step);
    case ForagingState::kFollowingHome:
      if (view.nest) return DriveTo(BodyOf(*view.nest), false, step);
      return DriveTo(BodyOf(*view.nest_beacon.message), true, step);
    case ForagingState::kHoming:
      // The basic algorithm has no F-Homing; it "moves towards the location of the nest" (thesis 2.4.2.1).
      if (view.nest && !settings_.beacons) return DriveTo(BodyOf(*view.nest), false, step);
      break;
    case ForagingState::kWandering:
      break;
  }
  return Walk(step);
}

DriveCommand ForagingController::DriveTo(const SeenBody& target, bool has_body,
                                         const sim::ControlStep& step) {
  walk_.Reset();
  const ProximityReadings& proximity = step.readings.proximity;
  if (settings_.field) {
    turn_aside_.Reset();
    const auto near = SumProximity(has_body ? WithoutBodies(proximity, {&target, 1}) : proximity);
    const sim::Vec2 repulsion = Repulsion(near, *settings_.field);
    return FollowField(target.bearing, repulsion, settings_.speed, settings_.steering);
  }
  if (const auto aside = turn_aside_.Next(proximity, step.random)) return *aside;
  return Steer(target.bearing, settings_.speed, settings_.steering);
}

DriveCommand ForagingController::Walk(const sim::ControlStep& step) {
  if (const auto aside = turn_aside_.Next(step.readings.proximity, step.random)) {
    walk_.Reset();
    return *aside;
  }
  return walk_.Drive(settings_.speed, settings_.steering, step.random);
}

RadioMessage ForagingController::Say(const View& view) const {
  RadioMessage message;
  message.sender = RadioMessage::Sender::kRobot;
  message.state = state_;
  message.carrying = view.carrying;
  if (state_ == ForagingState::kBeacon) {
    message.first = static_cast<float>(to_nest_.staleness());
    message.second = static_cast<float>(to_food_.staleness());
  } else {
    message.first = static_cast<float>((view.carrying ? since_food_ : since_nest_) * sim::kTickSeconds);
  }
  return message;
}

}  // namespace gauntlet::controllers
