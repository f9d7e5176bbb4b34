// A clock that is advanced by hand.
#pragma once

#include "base/system/clock.h"

namespace gauntlet::testing_support {

class FakeClock final : public Clock {
 public:
  TimePoint Now() const override { return now_; }
  void Advance(Duration duration) { now_ += duration; }

 private:
  TimePoint now_ = TimePoint{} + std::chrono::hours(1);
};

}  // namespace gauntlet::testing_support
