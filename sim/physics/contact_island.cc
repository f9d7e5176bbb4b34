#include "sim/physics/contact_island.h"

#include <algorithm>
#include <cmath>

namespace gauntlet::sim {
namespace {

constexpr int kIterations = 10;                                                           // as ARGoS
constexpr double kMaxDrive = foot_bot::kMaxForce * foot_bot::kSubstep / foot_bot::kMass;  // m/s
// ARGoS multiplies the frictions of a pair.
constexpr double kRobotFriction = foot_bot::kFriction * foot_bot::kFriction;
constexpr double kBoxFriction = foot_bot::kFriction * foot_bot::kStaticFriction;

// Work that changes nothing is left out. Iterations end when one changes the velocities by less than this in
// all, m/s: the next substep goes on from there.
constexpr double kSettled = 1e-4;
// The rest of a tick is one step when a substep changed no velocity by more than this, m/s ...
constexpr double kSteady = 1e-5;
// ... and no contact begins, ends or slides further than this, m, around something round: its normal then
// turns by less than a milliradian.
constexpr double kStill = 1e-4;

// A contact that goes on begins with its last impulses, a new one with none.
void Note(ContactMemory& memory, bool touching) {
  if (!touching || !memory.touching) memory = {};
  memory.touching = touching;
}

void Detect(PairContact& contact) {
  constexpr double kReach = 2.0 * foot_bot::kRadius;
  const Vec2 apart = contact.b->position - contact.a->position;
  const double distance_squared = apart.squaredNorm();
  Note(contact.memory, distance_squared < kReach * kReach);
  if (!contact.memory.touching) return;
  contact.normal = distance_squared > 0.0 ? Vec2(apart / std::sqrt(distance_squared)) : Vec2(1.0, 0.0);
  contact.a->touched = true;
  contact.b->touched = true;
}

void Detect(BoxContact& contact, std::size_t substep) {
  const OrientedBox& box = contact.box[substep * contact.stride];
  const Vec2 local = ToLocal(box, contact.mover->position);
  Vec2 inward = local.cwiseMax(-box.half_extents).cwiseMin(box.half_extents) - local;
  const double distance_squared = inward.squaredNorm();
  Note(contact.memory, distance_squared < foot_bot::kRadius * foot_bot::kRadius);
  if (!contact.memory.touching) return;
  if (distance_squared > 0.0) {
    inward /= std::sqrt(distance_squared);
  } else {  // the centre is in the box: out through the nearest face
    const Vec2 depth = box.half_extents - local.cwiseAbs();
    inward = depth.x() < depth.y() ? Vec2(local.x() < 0.0 ? 1.0 : -1.0, 0.0)
                                   : Vec2(0.0, local.y() < 0.0 ? 1.0 : -1.0);
  }
  contact.normal = inward.x() * box.axis + inward.y() * LeftOf(box.axis);
  if (contact.stride != 0) {
    const Vec2 arm = contact.mover->position + foot_bot::kRadius * contact.normal - box.center;
    contact.surface = contact.box_velocity + contact.box_turn_rate * LeftOf(arm);
  }
  contact.mover->touched = true;
}

Vec2 Impulse(const Contact& contact, double press, double rub) {
  return press * contact.normal + rub * LeftOf(contact.normal);
}

Vec2 LastImpulse(const Contact& contact) {
  return Impulse(contact, contact.memory.press, contact.memory.rub);
}

// Takes the impulses that the contact needs now; returns what they differ from the last by.
Vec2 Change(Contact& contact, double press, double rub) {
  const Vec2 change = Impulse(contact, press - contact.memory.press, rub - contact.memory.rub);
  contact.memory.press = press;
  contact.memory.rub = rub;
  return change;
}

// The solvers return the square of the impulse by which they changed something.
double Solve(PairContact& contact) {
  const Vec2 approach = contact.a->velocity - contact.b->velocity;
  const double press = std::max(contact.memory.press + 0.5 * approach.dot(contact.normal), 0.0);
  const double sliding = Cross(contact.normal, approach) + contact.spin;
  const double grip = kRobotFriction * press;
  const double rub = std::clamp(contact.memory.rub + 0.5 * sliding, -grip, grip);
  const Vec2 change = Change(contact, press, rub);
  contact.a->velocity -= change;
  contact.b->velocity += change;
  return change.squaredNorm();
}

double Solve(BoxContact& contact) {
  const Vec2 approach = contact.mover->velocity - contact.surface;
  const double press = std::max(contact.memory.press + approach.dot(contact.normal), 0.0);
  const double sliding = Cross(contact.normal, approach) + contact.spin;
  const double grip = kBoxFriction * press;
  const double rub = std::clamp(contact.memory.rub + sliding, -grip, grip);
  const Vec2 change = Change(contact, press, rub);
  contact.mover->velocity -= change;
  return change.squaredNorm();
}

double Solve(Mover& mover) {
  Vec2 drive = mover.drive + (mover.target - mover.velocity);
  const double size_squared = drive.squaredNorm();
  if (size_squared > kMaxDrive * kMaxDrive) drive *= kMaxDrive / std::sqrt(size_squared);
  const Vec2 change = drive - mover.drive;
  mover.velocity += change;
  mover.drive = drive;
  return change.squaredNorm();
}

// The velocities after a substep. Returns whether they are those before it.
bool SolveVelocities(const ContactIsland& island) {
  for (const PairContact& contact : island.pairs) {
    if (!contact.memory.touching) continue;
    const Vec2 impulse = LastImpulse(contact);
    contact.a->velocity -= impulse;
    contact.b->velocity += impulse;
  }
  for (const BoxContact& contact : island.boxes) {
    if (contact.memory.touching) contact.mover->velocity -= LastImpulse(contact);
  }
  for (Mover& mover : island.movers) mover.velocity += mover.drive;

  for (int iteration = 0; iteration < kIterations; ++iteration) {
    // What a moving box squeezes cannot be solved. What is solved later wins, and a box that sinks in turns
    // back.
    double change = 0.0;
    for (BoxContact& contact : island.boxes) {
      if (contact.stride != 0 && contact.memory.touching) change += Solve(contact);
    }
    for (PairContact& contact : island.pairs) {
      if (contact.memory.touching) change += Solve(contact);
    }
    for (BoxContact& contact : island.boxes) {
      if (contact.stride == 0 && contact.memory.touching) change += Solve(contact);
    }
    for (Mover& mover : island.movers) change += Solve(mover);
    if (change <= kSettled * kSettled) break;
  }
  return std::ranges::all_of(island.movers, [](const Mover& mover) {
    return (mover.velocity - mover.before).squaredNorm() <= kSteady * kSteady;
  });
}

// Do the contacts stay what they are while all go on as they do for `seconds`?
bool ContactsStay(const ContactIsland& island, double seconds) {
  for (const PairContact& contact : island.pairs) {
    const double way = seconds * (contact.b->velocity - contact.a->velocity).norm();
    const double gap = (contact.b->position - contact.a->position).norm() - 2.0 * foot_bot::kRadius;
    if (contact.memory.touching ? way > kStill : way >= gap) return false;
  }
  for (const BoxContact& contact : island.boxes) {
    if (contact.stride != 0) return false;
    const Vec2& velocity = contact.mover->velocity;
    const double way = seconds * velocity.norm();
    if (!contact.memory.touching) {
      const double reach = foot_bot::kRadius + way;
      if (SquaredDistance(*contact.box, contact.mover->position) <= reach * reach) return false;
    } else if (way > kStill) {  // sliding along a face is steady, around a corner it is not
      const OrientedBox& box = *contact.box;
      const Vec2 local = ToLocal(box, contact.mover->position).cwiseAbs();
      const int along = std::abs(contact.normal.dot(box.axis)) > 0.5 ? 1 : 0;
      if (local[along] + way > box.half_extents[along]) return false;
    }
  }
  return true;
}

}  // namespace

void Advance(const ContactIsland& island) {
  for (std::size_t substep = 0; substep < foot_bot::kSubstepsPerTick; ++substep) {
    for (Mover& mover : island.movers) {
      mover.position += foot_bot::kSubstep * mover.velocity;
      mover.before = mover.velocity;
    }
    for (PairContact& contact : island.pairs) Detect(contact);
    for (BoxContact& contact : island.boxes) Detect(contact, substep);
    if (!SolveVelocities(island)) continue;
    const double rest = foot_bot::kSubstep * static_cast<double>(foot_bot::kSubstepsPerTick - 1 - substep);
    if (!ContactsStay(island, rest)) continue;
    for (Mover& mover : island.movers) mover.position += rest * mover.velocity;
    return;
  }
}

}  // namespace gauntlet::sim
