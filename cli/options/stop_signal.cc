#include "cli/options/stop_signal.h"

#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

namespace gauntlet {
namespace {

std::atomic<int> signals_received{0};
std::atomic<bool> announce{true};
static_assert(std::atomic<int>::is_always_lock_free, "needed in a signal handler");

constexpr int kStoppedExitCode = 3;  // stopped, resumable: whatever is not stored yet is simulated again

// Only async-signal-safe calls.
void HandleSignal(int /*signal*/) {
  const int saved_errno = errno;
  if (signals_received.fetch_add(1) > 0) _exit(kStoppedExitCode);
  constexpr char kMessage[] = "\ngauntlet: stopping cleanly; once more to stop at once\n";
  if (announce) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, kMessage, std::strlen(kMessage));
  }
  errno = saved_errno;
}

}  // namespace

StopSignal::StopSignal(bool announced) {
  signals_received = 0;
  announce = announced;
  struct sigaction action {};
  action.sa_handler = HandleSignal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &old_interrupt_);
  sigaction(SIGTERM, &action, &old_terminate_);
}

StopSignal::~StopSignal() {
  sigaction(SIGINT, &old_interrupt_, nullptr);
  sigaction(SIGTERM, &old_terminate_, nullptr);
}

bool StopSignal::Requested() {
  return signals_received.load() > 0;
}

bool StopSignal::ComesWithin(int milliseconds) {
  if (!Requested()) poll(nullptr, 0, milliseconds);
  return Requested();
}

}  // namespace gauntlet
