#include "worker/supervisor.h"

#include <fmt/format.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "base/check.h"
#include "proto/message_codec.h"
#include "proto/run_failure.h"
#include "worker/connection.h"
#include "worker/runner/runner_pool.h"

namespace gauntlet::worker {
namespace {

using std::chrono::milliseconds;

// How many messages of the master are worked off before runners and clock get their turn.
constexpr int kMessagesPerTurn = 256;
// The parent is looked after at least this often.
constexpr milliseconds kLongestWait{1000};

class Supervisor {
 public:
  Supervisor(SupervisorOptions options, Access access, ForkServer& fork_server, int signals)
      : options_(std::move(options)),
        access_(std::move(access)),
        signals_(signals),
        pool_(fork_server, static_cast<int>(options_.state.identity.slots)),
        state_(options_.state, std::chrono::steady_clock::now()) {}

  int Run() {
    if (!Connect()) return *exit_code_;
    Perform(state_.Start());
    while (!exit_code_) {
      Wait();
      if (options_.parent > 0 && getppid() != options_.parent) {
        spdlog::info("the parent process is gone");
        return kExitDone;
      }
      ReadSignals();
      if (connection_.TakeRestored()) {
        LogOnce("restored", "the connection to the master broke and stands again: saying hello again");
        Tell(ConnectionRestored{});
      }
      connection_.Flush();
      ReadMessages();
      HandlePoolEvents();
      Tell(ClockTick{});
    }
    connection_.Flush();
    return *exit_code_;
  }

 private:
  void Wait() {
    // What was decided since goes now, all at once.
    connection_.Flush();
    pool_.Flush();
    if (const auto nap = state_.Nap(); nap > nap.zero()) std::this_thread::sleep_for(nap);
    polled_ = pool_.Descriptors();
    polled_.push_back({.fd = signals_, .events = POLLIN, .revents = 0});
    polled_.push_back({.fd = connection_.monitor_fd(), .events = POLLIN, .revents = 0});
    polled_.push_back({.fd = connection_.fd(), .events = POLLIN, .revents = 0});
    message_came_ = connection_.Readable();
    if (connection_.congested()) {
      connection_.Flush();
      message_came_ = message_came_ || connection_.Readable();
    }
    const auto until_tick =
        std::chrono::ceil<milliseconds>(state_.NextTick() - std::chrono::steady_clock::now());
    const milliseconds timeout =
        message_came_ ? milliseconds(0) : std::clamp(until_tick, milliseconds(0), kLongestWait);
    const bool interrupted = poll(polled_.data(), polled_.size(), static_cast<int>(timeout.count())) < 0;
    GAUNTLET_CHECK(!interrupted || errno == EINTR, fmt::format("poll: {}", std::strerror(errno)));
    if (interrupted) {
      for (pollfd& item : polled_) item.revents = 0;
    }
    const bool connection_changed = polled_.back().revents != 0;
    polled_.resize(polled_.size() - 2);
    signal_came_ = interrupted || polled_.back().revents != 0;
    polled_.pop_back();
    message_came_ = message_came_ || interrupted || (connection_changed && connection_.Readable());
  }

  void ReadSignals() {
    if (!signal_came_) return;
    signalfd_siginfo info{};
    while (read(signals_, &info, sizeof info) == static_cast<ssize_t>(sizeof info)) {
      const char* name = sigabbrev_np(static_cast<int>(info.ssi_signo));
      Tell(StopRequested{fmt::format("SIG{}", name != nullptr ? name : "?")});
    }
  }

  void ReadMessages() {
    if (!message_came_) return;
    for (int i = 0; i < kMessagesPerTurn && !exit_code_; ++i) {
      const std::optional<std::string> frame = connection_.Receive();
      if (!frame) return;
      Result<MasterMessage> message = DecodeMasterMessage(*frame);
      if (!message.ok()) {
        LogOnce("bad-message",
                fmt::format("dropped: {} (further ones are not logged)", message.error().message));
        continue;
      }
      const bool was_welcomed = state_.welcomed();
      Tell(std::move(*message));
      if (!was_welcomed && state_.welcomed()) spdlog::info("welcomed by {}", endpoint_);
    }
  }

  void HandlePoolEvents() {
    for (WorkerEvent& event : pool_.Process(polled_, std::chrono::steady_clock::now())) {
      if (const auto* died = std::get_if<RunnerDied>(&event)) {
        const Lease* lease = state_.LeaseIn(died->slot);
        // Without a lease it was this worker that ended the runner: its run is not needed any more.
        if (lease != nullptr && died->at_work) {
          spdlog::warn("slot {}: the runner {} (run {}, lease {:x})", died->slot, Describe(died->failure),
                       lease->run_id, lease->fence);
        }
      } else if (const auto* not_started = std::get_if<NoRunnerStarted>(&event)) {
        LogOnce(not_started->reason, fmt::format("{}; trying again", not_started->reason));
      } else if (std::holds_alternative<AllRunnersLost>(event)) {
        spdlog::error("the fork server ended: this worker cannot simulate any more");
      }
      Tell(std::move(event));
    }
  }

  void Tell(WorkerEvent event) { Perform(state_.Handle(std::move(event), std::chrono::steady_clock::now())); }

  void Perform(std::vector<WorkerAction> actions) {
    for (WorkerAction& action : actions) {
      if (exit_code_) return;
      std::visit([this](auto& concrete) { Do(concrete); }, action);
    }
  }

  void Do(const Send& send) {
    // A heartbeat that cannot leave now says nothing later.
    if (std::holds_alternative<Heartbeat>(send.message)) {
      connection_.Flush();
      if (connection_.congested()) return;
    }
    connection_.Send(EncodeWorkerMessage(send.message));
  }
  void Do(const StartRun& start) { pool_.StartJob(start.slot, start.job); }
  void Do(const KillRunner& kill) { pool_.Kill(kill.slot); }
  void Do(const CheckAccess&) {
    if (RereadAccess()) Tell(MasterMoved{});
  }
  void Do(const Reconnect&) {
    RereadAccess();
    if (!exit_code_) Connect();
  }
  void Do(const Note& note) { LogOnce(note.kind, fmt::format("{} ({})", note.text, endpoint_)); }
  void Do(const Exit& exit) {
    spdlog::log(exit.code == kExitDone ? spdlog::level::info : spdlog::level::err, "{}: {}",
                exit.code == kExitRefused ? "refused by the master" : "leaving", exit.reason);
    exit_code_ = exit.code;
  }

  // True when the master can now be found elsewhere.
  bool RereadAccess() {
    Result<Access> access = ReadAccess(options_.access_path);
    if (!access.ok()) {
      // While a master restarts there may be no file.
      if (access.error().kind != ErrorKind::kNotFound) LogOnce("access", access.error().message);
      return false;
    }
    if (access->campaign_id != access_.campaign_id) {
      spdlog::error("{} belongs to campaign {} now, this worker serves {}", options_.access_path,
                    access->campaign_id, access_.campaign_id);
      exit_code_ = kExitRefused;
      return false;
    }
    if (*access == access_) return false;
    access_ = std::move(*access);
    next_endpoint_ = 0;
    return true;
  }

  bool Connect() {
    endpoint_ = access_.endpoints[next_endpoint_++ % access_.endpoints.size()];
    const Status opened = connection_.Open(endpoint_, access_.curve);
    if (opened.ok()) {
      spdlog::debug("connecting to {}", endpoint_);
      return true;
    }
    spdlog::error("{}: {}", options_.access_path, opened.error().message);
    exit_code_ = kExitRefused;
    return false;
  }

  void LogOnce(const std::string& kind, const std::string& text) {
    if (logged_.insert(kind).second) spdlog::warn("{}", text);
  }

  SupervisorOptions options_;
  Access access_;
  int signals_;
  std::size_t next_endpoint_ = 0;  // modulo their number; a changed access.json is tried from its first one
  std::string endpoint_;
  Connection connection_;
  RunnerPool pool_;
  WorkerState state_;
  bool message_came_ = false;
  bool signal_came_ = false;
  std::vector<pollfd> polled_;
  std::set<std::string> logged_;
  std::optional<int> exit_code_;
};

}  // namespace

int Supervise(SupervisorOptions options, Access access, ForkServer& fork_server, int signals) {
  return Supervisor(std::move(options), std::move(access), fork_server, signals).Run();
}

}  // namespace gauntlet::worker
