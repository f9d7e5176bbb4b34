#include "worker/runner/shifted_clock.h"

#include <dlfcn.h>
#include <sys/time.h>

#include <ctime>

namespace gauntlet::worker {
namespace {

time_t seconds_ahead = 0;

int TrueTime(clockid_t clock, timespec* time) {
  using ClockGettime = int (*)(clockid_t, timespec*);
  static const auto next = reinterpret_cast<ClockGettime>(dlsym(RTLD_NEXT, "clock_gettime"));
  return next(clock, time);
}

}  // namespace

void ShiftTimeOfDay(std::chrono::seconds ahead) {
  seconds_ahead = ahead.count();
}

}  // namespace gauntlet::worker

// Those of this program are found before those of the C library.
extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const int failed = gauntlet::worker::TrueTime(clock, time);
  if (failed == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
    time->tv_sec += gauntlet::worker::seconds_ahead;
  return failed;
}

time_t time(time_t* stored) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME_COARSE, &now);
  if (stored != nullptr) *stored = now.tv_sec;
  return now.tv_sec;
}

int gettimeofday(timeval* __restrict stored, void* __restrict /*timezone*/) noexcept {
  timespec now{};
  const int failed = clock_gettime(CLOCK_REALTIME, &now);
  if (failed == 0) *stored = {.tv_sec = now.tv_sec, .tv_usec = now.tv_nsec / 1000};
  return failed;
}

}  // extern "C"
