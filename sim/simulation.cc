#include "sim/simulation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/hash.h"
#include "base/number_text.h"
#include "sim/contacts.h"
#include "sim/physics/physics_engine.h"
#include "sim/robot/disturber.h"
#include "sim/robot/obstacle_course.h"
#include "sim/run_checks.h"
#include "sim/sensors/sensor_suite.h"

namespace gauntlet::sim {
namespace {

RunResult Refusal(std::string message) {
  RunResult result;
  result.verdict = Verdict::kRefused;
  result.message = std::move(message);
  SetHashes(result);
  return result;
}

// NaN is not within anything.
bool WithinLimit(double wheel_speed) {
  return std::abs(wheel_speed) <= foot_bot::kMaxWheelSpeed;
}

// One run: the swarm between two ticks.
class Loop {
 public:
  Loop(Scenario& scenario, std::vector<RobotSetup> swarm, std::uint64_t seed, Observer& observer,
       const SimulationOptions& options);

  // Records the start poses as tick 0.
  void Start();
  // One tick. False when a controller's command cannot be carried out or something that surrounds the robots
  // is no number; see invalid_command().
  bool Tick();
  const std::string& invalid_command() const { return invalid_command_; }
  std::uint64_t trajectory_hash() const { return trajectory_hash_.value(); }

 private:
  bool Act();
  void Disturb();
  void SendObstacles();
  bool CheckPoses();
  bool Refuse(const std::string& rule, std::size_t robot, const std::string& what);
  void Observe();
  void Control();
  void Enter(Phase phase) {
    if (probe_ != nullptr) probe_->Begin(phase);
  }

  Scenario& scenario_;
  std::vector<RobotSetup> swarm_;
  std::uint64_t seed_;
  Observer& observer_;
  PhaseProbe* probe_;
  std::unique_ptr<PhysicsEngine> physics_;
  SensorSuite sensors_;
  ObstacleCourse course_;
  std::vector<double> headings_;  // rad, of the moving obstacles
  Grippers grippers_;
  std::vector<DeviceSet> devices_;
  std::vector<DeviceSet> attention_;  // in this tick
  std::vector<Actuators> actuators_;  // as the controllers left them
  std::vector<WheelSpeeds> wheels_;   // in action
  std::vector<Signals> signals_;      // in action
  std::vector<Pose> poses_;
  std::vector<RobotState> states_;
  std::optional<Disturber> disturber_;  // only when something is disturbed
  WordHash64 trajectory_hash_;
  std::string invalid_command_;
};

std::unique_ptr<PhysicsEngine> MakePhysics(PhysicsKind kind) {
  switch (kind) {
    case PhysicsKind::kBox2d:
      return MakeBox2dEngine();
    case PhysicsKind::kRelaxation:
      return MakeRelaxationEngine();
    case PhysicsKind::kImpulse:
      return MakeImpulseEngine();
  }
  GAUNTLET_CHECK(false, "a kind of physics without an engine");
}

std::vector<RobotSensors> SensorsOf(const std::vector<RobotSetup>& swarm, const Disturbances& disturbances) {
  // Noise may move senders nearer.
  const bool noisy = disturbances.noise.contains(Device::kRangeAndBearing);
  std::vector<RobotSensors> sensors;
  for (const RobotSetup& robot : swarm) {
    sensors.push_back({.devices = robot.controller->Devices(),
                       .camera_range = robot.camera_range,
                       .radio_range = robot.radio_range,
                       .bodies_block_radio = robot.bodies_block_radio});
    if (!noisy) sensors.back().listening_range = robot.controller->ListeningRange();
  }
  return sensors;
}

std::vector<bool> Equipped(const std::vector<RobotSetup>& swarm, Device device) {
  std::vector<bool> equipped;
  for (const RobotSetup& robot : swarm) equipped.push_back(robot.controller->Devices().Has(device));
  return equipped;
}

std::vector<bool> UnderTest(const std::vector<RobotSetup>& swarm) {
  std::vector<bool> under_test;
  for (const RobotSetup& robot : swarm) under_test.push_back(robot.under_test);
  return under_test;
}

Loop::Loop(Scenario& scenario, std::vector<RobotSetup> swarm, std::uint64_t seed, Observer& observer,
           const SimulationOptions& options)
    : scenario_(scenario),
      swarm_(std::move(swarm)),
      seed_(seed),
      observer_(observer),
      probe_(options.probe),
      physics_(MakePhysics(options.physics)),
      sensors_(scenario.arena(), SensorsOf(swarm_, options.disturbances)),
      course_(scenario.arena()),
      grippers_(Equipped(swarm_, Device::kGripper)),
      attention_(swarm_.size()),
      actuators_(swarm_.size()),
      wheels_(swarm_.size()),
      poses_(swarm_.size()),
      states_(swarm_.size()) {
  for (const OrientedBox& box : scenario.arena().fixed_boxes()) physics_->AddBox(box);
  for (const OrientedBox& box : course_.boxes()) {
    physics_->AddKinematicBox(box);
    headings_.push_back(AngleOf(box.axis));
  }
  for (std::size_t i = 0; i < swarm_.size(); ++i) {
    physics_->AddRobot(swarm_[i].pose);
    devices_.push_back(swarm_[i].controller->Devices());
    signals_.push_back({.beacon = swarm_[i].beacon});
    actuators_[i].beacon = swarm_[i].beacon;
    swarm_[i].controller->Begin(actuators_[i]);
    poses_[i] = swarm_[i].pose;
  }
  if (!options.disturbances.None()) disturber_.emplace(options.disturbances, seed, UnderTest(swarm_));
}

void Loop::Start() {
  for (std::size_t i = 0; i < swarm_.size(); ++i)
    states_[i] = {.x = poses_[i].position.x(), .y = poses_[i].position.y()};
  Observe();
}

bool Loop::Tick() {
  Enter(Phase::kPhysics);
  if (!Act()) return false;
  if (disturber_) Disturb();
  SendObstacles();
  physics_->Step(wheels_);
  for (std::size_t i = 0; i < course_.boxes().size(); ++i) {
    course_.Place(i, physics_->BoxAt(static_cast<BoxIndex>(i)));
  }
  for (std::size_t i = 0; i < swarm_.size(); ++i) poses_[i] = physics_->PoseOf(static_cast<RobotIndex>(i));
  Enter(Phase::kObserve);
  Observe();
  if (!CheckPoses()) return false;
  Enter(Phase::kInteract);
  scenario_.Interact({.observer = observer_, .signals = signals_, .grippers = grippers_});
  if (std::optional<std::string> complaint = CheckSurroundings(scenario_, observer_.last_tick()))
      [[unlikely]] {
    invalid_command_ = *std::move(complaint);
    return false;
  }
  Enter(Phase::kSense);
  bool all_ears = true;  // everybody uses everything
  for (std::size_t i = 0; i < swarm_.size(); ++i) {
    attention_[i] = swarm_[i].controller->Attention(grippers_.Holds(static_cast<RobotIndex>(i)));
    all_ears = all_ears && attention_[i] == devices_[i];
  }
  sensors_.Sense({.poses = poses_,
                  .signals = signals_,
                  .actuators = actuators_,
                  .surroundings = scenario_,
                  .grippers = grippers_,
                  .wheels = wheels_,
                  .moving_boxes = course_.boxes(),
                  .obstacle_lights = course_.lights(),
                  .disturber = disturber_ ? &*disturber_ : nullptr,
                  .tick = observer_.last_tick(),
                  .attention = all_ears ? std::span<const DeviceSet>() : attention_,
                  .probe = probe_});
  Enter(Phase::kControl);
  Control();
  if (probe_ != nullptr) probe_->EndTick();
  return true;
}

// Takes over what the controllers decided in the last tick. Devices a robot does not have do nothing.
bool Loop::Act() {
  for (std::size_t i = 0; i < swarm_.size(); ++i) {
    const Actuators& actuators = actuators_[i];
    if (devices_[i].Has(Device::kLeds)) {
      signals_[i].beacon = actuators.beacon;
      signals_[i].ring = actuators.ring;
    }
    if (devices_[i].Has(Device::kRangeAndBearing)) signals_[i].message = actuators.message;
    if (devices_[i].Has(Device::kGripper)) {
      grippers_.SetClosed(static_cast<RobotIndex>(i), actuators.gripper_closed);
    }
    if (devices_[i].Has(Device::kDistanceScanner) && !std::isfinite(actuators.scanner.value)) [[unlikely]] {
      return Refuse("invalid-command", i,
                    "distance scanner command " + NumberText(actuators.scanner.value) +
                        "; an angle or a speed is finite");
    }
    if (!devices_[i].Has(Device::kWheels)) continue;
    if (!WithinLimit(actuators.left_wheel) || !WithinLimit(actuators.right_wheel)) [[unlikely]] {
      const bool left = !WithinLimit(actuators.left_wheel);
      return Refuse("invalid-command", i,
                    (left ? "left wheel speed " : "right wheel speed ") +
                        NumberText(left ? actuators.left_wheel : actuators.right_wheel) +
                        " m/s; a wheel turns at a finite speed of at most " +
                        NumberText(foot_bot::kMaxWheelSpeed) + " m/s");
    }
    wheels_[i] = {.left = actuators.left_wheel, .right = actuators.right_wheel};
  }
  return true;
}

bool Loop::Refuse(const std::string& rule, std::size_t robot, const std::string& what) {
  invalid_command_ =
      rule + ": " + RobotName(robot) + ", tick " + std::to_string(observer_.last_tick()) + ": " + what;
  return false;
}

// Noise and faults of what the robots do.
void Loop::Disturb() {
  const sim::Tick tick = observer_.last_tick() + 1;
  for (std::size_t i = 0; i < swarm_.size(); ++i) {
    disturber_->DisturbAction(static_cast<RobotIndex>(i), tick,
                              {.wheels = wheels_[i], .signals = signals_[i], .grippers = grippers_});
  }
}

void Loop::SendObstacles() {
  if (course_.boxes().empty()) return;
  course_.Advance(poses_);
  for (std::size_t i = 0; i < headings_.size(); ++i) {
    physics_->MoveBox(static_cast<BoxIndex>(i), {course_.centers()[i], headings_[i]});
  }
}

// Bodies that overlap from the beginning may be pushed through a wall. NaN is not within walls.
bool Loop::CheckPoses() {
  const Arena& arena = scenario_.arena();
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Vec2& p = poses_[i].position;
    if (!arena.InInterior(p)) [[unlikely]] {
      return Refuse(
          "left-arena", i,
          "at " + PointText(p.x(), p.y()) + " m, outside the walls: bodies that overlap pushed it there");
    }
  }
  return true;
}

void Loop::Observe() {
  for (std::size_t i = 0; i < swarm_.size(); ++i) {
    const Pose& pose = poses_[i];
    const double moved = std::sqrt((pose.position - states_[i].position()).squaredNorm());
    states_[i] = {.x = pose.position.x(),
                  .y = pose.position.y(),
                  .heading = pose.heading,
                  .speed = moved / kTickSeconds};
    trajectory_hash_.AddDouble(pose.position.x());
    trajectory_hash_.AddDouble(pose.position.y());
    trajectory_hash_.AddDouble(pose.heading);
  }
  observer_.Record(states_, course_.centers());
}

void Loop::Control() {
  const sim::Tick tick = observer_.last_tick();
  for (std::size_t i = 0; i < swarm_.size(); ++i) {
    const RobotIndex robot = static_cast<RobotIndex>(i);
    if (disturber_ && disturber_->Stopped(robot, tick)) continue;
    RandomStream random(seed_, StreamPurpose::kController, static_cast<std::uint32_t>(i),
                        static_cast<std::uint32_t>(tick));
    swarm_[i].controller->Step(
        {.tick = tick, .readings = sensors_.ReadingsOf(robot), .actuators = actuators_[i], .random = random});
  }
}

std::vector<RobotSummary> Summarize(const Observer& observer, const std::vector<bool>& lost) {
  std::vector<RobotSummary> summaries(lost.size());
  for (Tick tick = 0; tick <= observer.last_tick(); ++tick) {
    const std::span<const RobotState> states = observer.At(tick);
    for (std::size_t i = 0; i < summaries.size(); ++i) {
      summaries[i].path_length += states[i].speed * kTickSeconds;
      if (tick % kSummaryTicks == 0) summaries[i].waypoints.push_back(states[i].position());
    }
  }
  const std::span<const RobotState> first = observer.At(0);
  const std::span<const RobotState> last = observer.Latest();
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    summaries[i].start = {first[i].position(), first[i].heading};
    summaries[i].end = {last[i].position(), last[i].heading};
    summaries[i].lost = lost[i];
  }
  return summaries;
}

std::vector<std::vector<RobotState>> TrajectoryOf(const Observer& observer) {
  std::vector<std::vector<RobotState>> trajectory;
  for (Tick tick = 0; tick <= observer.last_tick(); ++tick) {
    const std::span<const RobotState> states = observer.At(tick);
    trajectory.emplace_back(states.begin(), states.end());
  }
  return trajectory;
}

}  // namespace

RunResult Simulate(Scenario& scenario, std::uint64_t seed, bool record_trajectory,
                   const SimulationOptions& options) {
  if (options.probe != nullptr) options.probe->Begin(Phase::kStart);
  // Headquarters knows the observer from the beginning; how many robots it observes is known only afterwards.
  Observer observer(0, 0);
  const Headquarters headquarters(observer);
  Result<std::vector<RobotSetup>> swarm = scenario.CreateSwarm(headquarters);
  if (!swarm.ok()) return Refusal(swarm.error().message);
  if (std::optional<std::string> reason = RefuseSwarm(scenario.arena(), *swarm))
    return Refusal(*std::move(reason));
  const std::size_t robots = swarm->size();
  std::vector<bool> under_test;
  for (const RobotSetup& robot : *swarm) under_test.push_back(robot.under_test);
  const auto tested = static_cast<std::size_t>(std::ranges::count(under_test, true));
  if (std::optional<std::string> reason =
          RefuseDisturbances(options.disturbances, {.robots = robots, .under_test = tested})) {
    return Refusal(*std::move(reason));
  }

  observer = Observer(static_cast<int>(robots), scenario.tick_limit(), scenario.arena().moving().size());
  Loop loop(scenario, *std::move(swarm), seed, observer, options);
  loop.Start();
  std::optional<Contacts> contacts;
  if (options.count_contacts) {
    contacts.emplace(scenario.arena(), static_cast<int>(robots));
    contacts->Add(observer);
  }

  RunResult result;
  while (observer.last_tick() < scenario.tick_limit()) {
    if (!loop.Tick()) {
      result.verdict = Verdict::kInvalidCommand;
      result.message = loop.invalid_command();
      break;
    }
    if (contacts) contacts->Add(observer);
    if (scenario.Finished(observer)) break;
  }

  if (options.probe != nullptr) options.probe->Begin(Phase::kResult);
  Outcome outcome;
  if (result.verdict == Verdict::kCompleted) outcome = scenario.Evaluate(observer);
  if (options.judge && result.verdict == Verdict::kCompleted && outcome.complaint.empty())
    options.judge(scenario, observer, under_test, outcome);
  if (std::optional<std::string> complaint = CheckOutcome(outcome, observer.last_tick())) {
    result.verdict = Verdict::kInvalidCommand;
    result.message = *std::move(complaint);
    outcome = {};
  }
  outcome.lost.resize(robots, false);
  result.fitness = outcome.fitness;
  result.metrics = std::move(outcome.metrics);
  result.failure = std::move(outcome.failure);
  result.annotations = std::move(outcome.annotations);
  result.ticks = observer.last_tick();
  result.robots = Summarize(observer, outcome.lost);
  result.trajectory_hash = loop.trajectory_hash();
  if (contacts) result.contacts = contacts->begun();
  SetHashes(result);
  if (record_trajectory) result.trajectory = TrajectoryOf(observer);
  return result;
}

}  // namespace gauntlet::sim
