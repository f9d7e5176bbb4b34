// What a search has seen of how often its layouts fail, and what may be expected of one that failed a few
// times: where most layouts fail now and then, a few failures in a row are often luck.
#pragma once

#include <cstdint>

#include "base/canonical_encoder.h"
#include "search/failure_tally.h"

namespace gauntlet {

// The probabilities with which layouts fail are taken for draws from one Beta distribution, which is
// estimated by its moments (empirical Bayes): from the share of first runs that fail, and from the share of
// second runs that fail of layouts whose first run did. Before there are any, one of three first runs and two
// of three second runs count as failed.
class FailurePrior {
 public:
  // A layout with the runs `before` has had `more`, as many as it is given at a time.
  void Learn(const FailureTally& before, const FailureTally& more);

  // The probability with which a layout with these runs fails next.
  double Expected(const FailureTally& tally) const;

  void Save(CanonicalEncoder& encoder) const;
  void Restore(CanonicalDecoder& decoder);

 private:
  struct Count {
    std::uint64_t failures = 0;
    std::uint64_t runs = 0;
    void Add(const FailureTally& more);
    double Share(double failures_before) const;
  };

  Count first_;
  Count second_;
};

}  // namespace gauntlet
