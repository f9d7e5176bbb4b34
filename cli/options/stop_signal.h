// Ctrl-C and SIGTERM: the first asks the campaign to stop cleanly, the second ends the process at once.
#pragma once

#include <csignal>

namespace gauntlet {

// Installs handlers while it lives; at most one at a time.
class StopSignal {
 public:
  // `announced`: the first signal says that it is obeyed. For commands that have something to stop.
  explicit StopSignal(bool announced = true);
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // True after the first signal.
  static bool Requested();
  // Waits so long, in milliseconds, or until the first signal; as Requested.
  static bool ComesWithin(int milliseconds);

 private:
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
};

}  // namespace gauntlet
