// What a simulated tick costs, as user CPU, by phase. Scenes: robots walking at random among 8 obstacles, and
// crowds that push to one place, the worst case. user_ms_per_run is a run of 200 s; the phases' ns per tick
// are the least of several runs, as other processes only ever add.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include "sim/simulation.h"
#include "tests/support/toy_scenario.h"

namespace gauntlet::sim {
namespace {

double UserSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

// Adds up the time between phase marks. Its two clock readings per phase (about 30 ns each) are part of what
// it reports.
class PhaseClock final : public PhaseProbe {
 public:
  void Begin(Phase phase) override {
    const auto now = Clock::now();
    if (running_) Add(now);
    phase_ = static_cast<std::size_t>(phase);
    since_ = now;
    running_ = true;
  }
  void EndTick() override {
    Add(Clock::now());
    running_ = false;
    ++ticks_;
  }
  double NanosecondsPerTick(Phase phase) const {
    return total_[static_cast<std::size_t>(phase)].count() / static_cast<double>(ticks_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  void Add(Clock::time_point now) { total_[phase_] += now - since_; }

  std::array<std::chrono::duration<double, std::nano>, 4> total_{};
  Clock::time_point since_;
  std::size_t phase_ = 0;
  bool running_ = false;
  long ticks_ = 0;
};

ToyScenario Scene(int robots, const Behaviour& behaviour, double half_side, Tick ticks) {
  RandomStream random(7, StreamPurpose::kTest);
  TestCase test_case;
  test_case.obstacles = RandomObstacles(8, random);
  return ToyScenario(test_case, RandomRobots(robots, test_case, Vec2::Zero(), half_side, behaviour, random),
                     ticks);
}

void Run(benchmark::State& state, const Behaviour& behaviour, double half_side) {
  constexpr Tick kTicks = 2000;  // 200 s
  const int robots = static_cast<int>(state.range(0));
  double user = 0.0;
  std::uint64_t seed = 1;
  for (auto _ : state) {
    ToyScenario scenario = Scene(robots, behaviour, half_side, kTicks);
    const double before = UserSeconds();
    benchmark::DoNotOptimize(Simulate(scenario, seed++, false).hash);
    user += UserSeconds() - before;
  }
  std::array<double, 4> phases;
  phases.fill(std::numeric_limits<double>::infinity());
  for (int repeat = 0; repeat < 5; ++repeat) {
    PhaseClock clock;
    ToyScenario scenario = Scene(robots, behaviour, half_side, kTicks);
    Simulate(scenario, 1, false, {.probe = &clock});
    for (std::size_t i = 0; i < phases.size(); ++i) {
      phases[i] = std::min(phases[i], clock.NanosecondsPerTick(static_cast<Phase>(i)));
    }
  }

  const double runs = static_cast<double>(state.iterations());
  state.counters["user_ms_per_run"] = 1e3 * user / runs;
  state.counters["robot_ticks_per_s"] = runs * robots * kTicks / user;
  state.counters["physics_ns"] = phases[0];
  state.counters["observe_ns"] = phases[1];
  state.counters["sense_ns"] = phases[2];
  state.counters["control_ns"] = phases[3];
}

void RandomWalkers(benchmark::State& state) {
  Run(state, RandomWalk(0.1), 2.9);
}
void Crowd(benchmark::State& state) {
  Run(state, Huddle(0.1), 1.5);
}

BENCHMARK(RandomWalkers)->Arg(6)->Arg(11)->Arg(20)->Arg(50)->Unit(benchmark::kMillisecond);
BENCHMARK(Crowd)->Arg(6)->Arg(11)->Arg(20)->Arg(50)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gauntlet::sim

BENCHMARK_MAIN();
