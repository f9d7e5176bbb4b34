// How far a robot is put back that ran into something in a step. ARGoS notices a contact at the end of the
// first of its substeps in which bodies overlap and then stops the approach only, so a contact stays as deep
// as it was found: up to a substep's travel. A solver that sees the end of a longer step would find it
// deeper.
#pragma once

#include <optional>

#include "sim/geometry/oriented_box.h"

namespace gauntlet::sim {

// A robot's way in a step, m.
struct StepWay {
  Vec2 from = Vec2::Zero();
  Vec2 to = Vec2::Zero();
};

// From where a robot is after a step to where it met the box in it; zero when it did not.
Vec2 WayBack(const OrientedBox& box, const StepWay& robot);

struct WaysBack {
  Vec2 a;
  Vec2 b;
};
// The same of two robots that met each other, each by its share of the approach; nothing when they did not. A
// robot that another contact holds stays: there may be somebody behind it.
std::optional<WaysBack> WaysApart(const StepWay& a, bool a_held, const StepWay& b, bool b_held);

}  // namespace gauntlet::sim
