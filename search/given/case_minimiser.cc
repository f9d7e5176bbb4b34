#include "search/given/case_minimiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <utility>

#include "base/check.h"
#include "controllers/registry.h"
#include "search/given/given_search.h"

namespace gauntlet {
namespace {

using Change = MinimisingStep::Change;

// Logarithms of .95/.75, .05/.25 and .9/.1: literals, because what is searched must not depend on libm.
constexpr double kOfFailure = 0.23638877806423;
constexpr double kOfPass = -1.60943791243410;
constexpr double kBound = 2.19722457733622;
constexpr int kMostRuns = 40;  // of a layout between the two probabilities

// Of the empty arena: so many more failures than passes, or the opposite. A sequential test of .7 against .3,
// both errors 5 %.
constexpr int kClearMajority = 4;

constexpr int kVerifiedAtOnce = 10;

constexpr double kLengthsPerMetre = 10.0;  // lengths are rounded to multiples of 0.1 m

double Evidence(const FailureTally& tally) {
  return tally.failures * kOfFailure + (tally.passes + tally.errors) * kOfPass;
}

int Told(const FailureTally& tally) {
  return tally.runs() + tally.errors;
}

// How many more runs failed than did not.
int Majority(const FailureTally& tally) {
  return 2 * tally.failures - Told(tally);
}

// The runs without which there can be no decision.
int RunsToDecide(const FailureTally& tally) {
  const double evidence = Evidence(tally);
  if (evidence >= kBound || evidence <= -kBound) return 0;
  const int to_accept = static_cast<int>(std::ceil((kBound - evidence) / kOfFailure));
  const int to_refuse = static_cast<int>(std::ceil((kBound + evidence) / -kOfPass));
  return std::min({to_accept, to_refuse, kMostRuns - Told(tally), kMostRuns - tally.refused});
}

sim::ObstacleGene& ObstacleOf(Layout& layout, std::size_t obstacle) {
  const auto place = std::ranges::find(layout.kept, obstacle) - layout.kept.begin();
  return layout.obstacles[static_cast<std::size_t>(place)];
}

// m; to the nearest of the places that the obstacle's centre visits.
double DistanceTo(const sim::ObstacleGene& gene, const sim::Vec2& place) {
  double least = sim::Distance(sim::BoxOf(gene), place);
  for (const sim::Vec2& center : gene.path) {
    sim::ObstacleGene moved = gene;
    moved.x = center.x();
    moved.y = center.y();
    least = std::min(least, sim::Distance(sim::BoxOf(moved), place));
  }
  return least;
}

double SumOfDistances(const sim::ObstacleGene& gene, const std::vector<sim::Vec2>& places) {
  double sum = 0.0;
  for (const sim::Vec2& place : places) sum += DistanceTo(gene, place);
  return sum;
}

double RoundedUp(double length) {
  return std::ceil(length * kLengthsPerMetre - 1e-9) / kLengthsPerMetre;
}

// Its lengths to try, the shortest last: what is refused is followed by a longer one.
std::vector<double> ShorterLengths(const sim::ObstacleGene& gene) {
  std::vector<double> lengths;
  for (const double share : {1.0, 0.75, 0.5, 0.25}) {
    const double length = std::max(RoundedUp(share * gene.length), RoundedUp(gene.width));
    if (length < gene.length && (lengths.empty() || length < lengths.back())) lengths.push_back(length);
  }
  return lengths;
}

const std::vector<controllers::ParameterInfo> kMinimisationParameters = {
    {"shorten", "bool", 0, 0, 1, true, "make obstacles shorter too, and round their lengths"}};

std::unique_ptr<LayoutQuestion> AskForSmallest(const Experiment& experiment, const sim::Genome& obstacles) {
  return std::make_unique<CaseMinimiser>(obstacles, RulesOf(experiment));
}

}  // namespace

CaseMinimiser::CaseMinimiser(sim::Genome obstacles, const MinimisingRules& rules)
    : obstacles_(std::move(obstacles)), rules_(rules), order_(AllOf(obstacles_).kept) {
  Try(Phase::kOriginal, {.layout = AllOf(obstacles_)});
}

void CaseMinimiser::Try(Phase phase, MinimisingStep step) {
  phase_ = phase;
  trying_ = std::move(step);
  layout_ = trying_.layout;
  told_ = {};
  runs_ = RunsNeeded();
}

void CaseMinimiser::End(MinimisedTo outcome) {
  outcome_ = outcome;
  runs_ = 0;
}

int CaseMinimiser::RunsNeeded() const {
  const FailureTally& tally = told_.tally;
  if (phase_ == Phase::kOriginal) return RunsToVerdict(tally, /*replicates=*/0);
  if (phase_ == Phase::kEmpty)
    return std::min(
        {kClearMajority - std::abs(Majority(tally)), kMostRuns - Told(tally), kMostRuns - tally.refused});
  if (phase_ != Phase::kVerify) return RunsToDecide(tally);
  // Of the case as it is, which cannot be taken back, the figure is wanted all the same.
  const bool refused = Told(tally) - tally.failures > kVerifyingRuns - kVerifyingFailures;
  const int left = kVerifyingRuns - std::max(Told(tally), tally.refused);
  return refused && steps_.size() > 1 ? 0 : std::min(kVerifiedAtOnce, left);
}

bool CaseMinimiser::Fails() const {
  const FailureTally& tally = told_.tally;
  if (tally.mostly_refused()) return false;
  if (phase_ == Phase::kOriginal) return VerdictOf(tally, /*replicates=*/0) == FailureVerdict::kFail;
  if (phase_ == Phase::kEmpty) return Majority(tally) > 0;
  if (phase_ == Phase::kVerify) return IsReliable(tally) && SameFailures(told_);
  return Evidence(tally) >= kBound;
}

bool CaseMinimiser::SameFailures(const LayoutRuns& runs) const {
  if (!HasPlaces()) return runs.tally.failures > 0;
  const auto same = std::ranges::count_if(runs.places, [this](const sim::Vec2& place) {
    return std::ranges::any_of(original_.places, [&](const sim::Vec2& first) {
      return (place - first).norm() <= rules_.same_within;
    });
  });
  return runs.tally.failures > 0 && 2 * same >= runs.tally.failures;
}

void CaseMinimiser::Tell(const LayoutRuns& runs) {
  GAUNTLET_CHECK(runs_ > 0, "nothing was asked for");
  told_.Add(runs);
  runs_ = RunsNeeded();
  if (runs_ > 0) return;
  trying_.found = told_.tally;
  Decide(Fails());
}

void CaseMinimiser::Decide(bool fails) {
  switch (phase_) {
    case Phase::kOriginal:
      original_ = told_;
      if (original_.tally.errors > 0 || original_.tally.mostly_refused()) return End(MinimisedTo::kError);
      if (!fails) return End(MinimisedTo::kNoFailure);
      steps_ = {trying_};
      return Try(Phase::kEmpty, {.layout = {}});
    case Phase::kEmpty:
      empty_ = told_.tally;
      return fails ? End(MinimisedTo::kEmpty) : Confirmed();
    case Phase::kNearest:
      if (!fails) return TryNearest(nearest_ + 1);
      steps_.push_back(trying_);
      return BeginTakingAway();
    case Phase::kWithout:
      if (fails) steps_.push_back(trying_);
      taken_away_ = taken_away_ || fails;
      return TryWithoutNext();
    case Phase::kVerify:
      return fails ? Verified() : RollBack();
    case Phase::kShorten:
      if (fails) {
        std::erase_if(shorter_,
                      [this](const MinimisingStep& one) { return one.obstacle == trying_.obstacle; });
        steps_.push_back(trying_);
      }
      return TryShorterNext();
  }
}

void CaseMinimiser::Confirmed() {
  if (HasPlaces()) {
    std::ranges::stable_sort(order_, {}, [this](std::size_t obstacle) {
      return SumOfDistances(obstacles_[obstacle], original_.places);
    });
    return TryNearest(1);
  }
  if (original_.visits.size() == obstacles_.size()) {
    std::ranges::stable_sort(order_, std::greater{},
                             [this](std::size_t obstacle) { return original_.visits[obstacle]; });
  }
  TryNearest(obstacles_.size());
}

void CaseMinimiser::TryNearest(std::size_t count) {
  nearest_ = count;
  if (count >= obstacles_.size()) return BeginTakingAway();  // that all of them fail is known
  Layout nearest;
  nearest.kept.assign(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(count));
  std::ranges::sort(nearest.kept);
  for (const std::size_t obstacle : nearest.kept) nearest.obstacles.push_back(obstacles_[obstacle]);
  Try(Phase::kNearest, {.change = Change::kNearest, .layout = std::move(nearest)});
}

void CaseMinimiser::BeginTakingAway() {
  taken_away_ = false;
  left_.assign(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(nearest_));
  // That the others do not fail without the last one has just been seen.
  if (HasPlaces() && !left_.empty()) left_.pop_back();
  TryWithoutNext();
}

void CaseMinimiser::TryWithoutNext() {
  // What was needed may be spared once others are gone.
  if (left_.empty() && taken_away_) {
    taken_away_ = false;
    std::ranges::copy_if(order_, std::back_inserter(left_), [this](std::size_t obstacle) {
      return std::ranges::count(Smallest().kept, obstacle) > 0;
    });
  }
  // That the empty arena does not fail is known.
  if (left_.empty() || Smallest().kept.size() <= 1) return Verify();
  const std::size_t obstacle = left_.back();
  left_.pop_back();
  Try(Phase::kWithout,
      {.change = Change::kWithout, .obstacle = obstacle, .layout = Without(Smallest(), obstacle)});
}

void CaseMinimiser::Verify() {
  Try(Phase::kVerify, steps_.back());
}

void CaseMinimiser::Verified() {
  verification_ = told_;
  const bool first = verified_steps_ == 0;
  verified_steps_ = steps_.size();
  if (!first || !rules_.shorten) return End(MinimisedTo::kLayout);
  for (const std::size_t obstacle : Smallest().kept) {
    for (const double length : ShorterLengths(obstacles_[obstacle]))
      shorter_.push_back({.change = Change::kShortened, .obstacle = obstacle, .length = length});
  }
  TryShorterNext();
}

void CaseMinimiser::TryShorterNext() {
  if (shorter_.empty()) {
    if (steps_.size() > verified_steps_) return Verify();
    layout_ = Smallest();
    return End(MinimisedTo::kLayout);
  }
  MinimisingStep step = std::move(shorter_.back());
  shorter_.pop_back();
  step.layout = Smallest();
  ObstacleOf(step.layout, step.obstacle).length = step.length;
  Try(Phase::kShorten, std::move(step));
}

void CaseMinimiser::RollBack() {
  if (steps_.size() == 1) {  // the case as it is
    verification_ = told_;
    return End(MinimisedTo::kLayout);
  }
  const bool was_nearest = steps_.back().change == Change::kNearest;
  steps_.pop_back();
  if (was_nearest) return TryNearest(nearest_ + 1);
  if (steps_.size() > verified_steps_) return Verify();
  layout_ = Smallest();
  End(MinimisedTo::kLayout);
}

MinimisingRules RulesOf(const Experiment& minimisation) {
  return {.same_within = controllers::DeclaredScenario(minimisation).failures.SameWithin(),
          .shorten = ValueOf(kMinimisationParameters[0], minimisation.search.parameters) != 0.0};
}

Experiment MinimisationOf(const Experiment& experiment, bool shorten) {
  Experiment minimisation = AboutCasesOf(experiment, "minimisation");
  minimisation.search.parameters[std::string(kMinimisationParameters[0].name)] = shorten ? 1.0 : 0.0;
  return minimisation;
}

SearchRow MinimisationRow() {
  return {.info = {.name = "minimisation",
                   .description = "the smallest part of given cases that still fails: gauntlet minimise",
                   .parameters = kMinimisationParameters},
          .number = 5,
          .title = "minimisation of cases",
          .plan = [](const Experiment&) { return std::string("about 100 runs each"); },
          .make = Make<GivenSearch>,
          .purpose = sim::SeedPurpose::kMinimise,
          .question = AskForSmallest,
          .reads_trajectories = true,
          .command = "minimise",
          .seeds_of_cases = true};
}

}  // namespace gauntlet
