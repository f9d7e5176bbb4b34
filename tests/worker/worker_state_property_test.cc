// The supervisor's decisions under any order of events.
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "tests/worker/worker_state_fixture.h"

namespace gauntlet::worker {
namespace {

using std::chrono::milliseconds;

// Whatever happens in whatever order: every lease that was taken ends as exactly one kind of thing - still
// held, acknowledged or cancelled - no slot runs two leases unless runs are short, no lease is in two, and
// what failed before gets a runner that has simulated nothing.
RC_GTEST_PROP(WorkerStateProperty, NoLeaseIsLostAndNoneRunsTwice, ()) {
  const auto slots = *rc::gen::inRange(1, 4);
  Worker worker = WelcomedWorker(static_cast<std::uint32_t>(slots));
  std::set<Fence> taken;
  std::set<Fence> released;
  const double cpu_seconds = *rc::gen::element(0.5, 1e-4);
  std::map<int, std::deque<std::string>> busy;
  std::set<int> dying;
  std::set<int> used;              // slots whose runner has had a run
  std::set<std::string> repeated;  // of leases that are not the first of their run
  Fence next = 1;
  const auto note = [&](const std::vector<WorkerAction>& actions) {
    for (const WorkerAction& action : actions) {  // in order: a killed runner's runs go elsewhere at once
      if (const auto* start = std::get_if<StartRun>(&action)) {
        RC_ASSERT(!dying.contains(start->slot));
        for (const auto& [other, specs] : busy) {
          RC_ASSERT(std::find(specs.begin(), specs.end(), start->job.spec) == specs.end());
        }
        RC_ASSERT(used.insert(start->slot).second || !repeated.contains(start->job.spec));
        busy[start->slot].push_back(start->job.spec);
        RC_ASSERT(busy[start->slot].size() <= (cpu_seconds < 1e-3 ? 10U : 1U));
      } else if (const auto* kill = std::get_if<KillRunner>(&action)) {
        RC_ASSERT(busy.erase(kill->slot) == 1U || (used.contains(kill->slot) && !repeated.empty()));
        dying.insert(kill->slot);
      }
    }
  };
  const int steps = *rc::gen::inRange(1, 60);
  for (int step = 0; step < steps; ++step) {
    const int slot = *rc::gen::inRange(0, slots);
    switch (*rc::gen::inRange(0, 10)) {
      case 0:
      case 7:
      case 8:
        if (worker.state().welcomed()) taken.insert(next);
        if (*rc::gen::inRange(0, 4) == 0) repeated.insert("spec" + std::to_string(next));
        note(worker.Lease(next, repeated.contains("spec" + std::to_string(next)) ? 2 : 1,
                          *rc::gen::element(milliseconds(0), milliseconds(500))));
        ++next;
        break;
      case 1:
        if (!busy.contains(slot)) break;
        busy[slot].pop_front();
        if (busy[slot].empty()) busy.erase(slot);
        note(worker.Finish(slot, "result", cpu_seconds));
        break;
      case 2: {
        const bool was_busy = busy.erase(slot) == 1;
        if (!was_busy && !dying.erase(slot)) break;
        note(worker.Do(RunnerDied{slot, {FailureKind::kCrashed, 6, 0, ""}, 0.1}));
        used.erase(slot);
        note(worker.Do(SlotBecameReady{slot}));
        break;
      }
      case 3: {
        const Fence fence = *rc::gen::inRange<Fence>(1, next + 1);
        released.insert(fence);
        note(worker.Hear(Acknowledge{{fence}}));
        break;
      }
      case 4: {
        const Fence fence = *rc::gen::inRange<Fence>(1, next + 1);
        released.insert(fence);
        note(worker.Hear(Cancel{fence}));
        break;
      }
      case 5:
        note(worker.Pass(milliseconds(*rc::gen::inRange(1, 12'000))));
        break;
      case 9:
        note(worker.Do(ConnectionRestored{}));
        break;
      default:
        note(worker.Hear(Welcome{}));
        break;
    }
  }
  std::set<Fence> expected;
  for (const Fence fence : taken) {
    if (!released.contains(fence)) expected.insert(fence);
  }
  const auto held = worker.state().HeldLeases();
  const std::set<Fence> held_set(held.begin(), held.end());
  RC_ASSERT(held.size() == held_set.size());
  // A fence released before it was leased may be held.
  for (const Fence fence : expected) RC_ASSERT(held_set.contains(fence));
  for (const Fence fence : held_set) RC_ASSERT(taken.contains(fence));
}

}  // namespace
}  // namespace gauntlet::worker
