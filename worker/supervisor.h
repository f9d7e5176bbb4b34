// The supervisor: carries events from the socket, the runners, signals and the clock to WorkerState, and its
// actions back. Its loop never waits for a simulation.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "proto/access_file.h"
#include "worker/fork_server.h"
#include "worker/worker_state.h"

namespace gauntlet::worker {

struct SupervisorOptions {
  WorkerSettings state;
  std::string access_path;
  // > 0: exit as soon as this process is no longer our parent.
  pid_t parent = 0;
};

class Supervisor {
 public:
  // `signals`: a signalfd of the signals that stop the worker. `fork_server` outlives the supervisor.
  Supervisor(SupervisorOptions options, proto::Access access, ForkServer& fork_server, int signals);
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;
  ~Supervisor();

  // Serves the master until it is time to go; the process' exit code. Messages that cannot be understood are
  // dropped and logged once per kind.
  int Run();

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace gauntlet::worker
