// The only file that knows Box2D. The drive model says where a robot goes in a tick when nothing is in its
// way; Box2D says what becomes of that when something is. Robots that cannot touch anything in this tick stay
// out of the solver: they move exactly as the drive model says, in double precision.

#include <box2d/box2d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/check.h"
#include "sim/geometry/nearby_boxes.h"
#include "sim/geometry/neighbour_pairs.h"
#include "sim/geometry/trigonometry.h"
#include "sim/physics/box_motion.h"
#include "sim/physics/differential_drive.h"
#include "sim/physics/way_back.h"

// Box2D reads the clock a dozen times per step for a profile that nobody asks for: 8 % of a flocking run.
// These stand in for the library's own.
b2Timer::b2Timer() : m_start_sec(0), m_start_usec(0) {}
void b2Timer::Reset() {}
float b2Timer::GetMilliseconds() const {
  return 0.0f;
}

namespace gauntlet::sim {
namespace {

// Box2D's lengths are decimetres: its fixed contact slop of 0.005 units is then 0.5 mm.
constexpr double kScale = 10.0;
constexpr double kStep = kTickSeconds / kStepsPerTick;  // s
constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;

// In one step of ours the motor may give a contact the impulse that it gives in one substep of ARGoS. All
// motors being equal, who pushes whom does not depend on the limit; a larger one keeps the solver from
// settling and lets jammed robots overlap (measured: 11 mm with the whole 15 N, 8 mm so).
constexpr double kMotorForce = foot_bot::kMaxForce * (kTickSeconds / foot_bot::kSubstepsPerTick / kStep);

// Box2D mixes the friction of a pair as sqrt(a * b), ARGoS as a * b.
constexpr double kRobotFriction = foot_bot::kFriction * foot_bot::kFriction;
constexpr double kStaticFriction = foot_bot::kStaticFriction * foot_bot::kStaticFriction;

// Beyond what both can move in a tick, robots this near (m) are given to the solver: position correction of
// a crowd moves robots a little further than they drive.
constexpr double kMargin = 0.005;
constexpr double kSlack = 0.1;     // m; two robots that drive at each other use it up in 0.5 s
constexpr double kBoxReach = 0.4;  // m; > radius + margin + what a robot can move in a tick

b2Vec2 ToBox2d(const Vec2& v) {
  return {static_cast<float>(v.x() * kScale), static_cast<float>(v.y() * kScale)};
}

Vec2 FromBox2d(const b2Vec2& v) {
  return Vec2(static_cast<double>(v.x), static_cast<double>(v.y)) / kScale;
}

// Its way: where a step begins, and where the motor pushes the body in it, then where it ends.
struct Robot : StepWay {
  Pose pose;
  DriveState drive;
  DriveMotion motion;  // of this tick, were nothing in the way
  b2Body* body = nullptr;
  b2MotorJoint* motor = nullptr;  // holds the commanded velocity with the drive's limited force
  bool near = false;              // something is in reach in this tick
  bool in_solver = false;
  bool touched = false;  // in this tick
  bool held = false;     // by a contact in this step
};

struct MovingBox : BoxMotion {
  using BoxMotion::BoxMotion;

  b2Body* body = nullptr;
  b2PolygonShape* shape = nullptr;
  bool shown = true;   // Box2D has it where it is
  double reach = 0.0;  // m, furthest that a point of it can get in this tick by itself
};

// The turned corners are given directly: a turned body would go through sinf and cosf, and
// b2PolygonShape::Set refuses thin boxes.
void SetCorners(const OrientedBox& box, b2PolygonShape& shape) {
  const std::array<Vec2, 4> corners = Corners(box);
  const std::array<Vec2, 4> normals = {-LeftOf(box.axis), box.axis, LeftOf(box.axis), -box.axis};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    shape.m_vertices[i] = ToBox2d(corners[i] - box.center);
    shape.m_normals[i] = {static_cast<float>(normals[i].x()), static_cast<float>(normals[i].y())};
  }
}

// Lets Box2D know. Its body stays unturned; its shape turns. Box2D remembers each such move until its next
// step, so boxes are shown only when there is one.
void Show(MovingBox& moving) {
  if (moving.shown) return;
  SetCorners(moving.box, *moving.shape);
  moving.body->SetTransform(ToBox2d(moving.box.center), 0.0f);
  moving.shown = true;
}

bool Touching(const b2Body& body) {
  for (const b2ContactEdge* edge = body.GetContactList(); edge != nullptr; edge = edge->next) {
    if (edge->contact->IsTouching()) return true;
  }
  return false;
}

class Box2dEngine final : public PhysicsEngine {
 public:
  Box2dEngine() : world_(b2Vec2(0.0f, 0.0f)), nearby_(kBoxReach) {
    world_.SetContinuousPhysics(false);
    world_.SetAllowSleeping(false);
    const b2BodyDef ground;
    ground_ = world_.CreateBody(&ground);
  }

  void AddBox(const OrientedBox& box) override;
  BoxIndex AddKinematicBox(const OrientedBox& box) override;
  RobotIndex AddRobot(const Pose& pose) override;
  void MoveBox(BoxIndex box, const Pose& end) override { moving_[static_cast<std::size_t>(box)].SendTo(end); }
  void Step(std::span<const WheelSpeeds> commands) override;
  Pose PoseOf(RobotIndex robot) const override { return robots_[static_cast<std::size_t>(robot)].pose; }
  const OrientedBox& BoxAt(BoxIndex box) const override { return moving_[static_cast<std::size_t>(box)].box; }

 private:
  b2Fixture* AddFixture(b2Body& body, const OrientedBox& box, double friction);
  void Prepare();
  void FindNear(double longest_move);
  bool MoveIntoSolver();
  void Solve();
  void StepBackToContact();
  void MoveBoxes(std::size_t step);
  void StepBackFromBoxes(std::size_t index);
  static void PutBack(Robot& robot, const Vec2& move);

  b2World world_;
  b2Body* ground_;
  NearbyBoxes nearby_;
  NeighbourPairs neighbours_{kSlack};
  std::vector<Robot> robots_;
  std::vector<Vec2> positions_;  // of the robots when the tick begins
  std::vector<MovingBox> moving_;
  bool prepared_ = false;
};

b2Fixture* Box2dEngine::AddFixture(b2Body& body, const OrientedBox& box, double friction) {
  b2PolygonShape shape;
  shape.m_count = 4;
  SetCorners(box, shape);
  shape.m_centroid.SetZero();
  // Without Box2D's skin of 1 mm around polygons: a gap of a body's width stays passable, as in ARGoS.
  shape.m_radius = 0.0f;
  b2FixtureDef fixture;
  fixture.shape = &shape;
  fixture.friction = static_cast<float>(friction);
  return body.CreateFixture(&fixture);
}

void Box2dEngine::AddBox(const OrientedBox& box) {
  b2BodyDef body;
  body.position = ToBox2d(box.center);
  AddFixture(*world_.CreateBody(&body), box, kStaticFriction);
  nearby_.AddBox(box);
}

BoxIndex Box2dEngine::AddKinematicBox(const OrientedBox& box) {
  b2BodyDef body;
  body.type = b2_kinematicBody;
  body.position = ToBox2d(box.center);
  MovingBox& moving = moving_.emplace_back(box);
  moving.body = world_.CreateBody(&body);
  moving.shape = static_cast<b2PolygonShape*>(AddFixture(*moving.body, box, kStaticFriction)->GetShape());
  return static_cast<BoxIndex>(moving_.size()) - 1;
}

RobotIndex Box2dEngine::AddRobot(const Pose& pose) {
  Robot robot;
  robot.pose = pose;

  b2BodyDef body;
  body.type = b2_dynamicBody;
  body.position = ToBox2d(pose.position);
  body.fixedRotation = true;
  body.enabled = false;
  robot.body = world_.CreateBody(&body);

  b2CircleShape shape;
  shape.m_radius = static_cast<float>(foot_bot::kRadius * kScale);
  b2FixtureDef fixture;
  fixture.shape = &shape;
  fixture.friction = static_cast<float>(kRobotFriction);
  fixture.density = static_cast<float>(foot_bot::kMass) / (b2_pi * shape.m_radius * shape.m_radius);
  robot.body->CreateFixture(&fixture);

  b2MotorJointDef motor;
  motor.bodyA = ground_;
  motor.bodyB = robot.body;
  motor.collideConnected = true;
  motor.correctionFactor = 1.0f;
  motor.maxForce = static_cast<float>(kMotorForce * kScale);
  motor.maxTorque = 0.0f;
  robot.motor = static_cast<b2MotorJoint*>(world_.CreateJoint(&motor));

  robots_.push_back(robot);
  return static_cast<RobotIndex>(robots_.size()) - 1;
}

void Box2dEngine::Step(std::span<const WheelSpeeds> commands) {
  GAUNTLET_CHECK(commands.size() == robots_.size(), "one command per robot");
  if (!prepared_) Prepare();
  double longest_move = 0.0;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    positions_[i] = robot.pose.position;
    robot.motion = Drive(robot.drive, commands[i], UnitVector(robot.pose.heading));
    const Vec2 move = robot.motion.halves[0] + robot.motion.halves[1];
    longest_move = std::max(longest_move, move.squaredNorm());
  }
  FindNear(std::sqrt(longest_move));
  if (MoveIntoSolver()) {
    Solve();
  } else {
    for (std::size_t step = 0; step < kStepsPerTick; ++step) MoveBoxes(step);
  }
  for (MovingBox& moving : moving_) {
    moving.move = Vec2::Zero();
    moving.turn = 0.0;
  }

  for (Robot& robot : robots_) {
    if (robot.touched) {
      robot.pose.position = robot.to;
      robot.drive = {FromBox2d(robot.body->GetLinearVelocity()), robot.motion.end.turn_rate};
    } else {
      robot.pose.position += robot.motion.halves[0] + robot.motion.halves[1];
      robot.drive = robot.motion.end;
    }
    robot.pose.heading = WrapAngle(robot.pose.heading + robot.motion.turn);
  }
}

// The lists get their size, once everybody is there. Lets Box2D meet a dense crowd once (nobody moves), so
// that its pools have their size before the second tick.
void Box2dEngine::Prepare() {
  constexpr float kSpacing = 0.2f;  // dm: everybody overlaps eight to each side
  prepared_ = true;
  nearby_.SetVisitors(robots_.size());
  positions_.resize(robots_.size());
  float x = 0.0f;
  for (const Robot& robot : robots_) {
    robot.body->SetTransform({x += kSpacing, 0.0f}, 0.0f);
    robot.body->SetEnabled(true);
  }
  world_.Step(0.0f, kVelocityIterations, kPositionIterations);
  for (const Robot& robot : robots_) robot.body->SetEnabled(false);
}

// Marks the robots that could touch something in this tick, when no robot moves further than
// `longest_move`.
void Box2dEngine::FindNear(double longest_move) {
  const double box_reach = foot_bot::kRadius + longest_move + kMargin;
  const double robot_reach = 2.0 * (foot_bot::kRadius + longest_move) + kMargin;
  for (Robot& robot : robots_) robot.near = false;
  neighbours_.Update(positions_, robot_reach);
  for (const auto& [i, j] : neighbours_.pairs()) {
    if ((positions_[i] - positions_[j]).squaredNorm() < robot_reach * robot_reach) {
      robots_[i].near = true;
      robots_[j].near = true;
    }
  }
  for (MovingBox& moving : moving_) {
    moving.reach = moving.move.norm() + std::abs(moving.turn) * moving.box.half_extents.norm();
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    if (robot.near) continue;
    const Vec2& position = robot.pose.position;
    for (const std::size_t index : nearby_.Near(i, position)) {
      if (Distance(nearby_.box(index), position) < box_reach) {
        robot.near = true;
        break;
      }
    }
    for (const MovingBox& moving : moving_) {
      robot.near = robot.near || Distance(moving.box, position) < box_reach + moving.reach;
    }
  }
}

// Returns whether the solver has anything to do.
bool Box2dEngine::MoveIntoSolver() {
  bool any = false;
  for (Robot& robot : robots_) {
    robot.touched = false;
    robot.to = robot.pose.position;
    any = any || robot.near;
    if (robot.near == robot.in_solver) continue;
    if (robot.near) robot.body->SetTransform(ToBox2d(robot.pose.position), 0.0f);
    robot.body->SetEnabled(robot.near);
    robot.in_solver = robot.near;
  }
  return any;
}

// After a step of the solver, or instead of it.
void Box2dEngine::MoveBoxes(std::size_t step) {
  for (MovingBox& moving : moving_) {
    if (!moving.Goes()) continue;
    moving.Advance(kStepsPerTick - step);
    moving.shown = false;
  }
}

void Box2dEngine::Solve() {
  for (MovingBox& moving : moving_) Show(moving);
  for (std::size_t step = 0; step < kStepsPerTick; ++step) {
    for (MovingBox& moving : moving_) {
      const double share = 1.0 / (kStep * static_cast<double>(kStepsPerTick - step));
      moving.body->SetLinearVelocity(ToBox2d(share * moving.move));
      moving.body->SetAngularVelocity(static_cast<float>(share * moving.turn));
    }
    for (Robot& robot : robots_) {
      if (!robot.in_solver) continue;
      // Untouched robots aim at the exact place, so that rounding to float does not add up.
      robot.from = robot.touched ? FromBox2d(robot.body->GetPosition()) : robot.to;
      robot.to = robot.from + robot.motion.halves[step];
      if (!robot.touched) robot.body->SetLinearVelocity(ToBox2d(robot.motion.halves[step] / kStep));
      robot.motor->SetLinearOffset(ToBox2d(robot.to));
      robot.body->SetAngularVelocity(static_cast<float>(robot.motion.turn / kTickSeconds));
    }
    world_.Step(static_cast<float>(kStep), kVelocityIterations, kPositionIterations);
    MoveBoxes(step);
    for (MovingBox& moving : moving_) Show(moving);
    for (Robot& robot : robots_) {
      if (!robot.in_solver) continue;
      robot.held = Touching(*robot.body);
      robot.touched = robot.touched || robot.held;
      if (robot.touched) robot.to = FromBox2d(robot.body->GetPosition());
    }
    StepBackToContact();
  }
}

// Box2D sees a contact only once bodies overlap: a free robot that ran into something in this step may be
// inside it by the step's whole way. It is put back to where they met, with the velocity it has; the contact
// acts from the next step on. Robots in other contacts stay, there may be somebody behind them.
void Box2dEngine::StepBackToContact() {
  const std::span<const NeighbourPairs::Pair> pairs = neighbours_.pairs();
  auto pair = pairs.begin();
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const bool in_solver = robots_[i].in_solver;
    if (in_solver && !robots_[i].held) StepBackFromBoxes(i);
    for (; pair != pairs.end() && pair->first == i; ++pair) {
      Robot& other = robots_[pair->second];
      if (!in_solver || !other.in_solver) continue;
      const auto back = WaysApart(robots_[i], robots_[i].held, other, other.held);
      if (!back) continue;
      PutBack(robots_[i], back->a);
      PutBack(other, back->b);
    }
  }
}

void Box2dEngine::StepBackFromBoxes(std::size_t index) {
  Robot& robot = robots_[index];
  for (const std::size_t i : nearby_.Near(index, robot.from)) {
    const Vec2 back = WayBack(nearby_.box(i), robot);
    if (back != Vec2::Zero()) PutBack(robot, back);
  }
  for (const MovingBox& moving : moving_) {
    const Vec2 back = WayBack(moving.box, robot);
    if (back != Vec2::Zero()) PutBack(robot, back);
  }
}

void Box2dEngine::PutBack(Robot& robot, const Vec2& move) {
  robot.touched = true;
  robot.to += move;
  robot.body->SetTransform(ToBox2d(robot.to), 0.0f);
}

}  // namespace

std::unique_ptr<PhysicsEngine> MakeBox2dEngine() {
  return std::make_unique<Box2dEngine>();
}

}  // namespace gauntlet::sim
