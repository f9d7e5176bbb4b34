// Our drive and contacts against trajectories measured in ARGoS3.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/sim/physics/argos_scenes.h"

namespace gauntlet::sim {
namespace {

class ArgosMotion : public testing::TestWithParam<ArgosScene> {};
class ArgosContact : public testing::TestWithParam<ArgosScene> {};

std::vector<ArgosScene> ContactScenes() {
  std::vector<ArgosScene> scenes = ArgosScenes();
  std::erase_if(scenes, [](const ArgosScene& scene) { return scene.free; });
  return scenes;
}

TEST_P(ArgosMotion, MatchesUntilFirstContact) {
  const ArgosScene& scene = GetParam();
  const Trajectory argos = ArgosTrajectory(scene);
  const std::unique_ptr<PhysicsEngine> engine = MakeBox2dEngine();
  const Trajectory ours = SimulateScene(scene, *engine);
  const std::size_t end = scene.free ? argos.size() : TicksBeforeContact(scene, argos, 1e-4);
  const Deviation deviation = Compare(argos, ours, end);
  std::printf("%-20s %3zu free ticks: %.1e m, %.1e rad\n", scene.name.c_str(), end, deviation.position,
              deviation.heading);
  EXPECT_LT(deviation.position, 1e-4);
  EXPECT_LT(deviation.heading, 1e-4);
}

// Speeds after the contact within 3 % (and 0.02 cm/s where ARGoS' robots stand), places within the scene's
// tolerance, headings as in free motion: the drive's torque holds them.
TEST_P(ArgosContact, ComesOutAsInArgos) {
  const ArgosScene& scene = GetParam();
  const Trajectory argos = ArgosTrajectory(scene);
  const std::unique_ptr<PhysicsEngine> engine = MakeBox2dEngine();
  const Trajectory ours = SimulateScene(scene, *engine);
  const Deviation deviation = Compare(argos, ours, argos.size());
  std::printf("%-20s largest deviation %.1f mm\n", scene.name.c_str(), 1e3 * deviation.position);
  EXPECT_LT(deviation.position, scene.contact_tolerance);
  EXPECT_LT(deviation.heading, 1e-4);
  for (std::size_t i = 0; i < argos[0].size(); ++i) {
    const Vec2 expected = FinalVelocity(argos, i, 20);
    const Vec2 actual = FinalVelocity(ours, i, 20);
    std::printf("    body %zu ends with (%.3f, %.3f) cm/s, in ARGoS (%.3f, %.3f)\n", i, 100 * actual.x(),
                100 * actual.y(), 100 * expected.x(), 100 * expected.y());
    EXPECT_LT((actual - expected).norm(), std::max(0.03 * expected.norm(), 2e-4)) << "body " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ArgosMotion, testing::ValuesIn(ArgosScenes()),
                         [](const auto& scene) { return scene.param.name; });

INSTANTIATE_TEST_SUITE_P(Scenes, ArgosContact, testing::ValuesIn(ContactScenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace gauntlet::sim
