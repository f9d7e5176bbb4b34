// Every trajectory measured in ARGoS, against this simulator's drive and contacts.
#pragma once

#include <string>
#include <vector>

#include "sim/run_spec.h"
#include "tests/golden/argos/validation.h"

namespace gauntlet {

// Names of files below tests/golden/argos/motion, without .csv.
std::vector<std::string> MotionScenes();
// Places until the first contact (m), headings over the whole file (rad: the drive's torque holds them in
// contacts too), and, where something is touched, places over the whole file (m) and every body's velocity
// over the last 2 s as a share of ARGoS', at least of 0.67 cm/s. No row when the file is missing. A scene
// with boxes that robots push is simulated by Box2D whatever is asked for: no other engine has them.
std::vector<ValidationRow> ValidateMotion(const std::string& scene,
                                          sim::PhysicsKind physics = sim::RunSpec{}.physics);

}  // namespace gauntlet
