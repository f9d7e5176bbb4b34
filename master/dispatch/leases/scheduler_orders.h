// What the scheduler decides (scheduler.h), for whoever carries it out, and what it answers when it is told
// something.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "master/dispatch/trust/trust_policy.h"
#include "proto/messages.h"

namespace gauntlet {

using proto::Fence;

struct LeaseOrder {
  InstanceId worker = 0;
  proto::Lease lease;
};

struct FenceOrder {
  InstanceId worker = 0;
  Fence fence = 0;
};

// The run ended with this verdict.
struct RunGivenUp : Verdict {
  RunId run = 0;
  std::uint32_t leases = 1;
};

// It gets no more leases, and what it said of unfinished runs does not count.
struct WorkerQuarantined {
  InstanceId worker = 0;
  WorkerRecord record;  // the reason
};

struct WorkerLost {
  InstanceId worker = 0;
  std::vector<RunId> released;  // runs that wait for another worker now
};

// Two answers to the same spec differ: the campaign is nondeterministic.
struct ResultMismatch {
  RunId run = 0;
  InstanceId first_worker = 0;
  InstanceId second_worker = 0;
  std::uint64_t first_hash = 0;  // 0: the run had ended with a verdict of failure
  std::uint64_t second_hash = 0;
};

struct SchedulerOrders {
  std::vector<LeaseOrder> leases;            // send these leases
  std::vector<FenceOrder> cancels;           // tell the worker that the lease is not needed any more
  std::vector<FenceOrder> acknowledgements;  // tell the worker to forget the lease
  std::vector<RunGivenUp> given_up;
  std::vector<WorkerLost> lost;
  std::vector<ResultMismatch> mismatches;
  std::vector<WorkerQuarantined> quarantined;
  std::optional<ReproducibilityNews> reproducibility;
  std::vector<InstanceId> back;       // these were lost, and are heard again
  std::vector<InstanceId> forgotten;  // these lost workers are unknown from now on
};

enum class Answer {
  kAccepted,   // the run's result, or a counted failure
  kDuplicate,  // the run had finished already
  kRepeated,   // the very answer that was accepted, sent again
  kUnwanted,   // nobody waits for it any more
  kRejected,   // names a lease that this worker does not have, or another run than the lease's
};

}  // namespace gauntlet
