// The only file that knows Box2D. The drive model says where a robot goes in a tick when nothing is in its
// way; Box2D says what becomes of that when something is. Robots that cannot touch anything in this tick stay
// out of the solver: they move exactly as the drive model says, in double precision.

#include <box2d/box2d.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/base/check.h"
#include "sim/geometry/trigonometry.h"
#include "sim/physics/differential_drive.h"
#include "sim/physics/nearby_boxes.h"
#include "sim/physics/physics_engine.h"

namespace gauntlet::sim {
namespace {

// Box2D's lengths are decimetres: its fixed contact slop of 0.005 units is then 0.5 mm.
constexpr double kScale = 10.0;
constexpr int kSteps = 2;  // per tick; one lets crowded robots overlap by more than 10 mm
constexpr double kStep = kTickSeconds / kSteps;  // s
constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;

// In one step of ours the motor may give a contact the impulse that it gives in one substep of ARGoS. All
// motors being equal, who pushes whom does not depend on the limit; a larger one keeps the solver from
// settling and lets jammed robots overlap (measured: 11 mm with the whole 15 N, 8 mm so).
constexpr double kMotorForce = foot_bot::kMaxForce * (kTickSeconds / foot_bot::kSubstepsPerTick) / kStep;

// Box2D mixes the friction of a pair as sqrt(a * b), ARGoS as a * b.
constexpr double kRobotFriction = foot_bot::kFriction * foot_bot::kFriction;
constexpr double kStaticFriction = foot_bot::kStaticFriction * foot_bot::kStaticFriction;

// Beyond what both can move in a tick, robots this near (m) are given to the solver: position correction of
// a crowd moves robots a little further than they drive.
constexpr double kMargin = 0.005;
constexpr double kBite = 0.0003;   // m, how deep a first contact may be
constexpr double kBoxReach = 0.4;  // m; > radius + margin + what a robot can move in a tick

b2Vec2 ToBox2d(const Vec2& v) {
  return {static_cast<float>(v.x() * kScale), static_cast<float>(v.y() * kScale)};
}

Vec2 FromBox2d(const b2Vec2& v) {
  return Vec2(static_cast<double>(v.x), static_cast<double>(v.y)) / kScale;
}

struct Robot {
  Pose pose;
  DriveState drive;
  DriveMotion motion;  // of this tick, were nothing in the way
  b2Body* body = nullptr;
  b2MotorJoint* motor = nullptr;  // holds the commanded velocity with the drive's limited force
  Vec2 from = Vec2::Zero();       // m, where a step begins
  Vec2 to = Vec2::Zero();         // m, where the motor pushes the body in it, then where it ends
  bool near = false;              // something is in reach in this tick
  bool in_solver = false;
  bool touched = false;  // in this tick
  bool held = false;     // by a contact in this step
};

Vec2 ClosestPoint(const OrientedBox& box, const Vec2& p) {
  const Vec2 local = ToLocal(box, p).cwiseMax(-box.half_extents).cwiseMin(box.half_extents);
  return box.center + local.x() * box.axis + local.y() * LeftOf(box.axis);
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
  RobotIndex AddRobot(const Pose& pose) override;
  void Step(std::span<const WheelSpeeds> commands) override;
  Pose PoseOf(RobotIndex robot) const override { return robots_[static_cast<std::size_t>(robot)].pose; }

 private:
  void Prepare();
  void FindNear(double longest_move);
  bool MoveIntoSolver();
  void Solve();
  void StepBackToContact();
  void StepBackFromBoxes(std::size_t index);
  static void StepBack(Robot& a, Robot& b);
  static void PutBack(Robot& robot, const Vec2& move);

  b2World world_;
  b2Body* ground_;
  NearbyBoxes nearby_;
  std::vector<Robot> robots_;
  bool prepared_ = false;
};

void Box2dEngine::AddBox(const OrientedBox& box) {
  b2BodyDef body;
  body.position = ToBox2d(box.center);
  // The turned corners are given directly: a turned body would go through sinf and cosf, and
  // b2PolygonShape::Set refuses thin boxes.
  b2PolygonShape shape;
  shape.m_count = 4;
  const std::array<Vec2, 4> corners = Corners(box);
  const std::array<Vec2, 4> normals = {-LeftOf(box.axis), box.axis, LeftOf(box.axis), -box.axis};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    shape.m_vertices[i] = ToBox2d(corners[i] - box.center);
    shape.m_normals[i] = {static_cast<float>(normals[i].x()), static_cast<float>(normals[i].y())};
  }
  shape.m_centroid.SetZero();
  // Without Box2D's skin of 1 mm around polygons: a gap of a body's width stays passable, as in ARGoS.
  shape.m_radius = 0.0f;
  b2FixtureDef fixture;
  fixture.shape = &shape;
  fixture.friction = static_cast<float>(kStaticFriction);
  world_.CreateBody(&body)->CreateFixture(&fixture);
  nearby_.AddBox(box);
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
  nearby_.SetRobots(static_cast<int>(robots_.size()));
  return static_cast<RobotIndex>(robots_.size()) - 1;
}

void Box2dEngine::Step(std::span<const WheelSpeeds> commands) {
  GAUNTLET_CHECK(commands.size() == robots_.size(), "one command per robot");
  if (!prepared_) Prepare();
  double longest_move = 0.0;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    robot.motion = Drive(robot.drive, commands[i], UnitVector(robot.pose.heading));
    const Vec2 move = robot.motion.halves[0] + robot.motion.halves[1];
    longest_move = std::max(longest_move, move.squaredNorm());
  }
  FindNear(std::sqrt(longest_move));
  if (MoveIntoSolver()) Solve();

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

// Lets Box2D meet a dense crowd once (nobody moves), so that its pools have their size before the second
// tick.
void Box2dEngine::Prepare() {
  constexpr float kSpacing = 0.2f;  // dm: everybody overlaps eight to each side
  prepared_ = true;
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
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& a = robots_[i];
    for (std::size_t j = i + 1; j < robots_.size(); ++j) {
      Robot& b = robots_[j];
      if ((a.pose.position - b.pose.position).squaredNorm() < robot_reach * robot_reach) {
        a.near = true;
        b.near = true;
      }
    }
    if (a.near) continue;
    for (const std::size_t index : nearby_.Near(static_cast<RobotIndex>(i), a.pose.position)) {
      if (Distance(nearby_.box(index), a.pose.position) < box_reach) {
        a.near = true;
        break;
      }
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

void Box2dEngine::Solve() {
  for (std::size_t step = 0; step < kSteps; ++step) {
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
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    if (!robots_[i].in_solver) continue;
    if (!robots_[i].held) StepBackFromBoxes(i);
    for (std::size_t j = i + 1; j < robots_.size(); ++j) {
      if (robots_[j].in_solver) StepBack(robots_[i], robots_[j]);
    }
  }
}

void Box2dEngine::StepBackFromBoxes(std::size_t index) {
  Robot& robot = robots_[index];
  for (const std::size_t i : nearby_.Near(static_cast<RobotIndex>(index), robot.from)) {
    const OrientedBox& box = nearby_.box(i);
    const Vec2 outward = robot.to - ClosestPoint(box, robot.to);
    const double distance_squared = outward.squaredNorm();
    constexpr double kContact = foot_bot::kRadius;
    if (distance_squared >= (kContact - kBite) * (kContact - kBite) || distance_squared == 0.0 ||
        Distance(box, robot.from) <= kContact) {
      continue;
    }
    const double distance = std::sqrt(distance_squared);
    PutBack(robot, (kContact - kBite - distance) / distance * outward);
  }
}

void Box2dEngine::StepBack(Robot& a, Robot& b) {
  const Vec2 apart = a.to - b.to;
  const double distance_squared = apart.squaredNorm();
  constexpr double kContact = 2.0 * foot_bot::kRadius;
  if (distance_squared >= (kContact - kBite) * (kContact - kBite) || distance_squared == 0.0 ||
      (a.from - b.from).squaredNorm() <= kContact * kContact) {
    return;
  }
  const double distance = std::sqrt(distance_squared);
  const Vec2 normal = apart / distance;
  const double a_closing = a.held ? 0.0 : std::max(normal.dot(a.from - a.to), 0.0);
  const double b_closing = b.held ? 0.0 : std::max(normal.dot(b.to - b.from), 0.0);
  if (a_closing + b_closing == 0.0) return;
  const Vec2 excess = (kContact - kBite - distance) / (a_closing + b_closing) * normal;
  PutBack(a, a_closing * excess);
  PutBack(b, -b_closing * excess);
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
