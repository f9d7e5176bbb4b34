// Two numbers between which a quantity lies.
#pragma once

#include "base/check.h"

namespace gauntlet::analysis {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

// GAUNTLET_CHECKs that an interval of this confidence can be had: 0 < confidence < 1.
inline void CheckConfidence(double confidence) {
  GAUNTLET_CHECK(confidence > 0.0 && confidence < 1.0, "a confidence lies between 0 and 1");
}

}  // namespace gauntlet::analysis
