// Which runs a margin asks for: stages of fixed size that close in on the value at which failures cross a
// share.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/result.h"
#include "search/experiment/varied_keys.h"
#include "search/margin/monotone_fit.h"

namespace gauntlet {

struct MarginPlan {
  static constexpr std::size_t kFirstValues = 6;  // at even distances over the range, its ends among them
  static constexpr std::size_t kCasesEach = 20;   // at each value of a stage
  static constexpr int kLeastRuns = 200;          // fewer leave hardly any interval within the range

  VariedKey key;  // of numbers
  int runs = 0;   // at most
  double share = 0.5;
  std::size_t cases = 0;
};

// Of experiment.margin. Error: that of ParseVariedKeys; the key is of no number, or none that changes what
// happens in a given case; too few runs, and how many are needed.
Result<MarginPlan> MakeMarginPlan(const Experiment& experiment, std::span<const Key> keys, std::size_t cases);

struct MarginRun {
  double value = 0.0;
  std::size_t of_case = 0;  // from 0
};

// What is known at one value.
struct MarginLevel {
  double value = 0.0;
  int runs = 0;
  int failures = 0;
  double fit = 0.0;  // the failure probability of the monotone fit
};

// What is known of a range. Ends are infinite where they may lie outside.
struct MarginEstimate {
  bool falls = false;  // failures become rarer as the value grows
  double low = 0.0;    // value
  double high = 0.0;
  double estimate = 0.0;
  double design_effect = 1.0;
  std::vector<MarginLevel> levels = {};  // by value
};

// Pure: the same runs for the same outcomes. The cases are gone through in turn, those of a stage are the
// same at each of its values.
class MarginStages {
 public:
  explicit MarginStages(MarginPlan plan) : plan_(std::move(plan)) {}

  const MarginPlan& plan() const { return plan_; }
  std::size_t stages() const { return stages_; }
  int asked() const { return asked_; }
  // Of the next stage, once all runs of the last are told; empty at the end.
  std::vector<MarginRun> Next();
  // nullopt: it ended without a result.
  void Tell(const MarginRun& run, std::optional<bool> failed);

  int without_result() const { return without_result_; }
  // Where a value stands, 0 at the low end to 1 at the high one.
  double PlaceOf(double value) const;
  // nullopt: no run has a result.
  std::optional<MarginEstimate> Estimate() const;

 private:
  // Rounded to what can be told apart: a whole number, or three to four digits of the range.
  double ValueAt(double place) const;
  std::vector<double> NextValues() const;

  struct Outcome {
    MarginRun run;
    bool failed = false;
  };

  const MarginPlan plan_;
  std::size_t stages_ = 0;
  int asked_ = 0;
  std::size_t next_case_ = 0;
  int without_result_ = 0;
  std::vector<Outcome> outcomes_;
};

}  // namespace gauntlet
