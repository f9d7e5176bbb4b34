// What happens to a worker, and what it then does: the events and actions of WorkerState.
#pragma once

#include <string>
#include <variant>

#include "proto/messages.h"
#include "worker/runner/runner.h"

namespace gauntlet::worker {

using namespace proto;  // a worker speaks in the protocol's words

// What happens to the worker. Messages of the master are events too.
struct SlotBecameReady {  // its runner waits for a job
  int slot = 0;
};
struct RunFinished {
  int slot = 0;
  std::string result;  // serialized gauntlet.v1.RunResult
  double cpu_seconds = 0.0;
};
struct RunnerDied {  // SlotBecameReady follows when it is replaced
  int slot = 0;
  RunnerFailure failure;
  double cpu_seconds = 0.0;  // of its first job, which it had not ended
  bool at_work = true;       // false: it had no job; what it was given since has not begun
};
struct NoRunnerStarted {  // for some slot, and tried again; comes again every second or so while that fails
  std::string reason;     // "cannot start a runner: Resource temporarily unavailable (...)"
};
struct AllRunnersLost {};      // the fork server is gone: this process cannot simulate any more
struct MasterMoved {};         // access.json names another endpoint or epoch
struct ConnectionRestored {};  // it broke and stands again: the master does not know yet whose it is
struct StopRequested {         // SIGTERM, SIGINT, SIGHUP; the second one does not wait for runs
  std::string reason;
};
struct ClockTick {};
using WorkerEvent = std::variant<MasterMessage, SlotBecameReady, RunFinished, RunnerDied, NoRunnerStarted,
                                 AllRunnersLost, MasterMoved, ConnectionRestored, StopRequested, ClockTick>;

// What the driver shall do, in this order.
struct Send {
  WorkerMessage message;
};
struct StartRun {  // the slot may have a run already: then after it
  int slot = 0;
  RunnerJob job;
};
struct KillRunner {
  int slot = 0;
};
struct CheckAccess {};  // re-read access.json; when it changed: MasterMoved
struct Reconnect {};    // drop the connection and all that waits to be sent; connect anew
struct Note {           // for the log, once per kind
  std::string kind;
  std::string text;
};
struct Exit {
  int code = 0;
  std::string reason;
};
using WorkerAction = std::variant<Send, StartRun, KillRunner, CheckAccess, Reconnect, Note, Exit>;

}  // namespace gauntlet::worker
