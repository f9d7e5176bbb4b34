// The task partitioning robot (thesis 6.2, Figure 6.1; Pini et al. 2014): brings items from
// the source towards the nest, offers them to others on the way, and goes back to where it got the last one.
// Three variants differ in settings only: static with a potential field, static with BugS, dynamic.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "controllers/behaviour.h"
#include "controllers/common/proximity.h"
#include "controllers/common/random_walk.h"
#include "controllers/common/steering.h"
#include "controllers/partitioning/bug_walk.h"
#include "controllers/partitioning/handover.h"
#include "controllers/partitioning/nest_light.h"
#include "controllers/partitioning/partition_length.h"
#include "controllers/partitioning/source_estimate.h"
#include "sim/robot/controller.h"

namespace gauntlet::controllers {

struct PartitionerSettings {
  double speed = 0.0;  // m/s
  SteeringThresholds steering;
  RandomWalkParameters wander;
  double bounce_distance = 0.0;  // m beyond the body: wandering turns away from what is nearer in front
  double bounce_front = 0.0;     // rad to either side of the heading
  double grab_distance = 0.0;    // m: drives straight to an item that is nearer, without the field
  PartitionLengthSettings length;
  double least_handover_distance = 0.0;  // m from the nest: would it offer nearer than that, it carries on
  sim::Tick wait = 0;                    // offers an item for this long
  HandoverSettings handover;
  double arrive_distance = 0.0;       // m: the estimated source position is reached
  double neighbourhood_radius = 0.0;  // m around it
  sim::Tick neighbourhood = 0;        // searches there for this long
  sim::Tick no_progress = 0;          // gives an estimate up that it came no nearer to for this long
  double odometry_drift = 0.0;        // see SourceEstimate
  std::optional<BugSettings> bug;     // instead of the potential field, on the way to nest and estimate
};

// One robot. Sees the lamp above the nest, the source and waiting carriers by camera, others' messages,
// obstacles by the proximity ring (and, with BugS, the scanner), the dark floor of the nest under it, and
// whether its gripper holds an item. Not for sharing between threads.
class PartitioningController : public sim::Controller {
 public:
  // `context` has an odometer. A robot that starts in the relay begins in Neighbourhood around the place
  // where it starts, others in Explore.
  PartitioningController(const PartitionerSettings& settings, const ControllerContext& context);

  sim::DeviceSet Devices() const override;
  void Step(const sim::ControlStep& step) override;
  // The lamp shows the way to the nest, with an item.
  sim::DeviceSet Attention(bool holding_item) const override;
  double ListeningRange() const override;

  PartitioningState state() const { return state_; }
  double partition_length() const { return length_.value(); }
  // The estimated source position in the robot's frame, m.
  const sim::Vec2& estimate() const { return estimate_.value(); }

 private:
  // What the readings of one tick mean.
  struct View {
    std::optional<NestDirection> nest;  // looked for with an item only
    std::optional<SeenBody> source;
    std::optional<SeenBody> carrier;  // the nearest that waits
    bool in_nest = false;
    bool carrying = false;
  };
  struct Goal {
    double bearing = 0.0;   // rad
    double distance = 0.0;  // m
  };

  View Look(const sim::SensorReadings& readings);
  void Hear(std::span<const sim::Message> messages);
  void HandOver(const View& view);
  void ChangeState(const View& view, sim::RandomStream& random);
  void TakeHome(const View& view, sim::RandomStream& random);
  void GoBack();
  void Search(const View& view);
  bool AtSource(const View& view) const;
  bool Receives() const;
  std::optional<SeenBody> Item(const View& view) const;
  DriveCommand Move(const View& view, const sim::ControlStep& step);
  DriveCommand Travel(const Goal& goal, const sim::ControlStep& step);
  DriveCommand Wander(const sim::ControlStep& step);
  DriveCommand DriveToItem(const SeenBody& item, const sim::ControlStep& step);
  Goal NestGoal(const View& view) const;
  Goal EstimateGoal() const;
  PartitionMessage Say(const View& view) const;

  PartitionerSettings settings_;
  std::uint8_t self_;       // its number
  double pickup_distance_;  // m from the source's centre: stops and waits for an item
  Lamp lamp_;               // above the nest
  Odometer odometer_;
  RandomWalk walk_;
  BugWalk bug_;
  Giver giver_;
  Receiver receiver_;
  PartitionLength length_;
  PartitioningState state_;
  SourceEstimate estimate_;
  double pickup_nest_distance_ = 0.0;  // m
  bool may_wait_ = false;              // on this way to the nest
  sim::Tick in_state_ = 0;             // ticks, hand-overs and pick-ups aside
  double nearest_ = 0.0;               // m, smallest distance to the estimate on this way
  sim::Tick since_nearer_ = 0;
  std::vector<HeardMessage> heard_;  // of this tick, from robots within reach of a hand-over
  std::vector<SeenBody> bodies_;     // robots near by
};

}  // namespace gauntlet::controllers
