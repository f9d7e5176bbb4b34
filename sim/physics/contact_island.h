// Robots that could touch each other or a box in a tick, and where they end up: the contact dynamics
// of ARGoS' dynamics2d engine (Chipmunk 6.0.1: cpSpaceStep, cpArbiter, cpPivotJoint) for discs of equal mass
// that turn as their drive says, whatever rubs. Source of the rules and constants: argos3 at 421bd763,
// src/plugins/simulator/physics_engines/dynamics2d. The turret, in ARGoS a body of its own, is part of the
// robot. How well it agrees: docs/validation.md.
#pragma once

#include <cstddef>
#include <span>

#include "sim/geometry/oriented_box.h"
#include "sim/geometry/vec2.h"
#include "sim/robot/foot_bot.h"

namespace gauntlet::sim {

// A robot in a tick. Impulses here and below are those that change a robot's velocity by so many m/s.
struct Mover {
  Vec2 position = Vec2::Zero();  // m
  Vec2 velocity = Vec2::Zero();  // m/s
  Vec2 target = Vec2::Zero();    // m/s, commanded
  Vec2 drive = Vec2::Zero();     // m/s, the impulse of the drive in the last substep
  double spin = 0.0;             // m/s, of the body's edge, from its commanded turn rate
  bool touched = false;          // in this tick
  Vec2 before = Vec2::Zero();    // m/s, the velocity when the substep begins
};

// What a contact hands on to the next substep, where the solution begins with it.
struct ContactMemory {
  bool touching = false;
  double press = 0.0;  // m/s, impulse along the normal, not negative
  double rub = 0.0;    // m/s, impulse to the left of the normal
};

struct Contact {
  Vec2 normal = Vec2::Zero();  // unit vector, from the robot to what it touches
  ContactMemory memory;
  double spin = 0.0;              // m/s, how fast the edges pass each other because the robots turn
  ContactMemory* kept = nullptr;  // where the owner keeps the memory from tick to tick
};

struct PairContact : Contact {
  Mover* a = nullptr;
  Mover* b = nullptr;
};

struct BoxContact : Contact {
  Mover* mover = nullptr;
  const OrientedBox* box = nullptr;
  std::size_t stride = 0;  // 1: the box moves, and `box` is the first of its places, one per substep
  Vec2 box_velocity = Vec2::Zero();  // m/s
  double box_turn_rate = 0.0;        // rad/s
  Vec2 surface = Vec2::Zero();       // m/s, of the box where it touches
};

// What could touch in this tick; nobody else comes near.
struct ContactIsland {
  std::span<Mover> movers;
  std::span<PairContact> pairs;
  std::span<BoxContact> boxes;
};

// One tick, in ARGoS' substeps. Each moves the robots with the velocities that they have, looks who overlaps,
// and then seeks the velocities with which contacts stop every approach and rub, and drives do what their
// limited force allows. Overlap is not undone: it stays as deep as the substep found it.
void Advance(const ContactIsland& island);

}  // namespace gauntlet::sim
