// EvaluationBackend without workers: a function answers the runs, which end in whatever order a test likes.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/check.h"
#include "master/dispatch/evaluation_backend.h"
#include "proto/run_codec.h"
#include "tests/support/fake_clock.h"

namespace gauntlet::testing_support {

// Thread-safety: one thread. Waiting advances the clock.
class FakeBackend final : public EvaluationBackend {
 public:
  using Simulate = std::function<sim::RunResult(const sim::RunSpec&)>;
  FakeBackend(FakeClock& clock, Simulate simulate) : clock_(clock), simulate_(std::move(simulate)) {}

  std::size_t slots = 4;     // runs that run at once
  std::size_t per_poll = 1;  // of these, how many end in one Poll
  // Which of `running` runs, in the order of their beginnings, ends next.
  std::function<std::size_t(std::size_t running)> next = [](std::size_t) { return std::size_t{0}; };
  std::optional<Error> failure;  // of every Poll from now on
  WorkerStatistics statistics;
  std::vector<DispatchEvent> events;  // that TakeEvents gives away

  std::vector<RunId> submitted;
  std::vector<RunId> acknowledged;
  bool stopped_leasing = false;

  void Submit(std::vector<RunRequest> runs) override {
    for (RunRequest& run : runs) {
      submitted.push_back(run.id);
      waiting_.push_back(std::move(run));
    }
  }
  Result<std::vector<FinishedRun>> Poll(std::chrono::milliseconds timeout) override {
    if (failure) return *failure;
    clock_.Advance(timeout);
    std::vector<FinishedRun> finished;
    for (std::size_t i = 0; i < per_poll; ++i) {
      while (!stopped_leasing && running_.size() < slots && !waiting_.empty()) {
        running_.push_back(std::move(waiting_.front()));
        waiting_.pop_front();
      }
      if (running_.empty()) break;
      const auto one = running_.begin() + static_cast<std::ptrdiff_t>(next(running_.size()));
      finished.push_back(Finish(*one));
      running_.erase(one);
    }
    constexpr int kMostIdlePolls = 1000;
    idle_polls_ = finished.empty() ? idle_polls_ + 1 : 0;
    GAUNTLET_CHECK(idle_polls_ < kMostIdlePolls, "the campaign waits for runs that nobody has asked for");
    return finished;
  }
  void Acknowledge(const std::vector<RunId>& runs) override {
    acknowledged.insert(acknowledged.end(), runs.begin(), runs.end());
  }
  void Shutdown(std::chrono::milliseconds) override {}
  WorkerStatistics Statistics() const override {
    WorkerStatistics now = statistics;
    now.busy = static_cast<int>(running_.size());
    return now;
  }
  void StopLeasing() override { stopped_leasing = true; }
  std::vector<DispatchEvent> TakeEvents() override { return std::exchange(events, {}); }

 private:
  FinishedRun Finish(const RunRequest& run) const {
    const Result<sim::RunSpec> spec = proto::DecodeRunSpec(run.spec);
    GAUNTLET_CHECK(spec.ok(), "a run that was submitted does not decode");
    FinishedRun finished;
    finished.id = run.id;
    finished.result = simulate_(*spec);
    sim::SetHashes(finished.result);
    finished.worker = "fake";
    return finished;
  }

  FakeClock& clock_;
  Simulate simulate_;
  std::deque<RunRequest> waiting_;
  std::vector<RunRequest> running_;
  int idle_polls_ = 0;
};

}  // namespace gauntlet::testing_support
