// How much of the time of connected workers is used: an integral over their slots, from event to event.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace gauntlet::master {

class SlotUsage {
 public:
  // One worker's part in the sums; belongs to the worker.
  struct Share {
    std::uint32_t slots = 0;
    std::uint32_t busy = 0;
  };

  // The worker has `slots` slots now and `leases` leases; 0 slots when it is lost or wants no more.
  void Set(Share& share, std::uint32_t slots, std::size_t leases) {
    const auto busy = static_cast<std::uint32_t>(std::min<std::size_t>(slots, leases));
    slots_ = slots_ - share.slots + slots;
    busy_ = busy_ - share.busy + busy;
    share = {slots, busy};
  }

  // Time passes. `waiting`: no run waits for a worker, so idle workers wait for the search.
  void Pass(double seconds, bool waiting) {
    slot_seconds_ += seconds * static_cast<double>(slots_);
    idle_seconds_ += seconds * static_cast<double>(slots_ - busy_);
    if (waiting) barrier_seconds_ += seconds * static_cast<double>(slots_ - busy_);
  }

  double slot_seconds() const { return slot_seconds_; }
  double idle_seconds() const { return idle_seconds_; }
  double barrier_seconds() const { return barrier_seconds_; }  // idle because the search had nothing to give

 private:
  std::uint64_t slots_ = 0;
  std::uint64_t busy_ = 0;
  double slot_seconds_ = 0.0;
  double idle_seconds_ = 0.0;
  double barrier_seconds_ = 0.0;
};

}  // namespace gauntlet::master
