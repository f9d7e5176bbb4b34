// Our drive and contacts against trajectories measured in ARGoS3.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/sim/physics/argos_scenes.h"

namespace gauntlet::sim {
namespace {

class ArgosMotion : public testing::TestWithParam<ArgosScene> {};

TEST_P(ArgosMotion, MatchesUntilFirstContact) {
  const ArgosScene& scene = GetParam();
  const Trajectory argos = ArgosTrajectory(scene);
  const std::unique_ptr<PhysicsEngine> engine = MakeBox2dEngine();
  const Trajectory ours = SimulateScene(scene, *engine);
  const std::size_t end = scene.free ? argos.size() : TicksBeforeContact(scene, argos, 1e-4);
  const Deviation free = Compare(argos, ours, end);
  EXPECT_LT(free.position, 1e-4);
  EXPECT_LT(free.heading, 1e-4);

  const Deviation all = Compare(argos, ours, argos.size());
  const Vec2 end_gap = ours.back()[0].position - argos.back()[0].position;
  std::printf("%-20s free ticks %3zu: %8.1e m %8.1e rad | all %3zu: %8.1e m %8.1e rad | end %7.4f m\n",
              scene.name.c_str(), end, free.position, free.heading, argos.size(), all.position, all.heading,
              end_gap.norm());
  for (std::size_t i = 0; i < scene.commands.size() && !scene.free; ++i) {
    const Vec2 a = FinalVelocity(argos, i, 20);
    const Vec2 b = FinalVelocity(ours, i, 20);
    std::printf("    robot %zu final velocity, cm/s: ARGoS (%6.3f, %6.3f)  ours (%6.3f, %6.3f)\n", i,
                100 * a.x(), 100 * a.y(), 100 * b.x(), 100 * b.y());
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ArgosMotion, testing::ValuesIn(ArgosScenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace gauntlet::sim
