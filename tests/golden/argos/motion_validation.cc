#include "tests/golden/argos/motion_validation.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "tests/sim/physics/argos_scenes.h"
#include "tests/support/paths.h"

namespace gauntlet {
namespace {

constexpr double kFreeTolerance = 1e-4;      // m and rad
constexpr double kVelocityTolerance = 0.03;  // of ARGoS' velocity
constexpr double kStanding = 2e-4;           // m/s; a robot that stands in ARGoS may be this fast
constexpr double kContactTolerance = 1e-3;   // m, of the engine with ARGoS' steps
constexpr double kContactGap = 1e-4;         // m
constexpr std::size_t kLastTicks = 20;

sim::Trajectory Simulate(const sim::ArgosScene& scene, sim::PhysicsKind physics) {
  const bool box2d = physics == sim::PhysicsKind::kBox2d;
  return sim::SimulateScene(scene, box2d ? *sim::MakeBox2dEngine() : *sim::MakeImpulseEngine());
}

}  // namespace

std::vector<std::string> MotionScenes() {
  std::vector<std::string> names;
  for (const sim::ArgosScene& scene : sim::ArgosScenes()) names.push_back(scene.name);
  return names;
}

std::vector<ValidationRow> ValidateMotion(const std::string& scene_name, sim::PhysicsKind physics) {
  const std::string file = "motion/" + scene_name + ".csv";
  if (!std::filesystem::exists(GAUNTLET_SOURCE_DIR "/tests/golden/argos/" + file)) return {};
  const sim::ArgosScene& scene = sim::FindArgosScene(scene_name);
  const sim::Trajectory argos = sim::ArgosTrajectory(scene);
  const sim::Trajectory ours = Simulate(scene, physics);
  const std::size_t free = scene.free ? argos.size() : sim::TicksBeforeContact(scene, argos, kContactGap);
  const int all = static_cast<int>(argos.size());
  std::vector<ValidationRow> rows;
  rows.push_back({.file = file,
                  .quantity = scene.free ? "place, m" : "place until the first contact, m",
                  .tolerance = kFreeTolerance,
                  .error = sim::Compare(argos, ours, free).position,
                  .values = static_cast<int>(free)});
  const sim::Deviation whole = sim::Compare(argos, ours, argos.size());
  rows.push_back({.file = file,
                  .quantity = "heading, rad",
                  .tolerance = kFreeTolerance,
                  .error = whole.heading,
                  .values = all});
  if (scene.free) return rows;
  rows.push_back(
      {.file = file,
       .quantity = "place, m",
       .tolerance = physics == sim::PhysicsKind::kBox2d ? scene.contact_tolerance : kContactTolerance,
       .error = whole.position,
       .values = all});
  ValidationRow velocity = {.file = file,
                            .quantity = "velocity at the end, of ARGoS'",
                            .tolerance = kVelocityTolerance,
                            .values = static_cast<int>(argos[0].size())};
  for (std::size_t body = 0; body < argos[0].size(); ++body) {
    const sim::Vec2 expected = sim::FinalVelocity(argos, body, kLastTicks);
    const double off = (sim::FinalVelocity(ours, body, kLastTicks) - expected).norm();
    velocity.error =
        std::max(velocity.error, off / std::max(expected.norm(), kStanding / kVelocityTolerance));
  }
  rows.push_back(velocity);
  return rows;
}

}  // namespace gauntlet
