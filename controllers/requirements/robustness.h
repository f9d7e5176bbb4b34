// How far a run is from violating what is required of it: the robustness of signal temporal logic (Donze and
// Maler 2010, "Robust satisfaction of temporal logic over real-valued signals"), here scaled to -1 to 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "controllers/requirements/measures.h"
#include "controllers/requirements/sentences.h"

namespace gauntlet::controllers::requirements {

// Whether something holds at a moment. Above 0 it holds, below 0 it does not; at 0 only `holds` says which.
struct Truth {
  double robustness = 0.0;
  bool holds = false;
  std::int32_t decided = 0;  // the sample from which on nothing that follows could change `holds`
  std::int32_t reason = 0;   // the node of the comparison that the robustness is of

  bool operator==(const Truth&) const = default;
};

Truth Not(const Truth& of);
Truth And(const Truth& left, const Truth& right);
Truth Or(const Truth& left, const Truth& right);

// The first and the last sample of a window, counted from the present one, of samples that are `step` ticks
// apart; the last is before the first when no sample lies in it.
struct SampleWindow {
  std::size_t first = 0;
  std::size_t last = 0;
};
SampleWindow SamplesIn(const Window& window, sim::Tick step);

// `signal` at each sample: what holds in all, or in one, of the samples of a window; at the end of the run a
// window is cut. Over nothing, `always` is 1 and `eventually` -1. Window: not before its first.
std::vector<Truth> Always(std::span<const Truth> signal, const SampleWindow& window);
std::vector<Truth> Eventually(std::span<const Truth> signal, const SampleWindow& window);
// `goal` holds in a sample of the window, and `meanwhile` in all samples from the present one to the one
// before it. Over nothing -1.
std::vector<Truth> Until(std::span<const Truth> meanwhile, std::span<const Truth> goal,
                         const SampleWindow& window);

// What is at the beginning of the run, of each of the nodes `wanted`. A comparison a > b has the robustness
// (a - b) / W, cut to -1 to 1, where W is the width of the range that a - b can have by the ranges of its
// measures; a == b has -|a - b| / W. A metric stands for its value at the end of the run, at every moment;
// with one that was not measured, or is no finite number, no comparison holds: -1. `metrics`: the
// scenario's; `values`: the run's.
std::vector<Truth> TruthsOf(std::span<const Node> nodes, std::span<const std::size_t> wanted,
                            const Trace& trace, std::span<const MetricInfo> metrics,
                            std::span<const std::pair<std::string, double>> values);

}  // namespace gauntlet::controllers::requirements
