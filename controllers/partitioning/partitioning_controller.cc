#include "controllers/partitioning/partitioning_controller.h"

#include <algorithm>
#include <cmath>

#include "controllers/common/nest_and_food.h"
#include "controllers/common/potential_field.h"
#include "controllers/partitioning/partitioning_scenario.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::Device;
using State = PartitioningState;

constexpr double kNearer = 0.01;  // m: less is no progress
constexpr std::size_t kMostHeard = 128;
constexpr double kSeenByScanner = 0.5;  // m between centres; the short range ends at a robot farther off

double Length(const sim::Vec2& v) {
  return std::sqrt(v.dot(v));
}

BugSettings BugOf(const PartitionerSettings& settings) {
  BugSettings bug = settings.bug.value_or(BugSettings{});
  bug.speed = settings.speed;
  bug.turn_rate = settings.steering.turn_rate;
  return bug;
}

}  // namespace

PartitioningController::PartitioningController(const PartitionerSettings& settings,
                                               const ControllerContext& context)
    : settings_(settings),
      self_(static_cast<std::uint8_t>(context.robot)),
      pickup_distance_(context.pickup_distance),
      lamp_(context.nest_lamp),
      odometer_(context.odometer),
      walk_(settings.wander),
      bug_(BugOf(settings)),
      giver_(settings.handover, self_),
      receiver_(settings.handover, self_),
      length_(settings.length),
      state_(context.starts_in_relay ? State::kNeighbourhood : State::kExplore),
      estimate_(settings.odometry_drift) {
  heard_.reserve(kMostHeard);
  bodies_.reserve(kMostHeard);
}

sim::DeviceSet PartitioningController::Devices() const {
  return Attention(true);
}

sim::DeviceSet PartitioningController::Attention(bool holding_item) const {
  sim::DeviceSet devices = Device::kWheels | Device::kLeds | Device::kProximity |
                           Device::kOmnidirectionalCamera | Device::kRangeAndBearing | Device::kMotorGround |
                           Device::kGripper;
  if (holding_item) devices = devices | Device::kLight;
  return settings_.bug ? devices | Device::kDistanceScanner : devices;
}

double PartitioningController::ListeningRange() const {
  return std::max(settings_.handover.keep_reach, settings_.bug ? kSeenByScanner : 0.0);
}

void PartitioningController::Step(const sim::ControlStep& step) {
  const bool travelling = state_ == State::kGoToNest || state_ == State::kGoToSource;
  estimate_.Move(odometer_(), travelling);
  Hear(step.readings.range_and_bearing);
  const View view = Look(step.readings);
  HandOver(view);
  ChangeState(view, step.random);

  const DriveCommand command = Move(view, step);
  step.actuators.Drive(command.forward, command.turn);
  const bool drops = state_ == State::kGoToNest && view.in_nest;
  step.actuators.gripper_closed = view.carrying ? !drops : receiver_.engaged() || AtSource(view);
  const bool offers = state_ == State::kWaitForTransfer && !giver_.engaged();
  step.actuators.beacon = offers ? kCarrierColor : sim::Color::kBlack;
  step.actuators.message = Encode(Say(view));
  if (settings_.bug) {
    step.actuators.scanner.mode =
        bug_.following() ? sim::ScannerCommand::Mode::kSpeed : sim::ScannerCommand::Mode::kOff;
    step.actuators.scanner.value = BugWalk::kScannerSpeed;
  }
}

// Only neighbours matter: for a hand-over, and to tell robots from obstacles.
void PartitioningController::Hear(std::span<const sim::Message> messages) {
  heard_.clear();
  bodies_.clear();
  for (const sim::Message& message : messages) {
    if (message.range <= settings_.handover.keep_reach && heard_.size() < kMostHeard) {
      heard_.push_back({message.range, DecodePartition(message.payload)});
    }
    if (settings_.bug && message.range <= kSeenByScanner && bodies_.size() < kMostHeard) {
      bodies_.push_back({message.range, message.Bearing()});
    }
  }
}

PartitioningController::View PartitioningController::Look(const sim::SensorReadings& readings) {
  View view;
  view.carrying = readings.holding_item;
  if (view.carrying) view.nest = ReadLamp(readings.light, lamp_);
  for (const sim::Blob& blob : readings.blobs) {
    const bool source = blob.color == kSourceColor;
    if (!source && (blob.color != kCarrierColor || receiver_.barred())) continue;
    std::optional<SeenBody>& seen = source ? view.source : view.carrier;
    if (!seen || blob.range < seen->range) seen = SeenBody{blob.range, blob.Bearing()};
  }
  view.in_nest = StandsInNest(readings);
  return view;
}

bool PartitioningController::Receives() const {
  return state_ == State::kExplore || state_ == State::kGoToSource || state_ == State::kNeighbourhood;
}

void PartitioningController::HandOver(const View& view) {
  if (state_ == State::kWaitForTransfer) giver_.Listen(heard_);
  if (!Receives() || view.carrying) return receiver_.Reset();
  const bool source_first = view.source && view.carrier && view.source->range < view.carrier->range;
  receiver_.Listen(view.carrier && !source_first && view.carrier->range <= settings_.handover.begin_reach,
                   heard_);
}

// The nearest thing to take.
std::optional<SeenBody> PartitioningController::Item(const View& view) const {
  if (view.source && view.carrier) {
    return view.source->range < view.carrier->range ? view.source : view.carrier;
  }
  return view.source ? view.source : view.carrier;
}

bool PartitioningController::AtSource(const View& view) const {
  if (view.carrying || !Receives() || receiver_.engaged() || !view.source) return false;
  return view.source->range <= pickup_distance_ && Item(view)->range == view.source->range;
}

void PartitioningController::TakeHome(const View& view, sim::RandomStream& random) {
  state_ = State::kGoToNest;
  estimate_.Begin(NestGoal(view).bearing, random);
  pickup_nest_distance_ = NestGoal(view).distance;
  may_wait_ = pickup_nest_distance_ - length_.value() >= settings_.least_handover_distance;
  bug_.Reset();
}

void PartitioningController::GoBack() {
  state_ = State::kGoToSource;
  nearest_ = Length(estimate());
  since_nearer_ = 0;
  giver_.Reset();
  bug_.Reset();
}

// The states without an item: what they look for, and when they give it up.
void PartitioningController::Search(const View& view) {
  if (receiver_.engaged() || AtSource(view)) return;
  ++in_state_;
  if (state_ == State::kGoToSource) {
    const double distance = Length(estimate());
    ++since_nearer_;
    if (distance < nearest_ - kNearer) {
      nearest_ = distance;
      since_nearer_ = 0;
    }
    if (distance <= settings_.arrive_distance) {
      state_ = State::kNeighbourhood;
      in_state_ = 0;
    } else if (since_nearer_ >= settings_.no_progress) {
      length_.Fail();
      state_ = State::kExplore;
    }
  } else if (state_ == State::kNeighbourhood && in_state_ >= settings_.neighbourhood) {
    length_.Fail();
    state_ = State::kExplore;
  }
}

// One row of the transition table per case; the first condition that holds decides.
void PartitioningController::ChangeState(const View& view, sim::RandomStream& random) {
  switch (state_) {
    case State::kGoToSource:
    case State::kNeighbourhood:
      if (view.carrying) length_.Succeed();
      [[fallthrough]];
    case State::kExplore:
      if (view.carrying) {
        TakeHome(view, random);
      } else {
        Search(view);
      }
      break;
    case State::kGoToNest:
      if (!view.carrying) {
        GoBack();
      } else if (may_wait_ && settings_.wait > 0 &&
                 pickup_nest_distance_ - NestGoal(view).distance >= length_.value()) {
        state_ = State::kWaitForTransfer;
        in_state_ = 0;
        giver_.Reset();
      }
      break;
    case State::kWaitForTransfer:
      ++in_state_;
      if (!view.carrying) {
        GoBack();
      } else if (in_state_ > settings_.wait && !giver_.engaged()) {
        state_ = State::kGoToNest;
        may_wait_ = false;
        giver_.Reset();
      }
      break;
  }
}

PartitioningController::Goal PartitioningController::NestGoal(const View& view) const {
  return view.nest ? Goal{view.nest->bearing, view.nest->distance} : Goal{};
}

PartitioningController::Goal PartitioningController::EstimateGoal() const {
  return {sim::AngleOf(estimate()), Length(estimate())};
}

DriveCommand PartitioningController::Move(const View& view, const sim::ControlStep& step) {
  if (state_ == State::kWaitForTransfer || receiver_.engaged() || AtSource(view)) {
    bug_.Reset();
    walk_.Reset();
    return {};
  }
  if (state_ == State::kGoToNest) return view.in_nest ? DriveCommand{} : Travel(NestGoal(view), step);
  if (const auto item = Item(view)) return DriveToItem(*item, step);
  if (state_ == State::kGoToSource) return Travel(EstimateGoal(), step);
  const bool strayed = state_ == State::kNeighbourhood && Length(estimate()) > settings_.neighbourhood_radius;
  return strayed ? Travel(EstimateGoal(), step) : Wander(step);
}

// Obstacles are followed with BugS; everything else, robots always, is kept off by the field.
DriveCommand PartitioningController::Travel(const Goal& goal, const sim::ControlStep& step) {
  walk_.Reset();
  const ProximityReadings& proximity = step.readings.proximity;
  if (!settings_.bug || state_ == State::kNeighbourhood) {
    return FollowField(goal.bearing, Diffusion(SumProximity(proximity)), settings_.speed, settings_.steering);
  }
  BugView view;
  view.proximity = WithoutBodies(proximity, bodies_);
  view.scan = step.readings.scanner_short;
  view.bodies = bodies_;
  view.goal_bearing = goal.bearing;
  view.goal_distance = goal.distance;
  const auto follow = bug_.Next(view);
  ProximityReadings robots = proximity;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (view.proximity[i] != 0.0) robots[i] = 0.0;
  }
  const ProximitySum near = SumProximity(robots);
  const bool robot_near = near.largest > 0.0;
  if (follow && !robot_near) return *follow;
  // On along the edge, to where its command would have it head in a second, or to the goal; away from robots.
  const double bearing = follow ? follow->turn * 1.0 : goal.bearing;
  if (!robot_near) return Steer(bearing, settings_.speed, settings_.steering);
  return FollowField(bearing, Diffusion(near), settings_.speed, settings_.steering);
}

DriveCommand PartitioningController::DriveToItem(const SeenBody& item, const sim::ControlStep& step) {
  walk_.Reset();
  bug_.Reset();
  if (item.range <= settings_.grab_distance) return Steer(item.bearing, settings_.speed, settings_.steering);
  const ProximitySum near = SumProximity(step.readings.proximity);
  return FollowField(item.bearing, Diffusion(near), settings_.speed, settings_.steering);
}

DriveCommand PartitioningController::Wander(const sim::ControlStep& step) {
  bug_.Reset();
  const double front = FrontReading(step.readings.proximity, settings_.bounce_front);
  if (!walk_.turning() && front > ProximityReadingAt(settings_.bounce_distance)) {
    walk_.TurnBy(step.random.Uniform(-sim::kPi, sim::kPi));
  }
  return walk_.Drive(settings_.speed, settings_.steering, step.random);
}

PartitionMessage PartitioningController::Say(const View& view) const {
  PartitionMessage message;
  message.from_robot = true;
  message.state = state_;
  message.carrying = view.carrying;
  message.self = self_;
  if (state_ == State::kWaitForTransfer) {
    message.step = giver_.step();
    message.partner = giver_.partner();
  } else {
    message.step = receiver_.step();
    message.partner = receiver_.partner();
  }
  message.partition_length = static_cast<float>(length_.value());
  return message;
}

}  // namespace gauntlet::controllers
