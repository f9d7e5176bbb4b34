// Two numbers between which a quantity lies.
#pragma once

namespace gauntlet::analysis {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

}  // namespace gauntlet::analysis
