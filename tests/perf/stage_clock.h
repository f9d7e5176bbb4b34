// Where the time of a run goes.
#pragma once

#include <x86intrin.h>

#include <array>
#include <cstdint>
#include <string>

#include "sim/simulation.h"

namespace gauntlet::perf {

// Adds up the time between the marks of a simulation, in ticks of the processor's time stamp counter, less
// what a mark itself costs.
class StageClock final : public sim::PhaseProbe {
 public:
  // The phases, then what each sensor takes of its phase; the rest of that phase is what sensors share.
  static constexpr std::size_t kPhases = 7;
  static constexpr std::size_t kStages = kPhases + sim::kDevices.size();

  void Begin(sim::Phase phase) override { Enter(static_cast<std::size_t>(phase)); }
  void BeginDevice(sim::Device device) override { Enter(kPhases + sim::IndexOf(device)); }
  void EndTick() override { Stop(); }
  // After a run.
  void Stop() {
    Add(__rdtsc());
    running_ = false;
  }

  // Of the whole, in [0, 1].
  double ShareOf(std::size_t stage) const {
    double all = 0.0;
    for (std::size_t i = 0; i < kStages; ++i) all += NetOf(i);
    return NetOf(stage) / all;
  }
  static std::string NameOf(std::size_t stage) {
    static constexpr std::array<const char*, kPhases> kNames = {
        "setting up, planning", "physics",     "recording", "scenario",
        "sensing, shared",      "controllers", "result"};
    if (stage < kPhases) return kNames[stage];
    return "sensing, " + std::string(sim::kDevices[stage - kPhases].key);
  }

 private:
  void Enter(std::size_t stage) {
    const std::uint64_t now = __rdtsc();
    Add(now);
    stage_ = stage;
    since_ = now;
    running_ = true;
  }
  void Add(std::uint64_t now) {
    if (!running_) return;
    total_[stage_] += static_cast<double>(now - since_);
    ++marks_[stage_];
  }
  double NetOf(std::size_t stage) const {
    return std::max(0.0, total_[stage] - CostOfMark() * static_cast<double>(marks_[stage]));
  }
  static double CostOfMark() {
    static const double cost = [] {
      StageClock clock;
      sim::PhaseProbe& probe = clock;
      for (int i = 0; i < 100000; ++i) probe.Begin(sim::Phase::kPhysics);
      return clock.total_[1] / static_cast<double>(clock.marks_[1]);
    }();
    return cost;
  }

  std::array<double, kStages> total_{};
  std::array<std::uint64_t, kStages> marks_{};
  std::uint64_t since_ = 0;
  std::size_t stage_ = 0;
  bool running_ = false;
};

}  // namespace gauntlet::perf
