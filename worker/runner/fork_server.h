// The fork server: a small process without threads from which all runners are forked. It is itself forked
// before its supervisor starts any thread, because a child of a threaded process may inherit locked locks.
//
//   supervisor --control socket--> fork server --fork--> runner (one per slot)
//        ^------------------ pipe and output of the runner, passed by SCM_RIGHTS
//
// Nobody survives anybody: runners die with the fork server (PR_SET_PDEATHSIG), and the fork server ends with
// the supervisor (the end of the socket), after everything that was ever started below it: it takes orphans
// over (PR_SET_CHILD_SUBREAPER) and ends them.
#pragma once

#include <sys/types.h>

#include <deque>
#include <memory>
#include <optional>
#include <variant>

#include "base/result.h"
#include "worker/runner/pipe.h"
#include "worker/runner/runner.h"

namespace gauntlet::worker {

struct RunnerStarted {
  pid_t pid = -1;
  UniqueFd pipe;    // jobs and reports
  UniqueFd output;  // what the runner prints to stdout and stderr
};
struct RunnerExited {
  pid_t pid = -1;
  int wait_status = 0;
  double cpu_seconds = 0.0;  // user and system time of the runner's whole life
};
struct RunnerNotStarted {
  int error = 0;  // errno
};
struct ForkServerGone {};
using ForkServerEvent = std::variant<RunnerStarted, RunnerExited, RunnerNotStarted, ForkServerGone>;

// The kernel ends this process with its parent, from now on; false when the parent was gone already. Its pid
// must come from itself: whoever asks for it only now may get that of the process that took its orphans over.
bool DieWithParent(pid_t parent);

// The supervisor's handle. Thread-safety: one calling thread, the one that called Start.
class ForkServer {
 public:
  // Forks the server. To be called while the process has one thread only. `plugins`: of its runners. Error:
  // kIo.
  static Result<std::unique_ptr<ForkServer>> Start(const RunFunction& run, const PluginSettings& plugins);
  ForkServer(const ForkServer&) = delete;
  ForkServer& operator=(const ForkServer&) = delete;
  // Ends the server and with it all runners; returns when it is reaped.
  ~ForkServer();

  // Readable when Receive has something.
  int fd() const { return control_.get(); }
  pid_t pid() const { return pid_; }
  // Neither this nor Kill waits: what the socket does not take yet is sent by Flush.
  // Answered by RunnerStarted or RunnerNotStarted.
  void RequestRunner() { Send({}); }
  // A signal to a runner; to nobody when it has ended meanwhile.
  void Kill(pid_t runner, int signal) { Send({runner, signal}); }
  // Sends what waits, as far as possible; again when fd() is writable.
  void Flush();
  bool congested() const { return !unsent_.empty(); }
  // Does not wait. nullopt: nothing has come. After ForkServerGone nothing follows.
  std::optional<ForkServerEvent> Receive();

 private:
  struct Request {
    pid_t runner = 0;  // 0: start one
    int signal = 0;    // to the runner
  };

  ForkServer(pid_t pid, UniqueFd control) : pid_(pid), control_(std::move(control)) {}
  void Send(Request request);

  pid_t pid_;
  UniqueFd control_;
  std::deque<Request> unsent_;
  bool gone_ = false;
};

}  // namespace gauntlet::worker
