// How a failure probability is found: first plain samples of the conditions; where these hardly ever fail and
// their robustness follows the conditions, repeats of adaptive multilevel splitting; else plain samples on.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/statistics/interval.h"
#include "search/probability/conditions.h"
#include "search/probability/splitting.h"
#include "search/settings/settings_course.h"

namespace gauntlet {

// Why samples are drawn as they are.
enum class SamplingReason {
  kFirst,        // plain ones come first
  kFrequent,     // failures are frequent enough for plain ones
  kAsked,        // plain ones were asked for
  kNoScore,      // nothing says how near to failing a run was: there are no [requirements]
  kSeedDecides,  // what nearly failed fails no more often than others when its seed is drawn anew
  kFewRuns,      // too few are left for splitting
  kSplitting,    // splitting
  kDearer,       // a first round of splitting took more runs than plain ones would have
};

enum class ProbabilityEnd { kOpen, kNarrow, kBelow, kAbove, kBudget };

// A failed run's share of the estimate.
struct FailedSample {
  std::uint64_t number = 0;  // of the sample, from 1
  double share = 0.0;        // of all they sum to 1
  std::size_t repeat = 0;    // of splitting, from 0
};

struct ProbabilityEstimate {
  double estimate = 0.0;
  analysis::Interval interval;       // at 95 %
  std::vector<double> repeats = {};  // of splitting; none: plain
  bool valid_at_any_time = false;    // the interval is one of a confidence sequence
};
// Of the repeats of splitting, on the logarithmic scale (Student's t); two at least.
ProbabilityEstimate EstimateOfRepeats(std::vector<double> repeats, double confidence);

// Pure: the same runs for the same outcomes.
class ProbabilityCourse final : public SettingsCourse {
 public:
  // Plain samples come first; those of the first tenth of the budget decide what follows.
  static constexpr std::uint64_t kFirstRuns = 1000;  // of a stage; a tenth of the budget, if that is less
  static constexpr std::uint64_t kFrequent = 10;     // failures of these
  // What nearly failed, the hundred lowest of them, is run again with other seeds; splitting is tried where
  // the probability that such a run comes nearer to failing than any other is at least so high.
  static constexpr double kLeastPull = 0.7;
  static constexpr std::size_t kRepeats = 10;         // of splitting, at once
  static constexpr std::size_t kMostParticles = 200;  // of each
  static constexpr std::size_t kLeastParticles = 20;

  // `failing`: as FailingOf gives it.
  ProbabilityCourse(const SearchSetup& setup, Conditions conditions, std::string_view failing);

  const Conditions& conditions() const { return conditions_; }
  SamplingReason reason() const { return reason_; }
  ProbabilityEnd end() const { return end_; }
  std::uint64_t runs() const { return asked_; }
  std::uint64_t plain_runs() const { return plain_; }
  std::uint64_t plain_failures() const { return plain_failed_.size(); }
  std::uint64_t without_result() const { return without_result_; }  // they count as failed
  std::uint64_t refused() const { return refused_; }                // they do not
  double pull() const { return pull_; }                             // 0: not measured
  // By the samples that count: those of splitting once a repeat of each has come to its end.
  ProbabilityEstimate Estimate(double confidence) const;
  // Of splitting that has not come to its end: the probability is hardly above it.
  std::optional<double> Reached() const;
  std::vector<FailedSample> Failed() const;
  Sample SampleOf(std::uint64_t number) const;

  const std::vector<VariedKey>& varied() const override { return conditions_.varied(); }
  std::vector<KeyValue> ValuesOf(std::size_t setting) const override;
  std::optional<sim::TestCase> CaseOf(std::size_t setting) const override;
  std::vector<SettingsRun> Next() override;
  void Tell(const SettingsRun& run, const RunOutcome& outcome) override;
  bool AtEnd() const override { return end_ != ProbabilityEnd::kOpen; }
  std::size_t stages() const override { return stages_; }
  std::uint64_t RunsPlanned() const override { return budget_; }
  bool WantsMetrics() const override { return true; }
  bool Once() const override { return true; }

 private:
  enum class Phase { kPlain, kAgain, kSplitting };
  struct Asked {
    std::uint64_t sample = 0;
    std::size_t repeat = 0;
    SplittingRun run;
  };

  void Ask(std::optional<Sample> sample, Asked asked);
  void AskPlain();
  void AskAgain();
  void AskSplitting();
  void BeginSplitting();
  void StageTold();
  void ChooseMethod();
  void RoundOfSplittingTold();
  ProbabilityEnd EndOf(const ProbabilityEstimate& estimate) const;
  std::uint64_t left() const { return budget_ - asked_; }

  const Conditions conditions_;
  const ProbabilitySpec spec_;
  const std::string_view failing_;
  const bool scored_;
  const std::uint64_t seed_;
  const std::uint64_t budget_;
  Phase phase_ = Phase::kPlain;
  SamplingReason reason_ = SamplingReason::kFirst;
  ProbabilityEnd end_ = ProbabilityEnd::kOpen;
  std::size_t stages_ = 0;
  std::uint64_t asked_ = 0;
  std::size_t told_ = 0;                     // of the stage
  std::vector<Asked> stage_;                 // in the order of Next
  std::map<std::uint64_t, Sample> samples_;  // those that are no plain ones
  std::uint64_t plain_ = 0;
  std::vector<std::uint64_t> plain_failed_;
  std::vector<std::pair<double, std::uint64_t>> scores_;  // of the first plain ones, with their numbers
  std::vector<double> again_;
  std::uint64_t without_result_ = 0;
  std::uint64_t refused_ = 0;
  double pull_ = 0.0;
  std::size_t particles_ = 0;
  std::vector<Splitting> repeats_;
  std::size_t finished_repeats_ = 0;  // all of these count
};

}  // namespace gauntlet
