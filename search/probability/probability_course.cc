#include "search/probability/probability_course.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "controllers/requirements/requirements.h"
#include "search/failure_tally.h"
#include "search/probability/confidence_sequence.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

constexpr double kConfidence = 0.95;
constexpr double kDeepest = 11.5;  // minus the logarithm of the rarest failure that particles are planned for
constexpr std::uint64_t kLeastStage = 100;
constexpr std::uint64_t kMostStage = 5000;
constexpr std::size_t kAgain = 100;  // runs of what nearly failed

std::uint64_t FirstStage(std::uint64_t budget) {
  return std::clamp(budget / 10, kLeastStage, ProbabilityCourse::kFirstRuns);
}

// The probability that one of the first comes lower than one of the others, ties counting half.
double ProbabilityOfLower(std::span<const double> first, std::vector<double> others) {
  std::ranges::sort(others);
  double sum = 0.0;
  for (const double one : first) {
    const auto [low, high] = std::equal_range(others.begin(), others.end(), one);
    sum += static_cast<double>(others.end() - high) + static_cast<double>(high - low) / 2.0;
  }
  return sum / static_cast<double>(first.size() * others.size());
}

}  // namespace

ProbabilityEstimate EstimateOfRepeats(std::vector<double> repeats, double confidence) {
  const auto count = static_cast<double>(repeats.size());
  const double mean = std::accumulate(repeats.begin(), repeats.end(), 0.0) / count;
  if (mean == 0.0) return {.repeats = std::move(repeats)};
  // The spread of the logarithms, which does not follow the mean as that of the repeats does; but of what is
  // 0 there is none.
  const bool logs = std::ranges::count(repeats, 0.0) == 0;
  const auto scaled = [&](double one) { return logs ? sim::Log(one / mean) : one / mean - 1.0; };
  double sum = 0.0;
  for (const double one : repeats) sum += scaled(one);
  double squares = 0.0;
  for (const double one : repeats) squares += (scaled(one) - sum / count) * (scaled(one) - sum / count);
  const double variance = squares / (count - 1.0);
  const double relative = std::sqrt((logs ? sim::Exp(variance) - 1.0 : variance) / count);
  const double reach =
      sim::Exp(StudentQuantile(0.5 + confidence / 2.0, static_cast<int>(repeats.size()) - 1) * relative);
  return {.estimate = mean,
          .interval = {mean / reach, std::min(1.0, mean * reach)},
          .repeats = std::move(repeats)};
}

ProbabilityCourse::ProbabilityCourse(const SearchSetup& setup, Conditions conditions,
                                     std::string_view failing)
    : conditions_(std::move(conditions)),
      spec_(setup.experiment.probability),
      failing_(failing),
      scored_(!setup.experiment.requirements.empty()),
      seed_(SearchSeed(setup)),
      budget_(static_cast<std::uint64_t>(spec_.runs)) {}

Sample ProbabilityCourse::SampleOf(std::uint64_t number) const {
  if (const auto found = samples_.find(number); found != samples_.end()) return found->second;
  return conditions_.Draw(GenomeStream(seed_, number));
}

std::vector<KeyValue> ProbabilityCourse::ValuesOf(std::size_t setting) const {
  return conditions_.ValuesOf(SampleOf(setting + 1));
}

std::optional<sim::TestCase> ProbabilityCourse::CaseOf(std::size_t setting) const {
  return conditions_.CaseOf(SampleOf(setting + 1));
}

void ProbabilityCourse::Ask(std::optional<Sample> sample, Asked asked) {
  asked.sample = ++asked_;
  if (sample) samples_.emplace(asked_, std::move(*sample));
  stage_.push_back(asked);
}

void ProbabilityCourse::AskPlain() {
  const std::uint64_t wanted = reason_ == SamplingReason::kFirst
                                   ? FirstStage(budget_)
                                   : std::clamp(plain_ / 10, kLeastStage, kMostStage);
  for (std::uint64_t i = std::min(wanted, left()); i > 0; --i) Ask(std::nullopt, {});
}

void ProbabilityCourse::AskAgain() {
  std::ranges::stable_sort(scores_);
  for (std::size_t i = 0; i < std::min(kAgain, scores_.size() / 10) && left() > 0; ++i)
    Ask(SampleOf(scores_[i].second), {});
}

void ProbabilityCourse::AskSplitting() {
  for (std::size_t repeat = finished_repeats_; repeat < repeats_.size(); ++repeat) {
    for (const SplittingRun& run : repeats_[repeat].Next()) {
      if (left() == 0) return;
      const sim::RandomStream random(seed_, sim::StreamPurpose::kVariation,
                                     static_cast<std::uint32_t>(asked_ + 1));
      Sample sample =
          run.near == kFreshSample ? conditions_.Draw(random) : conditions_.Near(SampleOf(run.near), random);
      Ask(std::move(sample), {.repeat = repeat, .run = run});
    }
  }
}

void ProbabilityCourse::BeginSplitting() {
  for (std::size_t i = 0; i < kRepeats; ++i) {
    const auto number = static_cast<std::uint32_t>(repeats_.size());
    repeats_.emplace_back(particles_, sim::RandomStream(seed_, sim::StreamPurpose::kProposals, number));
  }
}

std::vector<SettingsRun> ProbabilityCourse::Next() {
  stage_.clear();
  told_ = 0;
  if (AtEnd()) return {};
  ++stages_;
  if (phase_ == Phase::kPlain) AskPlain();
  if (phase_ == Phase::kAgain) AskAgain();
  if (phase_ == Phase::kSplitting) AskSplitting();
  std::vector<SettingsRun> runs;
  for (const Asked& asked : stage_) runs.push_back({asked.sample - 1, SampleOf(asked.sample).of_case});
  return runs;
}

void ProbabilityCourse::Tell(const SettingsRun& /*run*/, const RunOutcome& outcome) {
  const Asked& asked = stage_[told_++];
  const bool refused = outcome.verdict == sim::Verdict::kRefused;
  const bool failed = refused ? false : !outcome.completed() || Fails(outcome, failing_);
  if (refused) ++refused_;
  if (!refused && !outcome.completed()) ++without_result_;
  double score = controllers::ReportedValue(outcome.metrics, controllers::requirements::kRobustness)
                     .value_or(std::numeric_limits<double>::infinity());
  if (std::isnan(score)) score = std::numeric_limits<double>::infinity();
  const double with_failed = failed ? -std::numeric_limits<double>::infinity() : score;
  if (phase_ == Phase::kPlain) {
    ++plain_;
    if (failed) plain_failed_.push_back(asked.sample);
    if (reason_ == SamplingReason::kFirst) scores_.emplace_back(with_failed, asked.sample);
  } else if (phase_ == Phase::kAgain) {
    again_.push_back(with_failed);
  } else {
    repeats_[asked.repeat].Tell(asked.run, asked.sample, score, failed);
  }
  if (told_ == stage_.size()) StageTold();
}

void ProbabilityCourse::ChooseMethod() {
  if (phase_ == Phase::kPlain) {
    reason_ = spec_.plain                         ? SamplingReason::kAsked
              : plain_failed_.size() >= kFrequent ? SamplingReason::kFrequent
              : !scored_                          ? SamplingReason::kNoScore
                                                  : SamplingReason::kFirst;
    if (reason_ == SamplingReason::kFirst && 10 * plain_ >= budget_) phase_ = Phase::kAgain;
    return;
  }
  std::vector<double> first;
  for (const auto& [score, sample] : scores_) first.push_back(score);
  pull_ = ProbabilityOfLower(again_, std::move(first));
  const double each = 1.0 + Splitting::kSteps * kDeepest;
  particles_ =
      std::min(kMostParticles, static_cast<std::size_t>(static_cast<double>(left()) / kRepeats / each));
  reason_ = pull_ < kLeastPull             ? SamplingReason::kSeedDecides
            : particles_ < kLeastParticles ? SamplingReason::kFewRuns
                                           : SamplingReason::kSplitting;
  phase_ = reason_ == SamplingReason::kSplitting ? Phase::kSplitting : Phase::kPlain;
  if (phase_ == Phase::kSplitting) BeginSplitting();
  scores_.clear();
}

void ProbabilityCourse::RoundOfSplittingTold() {
  const std::uint64_t split = asked_ - plain_ - again_.size();
  const std::uint64_t rounds = repeats_.size() / kRepeats;
  finished_repeats_ = repeats_.size();
  const ProbabilityEstimate known = Estimate(kConfidence);
  end_ = EndOf(known);
  if (AtEnd()) return;
  // As wide as it would be of as many plain samples.
  const double plain_reach =
      StudentQuantile(0.5 + kConfidence / 2.0, 1000) * std::sqrt(known.estimate / static_cast<double>(split));
  if (rounds == 1 && (known.interval.high - known.interval.low) / 2.0 > plain_reach) {
    reason_ = SamplingReason::kDearer;
    phase_ = Phase::kPlain;
    finished_repeats_ = 0;
    repeats_.clear();
    if (left() == 0) end_ = ProbabilityEnd::kBudget;
  } else if (left() >= split / rounds) {
    BeginSplitting();
  } else {
    end_ = ProbabilityEnd::kBudget;
  }
}

void ProbabilityCourse::StageTold() {
  if (phase_ == Phase::kSplitting && std::ranges::all_of(repeats_, &Splitting::AtEnd))
    return RoundOfSplittingTold();
  if (phase_ == Phase::kPlain) end_ = EndOf(Estimate(kConfidence));
  if (end_ == ProbabilityEnd::kOpen && left() == 0) end_ = ProbabilityEnd::kBudget;
  if (reason_ == SamplingReason::kFirst && end_ == ProbabilityEnd::kOpen) ChooseMethod();
}

ProbabilityEnd ProbabilityCourse::EndOf(const ProbabilityEstimate& estimate) const {
  const auto& [low, high] = estimate.interval;
  if (spec_.below > 0.0) {
    if (high < spec_.below && high > 0.0) return ProbabilityEnd::kBelow;
    return low > spec_.below ? ProbabilityEnd::kAbove : ProbabilityEnd::kOpen;
  }
  const bool narrow = estimate.estimate > 0.0 && (high - low) / 2.0 <= spec_.within * estimate.estimate;
  return narrow ? ProbabilityEnd::kNarrow : ProbabilityEnd::kOpen;
}

ProbabilityEstimate ProbabilityCourse::Estimate(double confidence) const {
  if (finished_repeats_ > 0) {
    std::vector<double> estimates;
    for (std::size_t i = 0; i < finished_repeats_; ++i) estimates.push_back(*repeats_[i].estimate());
    return EstimateOfRepeats(std::move(estimates), confidence);
  }
  const std::uint64_t failures = plain_failed_.size();
  return {.estimate = plain_ == 0 ? 0.0 : static_cast<double>(failures) / static_cast<double>(plain_),
          .interval = ConfidenceSequence(failures, plain_, confidence),
          .valid_at_any_time = true};
}

std::optional<double> ProbabilityCourse::Reached() const {
  if (repeats_.empty() || finished_repeats_ > 0) return std::nullopt;
  double sum = 0.0;
  for (const Splitting& one : repeats_) sum += one.reached();
  return sum / static_cast<double>(repeats_.size());
}

std::vector<FailedSample> ProbabilityCourse::Failed() const {
  std::vector<FailedSample> failed;
  if (finished_repeats_ == 0) {
    for (const std::uint64_t sample : plain_failed_)
      failed.push_back({sample, 1.0 / static_cast<double>(plain_failed_.size())});
    return failed;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < finished_repeats_; ++i) sum += *repeats_[i].estimate();
  for (std::size_t i = 0; i < finished_repeats_; ++i) {
    const std::vector<std::uint64_t> samples = repeats_[i].Failing();
    for (const std::uint64_t sample : samples)
      failed.push_back({sample, *repeats_[i].estimate() / sum / static_cast<double>(samples.size()), i});
  }
  return failed;
}

}  // namespace gauntlet
