// What the scheduler (scheduler.h) knows of runs, leases and workers.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "base/system/clock.h"
#include "master/dispatch/leases/scheduler_orders.h"

namespace gauntlet::scheduling {

enum class LeaseState { kLive, kOrphaned, kCancelled, kAnswered };
struct Lease {
  RunId run = 0;
  InstanceId worker = 0;
  LeaseState state = LeaseState::kLive;
  Duration granted{};
  Duration begun{};  // at the earliest: when it came to be among as many as the worker has slots
  bool result_may_wait = false;
};
struct Place {  // in the queue
  std::uint64_t batch = 0;
  double length = 0.0;
  RunId run = 0;
  bool operator<(const Place& other) const {
    return std::tie(batch, other.length, run) < std::tie(other.batch, length, other.run);
  }
};
struct Run {
  proto::EncodedSpec spec;  // empty when the run has finished and its audit is not open
  std::uint64_t batch = 0;
  double length = 0.0;
  std::vector<Fence> fences;  // live, orphaned and cancelled leases
  std::uint32_t live = 0;
  std::uint32_t leases = 0;  // given so far
  bool finished = false;
  bool given_up = false;
  bool killed = false;  // given up, and always ended from outside
  bool acknowledged = false;
  bool audit = false;  // is to be simulated once more, and has not been
  std::uint32_t audit_failures = 0;
  Duration audit_from{};  // a lease that was given before is no audit
  Fence accepted = 0;
  InstanceId finished_by = 0;
  std::uint64_t hash = 0;
};
struct Worker {
  std::uint32_t slots = 1;
  std::vector<Fence> live;   // in the order in which they were given, which is that of its work
  std::vector<Fence> loose;  // orphaned and cancelled
  Duration heard{};
  Duration pace{};     // the time between its heartbeats, at most
  Duration excused{};  // value of listening_ at the last excuse
  bool lost = false;
  bool draining = false;
  bool blocked = false;     // the last lease could not be delivered
  bool filled = false;      // was given as many leases as it may have, and has not worked off half of them
  Duration slowed_until{};  // when it next gets a lease if it is a black hole
  // Its part in the sums slots_ and busy_.
  std::uint32_t counted_slots = 0;
  std::uint32_t counted_busy = 0;
  // Its place in available_, when it has one.
  bool listed = false;
  std::uint32_t level = 0;
};

}  // namespace gauntlet::scheduling
