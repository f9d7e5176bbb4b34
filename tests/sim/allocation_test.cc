// The tick loop allocates nothing after the first tick. Counts malloc, which operator new and Box2D both use.

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "sim/simulation.h"
#include "tests/support/sanitizer.h"
#include "tests/support/toy_scenario.h"

namespace {
long allocations = 0;
}

#if !GAUNTLET_SANITIZED
// glibc's own allocator behind our counter (GNU C library manual, "Replacing malloc").
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_realloc(void* pointer, std::size_t size);
extern "C" void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}
// NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): glibc uses reserved names.
extern "C" void* realloc(void* pointer, std::size_t size) noexcept {
  ++allocations;
  return __libc_realloc(pointer, size);
}
#endif

namespace gauntlet::sim {
namespace {

class AllocationProbe final : public PhaseProbe {
 public:
  explicit AllocationProbe(Tick ticks) { per_tick_.reserve(static_cast<std::size_t>(ticks)); }
  void Begin(Phase phase) override {
    if (phase == Phase::kPhysics) before_ = allocations;
  }
  void EndTick() override { per_tick_.push_back(allocations - before_); }
  const std::vector<long>& per_tick() const { return per_tick_; }

 private:
  long before_ = 0;
  std::vector<long> per_tick_;
};

std::vector<long> AllocationsPerTick(ToyScenario& scenario, Tick ticks,
                                     const Disturbances& disturbances = {}) {
  AllocationProbe probe(ticks);
  const long before = allocations;
  Simulate(scenario, 1, false, {.disturbances = disturbances, .probe = &probe});
  EXPECT_GT(allocations, before) << "the counter does not count";
  EXPECT_EQ(probe.per_tick().size(), static_cast<std::size_t>(ticks));
  return probe.per_tick();
}

void ExpectNoneAfterTheFirst(const std::vector<long>& per_tick) {
  for (std::size_t tick = 1; tick < per_tick.size(); ++tick)
    EXPECT_EQ(per_tick[tick], 0) << "in tick " << tick + 1;
}

TEST(Simulation, AllocatesNothingWithEveryDevice) {
  if (testing_support::kSanitized) GTEST_SKIP() << "sanitizers bring their own malloc";
  for (const int count : {20, 50}) {  // few robots are asked pair by pair, more of them through a grid
    RandomStream random(2, StreamPurpose::kTest);
    TestCase test_case;
    test_case.obstacles = RandomObstacles(8, random);
    for (const std::size_t gene : {0u, 3u}) {
      test_case.obstacles[gene].path = {Vec2::Zero()};
      test_case.obstacles[gene].speed = kMaxObstacleSpeed;
      test_case.obstacles[gene].light = Color::kYellow;
    }
    const Behaviour use_everything = [walk = Huddle(0.1)](const ControlStep& step) mutable {
      walk(step);
      step.actuators.ring.fill(step.tick % 3 == 0 ? Color::kBlack : Color::kGreen);
      step.actuators.message[0] = static_cast<std::uint8_t>(step.tick);
      step.actuators.scanner = {.mode = ScannerCommand::Mode::kSpeed, .value = 3.0};
      step.actuators.gripper_closed = step.tick % 2 == 0;
    };
    std::vector<ToyRobot> robots = RandomRobots(count, test_case, Vec2::Zero(), 2.9, use_everything, random);
    for (ToyRobot& robot : robots) robot.devices = kAllDevices;
    ToyScenario scenario(test_case, robots, 60);
    scenario.lamps = {{.position = {1.0, 1.0}, .intensity = 3.0, .color = Color::kYellow}};
    scenario.radios = {{.position = {-1.0, 1.0}}};
    ExpectNoneAfterTheFirst(AllocationsPerTick(scenario, 60));
    Disturbances disturbances;
    for (const DeviceInfo& noisy : kDevices) {
      if (noisy.most_noise == 0.0) continue;
      disturbances.noise[noisy.device] = {.uniform = 0.02, .gaussian = 0.02, .drop = noisy.drops ? 0.1 : 0.0};
    }
    disturbances.faults = {{.robot = 3, .device = Device::kProximity, .tick = 20}, {.robot = 5, .tick = 30}};
    ExpectNoneAfterTheFirst(AllocationsPerTick(scenario, 60, disturbances));
  }
}

TEST(Simulation, AllocatesNothingAfterTheFirstTick) {
  if (testing_support::kSanitized) GTEST_SKIP() << "sanitizers bring their own malloc";
  constexpr Tick kTicks = 2000;
  RandomStream random(1, StreamPurpose::kTest);
  TestCase test_case;
  test_case.obstacles = RandomObstacles(8, random);
  ToyScenario scenario(test_case, RandomRobots(20, test_case, Vec2::Zero(), 2.9, Huddle(0.1), random),
                       kTicks);
  ExpectNoneAfterTheFirst(AllocationsPerTick(scenario, kTicks));
}

}  // namespace
}  // namespace gauntlet::sim
