// A clock that is advanced by hand.
#pragma once

#include "base/system/clock.h"

namespace gauntlet::testing_support {

class FakeClock final : public master::Clock {
 public:
  master::TimePoint Now() const override { return now_; }
  void Advance(master::Duration duration) { now_ += duration; }

 private:
  master::TimePoint now_ = master::TimePoint{} + std::chrono::hours(1);
};

}  // namespace gauntlet::testing_support
