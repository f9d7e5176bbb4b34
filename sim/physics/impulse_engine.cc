// The drive model says where a robot goes in a tick when nothing is in its way (sim/physics/contact_island.h
// says what becomes of that when something is). Here: who could touch whom in a tick. Robots that could touch
// nothing move exactly as the drive model says.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "sim/geometry/nearby_boxes.h"
#include "sim/geometry/neighbour_pairs.h"
#include "sim/geometry/trigonometry.h"
#include "sim/physics/box_motion.h"
#include "sim/physics/contact_island.h"
#include "sim/physics/differential_drive.h"
#include "sim/physics/physics_engine.h"

namespace gauntlet::sim {
namespace {

// Beyond what both can move in a tick, robots this near (m) may touch: a crowd pushes them a little further.
constexpr double kMargin = 0.005;
constexpr double kSlack = 0.1;     // m; two robots that drive at each other use it up in 0.5 s
constexpr double kBoxReach = 0.4;  // m; > radius + margin + what a robot can move in a tick
// Room that is kept for contacts, so that a crowd allocates nothing: for each robot this many others, and
// this many boxes, which may overlap.
constexpr std::size_t kPairsPerRobot = 40;
constexpr std::size_t kBoxesPerRobot = 16;

struct Robot {
  Pose pose;
  DriveState drive;
  DriveMotion motion;          // of this tick, were nothing in the way
  Vec2 target = Vec2::Zero();  // m/s, commanded
  Vec2 given = Vec2::Zero();   // see Mover::drive
  bool near = false;           // something is in reach in this tick
};

struct MovingBox : BoxMotion {
  using BoxMotion::BoxMotion;

  Vec2 velocity = Vec2::Zero();                               // m/s, in this tick
  double turn_rate = 0.0;                                     // rad/s, likewise
  std::array<OrientedBox, foot_bot::kSubstepsPerTick> way{};  // where it is in the substeps of this tick
  double reach = 0.0;  // m, furthest that a point of it gets in this tick
};

// Two that could touch in this tick, and what is known of their contact from the tick before.
struct Candidate {
  std::size_t first;   // robot
  std::size_t second;  // robot, or box: the fixed ones come first
  ContactMemory memory = {};

  bool Before(const Candidate& other) const {
    return first != other.first ? first < other.first : second < other.second;
  }
};

// In the order of first and second.
class Candidates {
 public:
  void Reserve(std::size_t most) {
    now_.reserve(most);
    last_.reserve(most);
  }
  // A new tick begins.
  void Renew() {
    now_.swap(last_);
    now_.clear();
  }
  void Add(std::size_t first, std::size_t second) { now_.push_back({first, second}); }
  // Once all of this tick are there.
  void Remember() {
    auto known = last_.begin();
    for (Candidate& candidate : now_) {
      while (known != last_.end() && known->Before(candidate)) ++known;
      if (known == last_.end()) return;
      if (!candidate.Before(*known)) candidate.memory = known->memory;
    }
  }
  std::span<Candidate> now() { return now_; }

 private:
  std::vector<Candidate> now_;
  std::vector<Candidate> last_;  // of the tick before
};

// What belongs to an island of a list that is ordered by islands.
struct Share {
  std::size_t begin = 0;
  std::size_t size = 0;

  std::size_t Take() { return begin + size++; }
  template <typename Item>
  std::span<Item> Of(std::vector<Item>& list) const {
    return std::span(list).subspan(begin, size);
  }
};

struct Shares {
  Share movers;
  Share pairs;
  Share boxes;
};

class ImpulseEngine final : public PhysicsEngine {
 public:
  ImpulseEngine() : nearby_(kBoxReach) {}

  void AddBox(const OrientedBox& box) override;
  BoxIndex AddKinematicBox(const OrientedBox& box) override;
  RobotIndex AddRobot(const Pose& pose) override;
  void MoveBox(BoxIndex box, const Pose& end) override { moving_[static_cast<std::size_t>(box)].SendTo(end); }
  void Step(std::span<const WheelSpeeds> commands) override;
  Pose PoseOf(RobotIndex robot) const override { return robots_[static_cast<std::size_t>(robot)].pose; }
  const OrientedBox& BoxAt(BoxIndex box) const override { return moving_[static_cast<std::size_t>(box)].box; }

 private:
  void Prepare();
  double DriveRobots(std::span<const WheelSpeeds> commands);
  double MoveBoxes();
  void FindCandidates(double longest_move);
  void FormIslands();
  void FillIslands();
  void FillBoxContact(const Candidate& candidate, BoxContact& contact);
  void EndTick();
  std::size_t Root(std::size_t robot);

  NearbyBoxes nearby_;
  std::size_t fixed_boxes_ = 0;
  NeighbourPairs neighbours_{kSlack};
  std::vector<Robot> robots_;
  std::vector<Vec2> positions_;  // of the robots when the tick begins
  std::vector<MovingBox> moving_;
  Candidates pairs_;
  Candidates boxes_;
  // Islands are named by their first robot, the root.
  std::vector<std::size_t> parents_;  // [robot]: on the way to its root
  std::vector<Shares> shares_;        // [root]
  std::vector<Mover> movers_;
  std::vector<std::size_t> places_;  // [robot]: in movers_
  std::vector<PairContact> pair_contacts_;
  std::vector<BoxContact> box_contacts_;
  bool prepared_ = false;
};

void ImpulseEngine::AddBox(const OrientedBox& box) {
  nearby_.AddBox(box);
  ++fixed_boxes_;
}

BoxIndex ImpulseEngine::AddKinematicBox(const OrientedBox& box) {
  moving_.emplace_back(box);
  return static_cast<BoxIndex>(moving_.size()) - 1;
}

RobotIndex ImpulseEngine::AddRobot(const Pose& pose) {
  robots_.emplace_back();
  robots_.back().pose = pose;
  return static_cast<RobotIndex>(robots_.size()) - 1;
}

// The lists get their size, once everybody is there.
void ImpulseEngine::Prepare() {
  prepared_ = true;
  const std::size_t robots = robots_.size();
  nearby_.SetVisitors(robots);
  positions_.resize(robots);
  parents_.resize(robots);
  shares_.resize(robots);
  places_.resize(robots);
  movers_.reserve(robots);
  const std::size_t pairs = std::min(robots * robots / 2, kPairsPerRobot * robots);
  pairs_.Reserve(pairs);
  pair_contacts_.reserve(pairs);
  const std::size_t boxes = robots * std::min(fixed_boxes_ + moving_.size(), kBoxesPerRobot);
  boxes_.Reserve(boxes);
  box_contacts_.reserve(boxes);
}

void ImpulseEngine::Step(std::span<const WheelSpeeds> commands) {
  GAUNTLET_CHECK(commands.size() == robots_.size(), "one command per robot");
  if (!prepared_) Prepare();
  const double longest_move = std::max(DriveRobots(commands), MoveBoxes());
  FindCandidates(longest_move);
  FormIslands();
  FillIslands();
  for (const Shares& shares : shares_) {
    if (shares.movers.size == 0) continue;
    Advance({.movers = shares.movers.Of(movers_),
             .pairs = shares.pairs.Of(pair_contacts_),
             .boxes = shares.boxes.Of(box_contacts_)});
  }
  EndTick();
}

// Returns the longest way (m) of a robot in this tick, were nothing in the way.
double ImpulseEngine::DriveRobots(std::span<const WheelSpeeds> commands) {
  double longest_squared = 0.0;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    positions_[i] = robot.pose.position;
    const Vec2 direction = UnitVector(robot.pose.heading);
    robot.motion = Drive(robot.drive, commands[i], direction);
    robot.target = (commands[i].left + commands[i].right) / 2.0 * direction;
    robot.near = false;
    longest_squared =
        std::max(longest_squared, (robot.motion.halves[0] + robot.motion.halves[1]).squaredNorm());
  }
  return std::sqrt(longest_squared);
}

// Returns the longest way (m) of a point of a box in this tick.
double ImpulseEngine::MoveBoxes() {
  double longest = 0.0;
  for (MovingBox& moving : moving_) {
    moving.reach = 0.0;
    if (!moving.Goes()) continue;
    moving.reach = moving.move.norm() + std::abs(moving.turn) * moving.box.half_extents.norm();
    longest = std::max(longest, moving.reach);
    moving.velocity = moving.move / kTickSeconds;
    moving.turn_rate = moving.turn / kTickSeconds;
    for (std::size_t substep = 0; substep < moving.way.size(); ++substep) {
      moving.Advance(moving.way.size() - substep);
      moving.way[substep] = moving.box;
    }
    moving.move = Vec2::Zero();
    moving.turn = 0.0;
  }
  return longest;
}

// Who could touch what in this tick, when nobody moves further than `longest_move`.
void ImpulseEngine::FindCandidates(double longest_move) {
  const double box_reach = foot_bot::kRadius + longest_move + kMargin;
  const double robot_reach = 2.0 * (foot_bot::kRadius + longest_move) + kMargin;
  pairs_.Renew();
  boxes_.Renew();
  neighbours_.Update(positions_, robot_reach);
  for (const auto& [i, j] : neighbours_.pairs()) {
    if ((positions_[i] - positions_[j]).squaredNorm() >= robot_reach * robot_reach) continue;
    pairs_.Add(i, j);
    robots_[i].near = true;
    robots_[j].near = true;
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const Vec2& position = positions_[i];
    const auto see = [&](const OrientedBox& box, std::size_t index, double reach) {
      if (SquaredDistance(box, position) >= reach * reach) return;
      boxes_.Add(i, index);
      robots_[i].near = true;
    };
    for (const std::size_t box : nearby_.Near(i, position)) see(nearby_.box(box), box, box_reach);
    for (std::size_t box = 0; box < moving_.size(); ++box) {
      see(moving_[box].box, fixed_boxes_ + box, box_reach + moving_[box].reach);
    }
  }
  pairs_.Remember();
  boxes_.Remember();
}

std::size_t ImpulseEngine::Root(std::size_t robot) {
  while (parents_[robot] != robot) robot = parents_[robot] = parents_[parents_[robot]];
  return robot;
}

// Robots that could touch each other, directly or through others, are an island. Each island gets its share
// of every list.
void ImpulseEngine::FormIslands() {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    parents_[i] = i;
    shares_[i] = {};
  }
  for (const Candidate& pair : pairs_.now()) {
    const std::size_t a = Root(pair.first);
    const std::size_t b = Root(pair.second);
    parents_[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    if (robots_[i].near) ++shares_[Root(i)].movers.size;
  }
  for (const Candidate& pair : pairs_.now()) ++shares_[Root(pair.first)].pairs.size;
  for (const Candidate& box : boxes_.now()) ++shares_[Root(box.first)].boxes.size;
  Shares end;
  for (Shares& shares : shares_) {
    for (const auto share : {&Shares::movers, &Shares::pairs, &Shares::boxes}) {
      (shares.*share).begin = (end.*share).begin;
      (end.*share).begin += (shares.*share).size;
      (shares.*share).size = 0;
    }
  }
  movers_.resize(end.movers.begin);
  pair_contacts_.resize(end.pairs.begin);
  box_contacts_.resize(end.boxes.begin);
}

void ImpulseEngine::FillIslands() {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const Robot& robot = robots_[i];
    if (!robot.near) continue;
    places_[i] = shares_[Root(i)].movers.Take();
    movers_[places_[i]] = {.position = robot.pose.position,
                           .velocity = robot.drive.velocity,
                           .target = robot.target,
                           .drive = robot.given,
                           .spin = foot_bot::kRadius * robot.motion.end.turn_rate};
  }
  for (Candidate& candidate : pairs_.now()) {
    PairContact& contact = pair_contacts_[shares_[Root(candidate.first)].pairs.Take()];
    contact = {};
    contact.memory = candidate.memory;
    contact.kept = &candidate.memory;
    contact.a = &movers_[places_[candidate.first]];
    contact.b = &movers_[places_[candidate.second]];
    contact.spin = contact.a->spin + contact.b->spin;
  }
  for (Candidate& candidate : boxes_.now()) {
    BoxContact& contact = box_contacts_[shares_[Root(candidate.first)].boxes.Take()];
    contact = {};
    contact.memory = candidate.memory;
    contact.kept = &candidate.memory;
    contact.mover = &movers_[places_[candidate.first]];
    contact.spin = contact.mover->spin;
    FillBoxContact(candidate, contact);
  }
}

void ImpulseEngine::FillBoxContact(const Candidate& candidate, BoxContact& contact) {
  if (candidate.second < fixed_boxes_) {
    contact.box = &nearby_.box(candidate.second);
    return;
  }
  const MovingBox& moving = moving_[candidate.second - fixed_boxes_];
  contact.box = &moving.box;
  if (moving.reach == 0.0) return;  // it rests
  contact.box = moving.way.data();
  contact.stride = 1;
  contact.box_velocity = moving.velocity;
  contact.box_turn_rate = moving.turn_rate;
}

void ImpulseEngine::EndTick() {
  for (const PairContact& contact : pair_contacts_) *contact.kept = contact.memory;
  for (const BoxContact& contact : box_contacts_) *contact.kept = contact.memory;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    robot.pose.heading = WrapAngle(robot.pose.heading + robot.motion.turn);
    if (robot.near && movers_[places_[i]].touched) {
      const Mover& mover = movers_[places_[i]];
      robot.pose.position = mover.position;
      robot.drive = {mover.velocity, robot.motion.end.turn_rate};
      robot.given = mover.drive;
    } else {
      robot.pose.position += robot.motion.halves[0] + robot.motion.halves[1];
      robot.drive = robot.motion.end;
      robot.given = Vec2::Zero();
    }
  }
}

}  // namespace

std::unique_ptr<PhysicsEngine> MakeImpulseEngine() {
  return std::make_unique<ImpulseEngine>();
}

}  // namespace gauntlet::sim
