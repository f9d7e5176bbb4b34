// The supervisor: carries events from the socket, the runners, signals and the clock to WorkerState, and its
// actions back. Its loop never waits for a simulation.
#pragma once

#include <sys/types.h>

#include <string>

#include "proto/access_file.h"
#include "worker/runner/fork_server.h"
#include "worker/worker_state.h"

namespace gauntlet::worker {

struct SupervisorOptions {
  WorkerSettings state;
  std::string access_path;
  // > 0: exit as soon as this process is no longer our parent.
  pid_t parent = 0;
};

// Serves the master until it is time to go; the process' exit code. `signals`: a signalfd of the signals that
// stop the worker. Messages that cannot be understood are dropped and logged once per kind.
int Supervise(SupervisorOptions options, proto::Access access, ForkServer& fork_server, int signals);

}  // namespace gauntlet::worker
