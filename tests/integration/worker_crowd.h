// Hundreds of workers in one thread: they speak the workers' protocol over real sockets, with the campaign's
// keys when it has some, and answer when they are told to.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proto/golden_hashes.h"
#include "sim/run_result.h"
#include "tests/support/process.h"

namespace gauntlet::testing_support {

class WorkerCrowd {
 public:
  // For the campaign in `dir`, whose access.json must be there; `golden_hashes` are those of its workers,
  // whose instances are `first` and those that follow.
  WorkerCrowd(const std::string& dir, int workers, const proto::GoldenHashes& golden_hashes,
              std::uint64_t first = 1);
  WorkerCrowd(const WorkerCrowd&) = delete;
  WorkerCrowd& operator=(const WorkerCrowd&) = delete;
  ~WorkerCrowd();

  // Connects all; true when all have been welcomed.
  bool Join(std::chrono::milliseconds patience);
  // Listens until every worker has a lease that is not answered, and all together at least `leases`; seconds
  // since the call, negative when the time was over before.
  double AwaitLeases(std::size_t leases, std::chrono::milliseconds patience);
  // Answers all leases with this result, as one that took so much CPU time. How many there were.
  std::size_t AnswerAll(const sim::RunResult& result, double cpu_seconds);
  // Every second one says goodbye; all are gone without another word when this object is.
  void SayGoodbye();

 private:
  struct Worker;
  struct Shared;
  void Listen(int wait_ms = 20);
  static void Take(Worker& one);
  void Beat();

  std::uint64_t first_;
  std::unique_ptr<Shared> shared_;  // its context ends after all sockets
  std::vector<std::unique_ptr<Worker>> workers_;
};

// `gauntlet master flocking` for workers whose runs do nothing.
std::unique_ptr<Process> StartNoopMaster(const std::string& dir, const std::string& endpoint, int population,
                                         int replicates, int generations);

}  // namespace gauntlet::testing_support
