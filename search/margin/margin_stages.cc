#include "search/margin/margin_stages.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "base/number_text.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

double Mirrored(double place) {
  return 1.0 - place;
}

// Levels whose places ascend, mirrored or not.
std::vector<LevelTally> TalliesOf(const std::map<double, LevelTally>& by_place, bool falls) {
  std::vector<LevelTally> tallies;
  for (const auto& [place, tally] : by_place) tallies.push_back(tally);
  if (!falls) return tallies;
  std::ranges::reverse(tallies);
  for (LevelTally& one : tallies) one.place = Mirrored(one.place);
  return tallies;
}

// The value on a grid of decimals that has a thousand to ten thousand places in `range`.
double OnDecimals(double value, double range) {
  double scale = 1.0;
  while (scale * range < 1000.0) scale *= 10.0;
  if (scale > 1.0) return std::round(value * scale) / scale;
  while (range / scale >= 10'000.0) scale *= 10.0;
  return std::round(value / scale) * scale;
}

}  // namespace

Result<MarginPlan> MakeMarginPlan(const Experiment& experiment, std::span<const Key> keys,
                                  std::size_t cases) {
  const MarginSpec& spec = experiment.margin;
  TRY(const auto varied, ParseVariedKeys({spec.vary}, keys, experiment));
  const VariedKey& key = varied.front();
  if (key.listed() || (key.key.type != KeyType::kNumber && key.key.type != KeyType::kInteger))
    return InvalidInput(
        fmt::format("--vary {}: a margin is looked for along the numbers of a range, as in {}=LOW..HIGH",
                    spec.vary, key.key.path));
  for (const std::string_view of_cases : {"genome.", "arena."}) {
    if (key.key.path.starts_with(of_cases))
      return InvalidInput(
          fmt::format("--vary {}: {} says how cases are made, and the cases are the same at every value",
                      spec.vary, key.key.path));
  }
  if (spec.runs < MarginPlan::kLeastRuns)
    return InvalidInput(fmt::format("{} runs are too few for an interval: at least {} are needed", spec.runs,
                                    MarginPlan::kLeastRuns));
  if (experiment.search.replicates != 1)
    return InvalidInput(fmt::format("search.replicates = {}: a margin simulates every evaluation once",
                                    experiment.search.replicates));
  if (cases < MarginPlan::kCasesEach)
    return InvalidInput(fmt::format("{} for a failure rate: at least {} are needed", Counted(cases, "case"),
                                    MarginPlan::kCasesEach));
  return MarginPlan{.key = key, .runs = spec.runs, .share = spec.share, .cases = cases};
}

double MarginStages::PlaceOf(double value) const {
  const VariedKey& key = plan_.key;
  if (key.log) return (sim::Log(value) - sim::Log(key.low)) / (sim::Log(key.high) - sim::Log(key.low));
  return (value - key.low) / (key.high - key.low);
}

double MarginStages::ValueAt(double place) const {
  const VariedKey& key = plan_.key;
  const double even = key.low + place * (key.high - key.low);
  const double value =
      key.log ? sim::Exp(sim::Log(key.low) + place * (sim::Log(key.high) - sim::Log(key.low))) : even;
  const double rounded = key.key.type == KeyType::kInteger
                             ? std::round(value)
                             : OnDecimals(value, key.log ? value : key.high - key.low);
  return std::clamp(rounded, key.low, key.high);
}

std::vector<double> MarginStages::NextValues() const {
  std::vector<double> values;
  if (stages_ == 0) {
    for (std::size_t i = 0; i < MarginPlan::kFirstValues; ++i)
      values.push_back(ValueAt(static_cast<double>(i) / (MarginPlan::kFirstValues - 1)));
  } else {
    const std::optional<MarginEstimate> known = Estimate();
    if (!known) return {};
    const double low = std::max(0.0, std::isfinite(known->low) ? PlaceOf(known->low) : 0.0);
    const double high = std::isfinite(known->high) ? PlaceOf(known->high) : 1.0;
    // Where a range is wholly on one side, its ends say the most.
    const bool whole = !std::isfinite(known->low) && !std::isfinite(known->high);
    const double margin = whole ? 0.0 : (high - low) / 4.0;
    values = {ValueAt(low + margin), ValueAt(high - margin)};
  }
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<MarginRun> MarginStages::Next() {
  const std::vector<double> values = NextValues();
  const auto size = static_cast<int>(values.size() * MarginPlan::kCasesEach);
  std::vector<MarginRun> runs;
  if (values.empty() || asked_ + size > plan_.runs) return runs;
  for (const double value : values) {
    for (std::size_t i = 0; i < MarginPlan::kCasesEach; ++i)
      runs.push_back({value, (next_case_ + i) % plan_.cases});
  }
  next_case_ = (next_case_ + MarginPlan::kCasesEach) % plan_.cases;
  asked_ += size;
  ++stages_;
  return runs;
}

void MarginStages::Tell(const MarginRun& run, std::optional<bool> failed) {
  if (!failed) {
    ++without_result_;
    return;
  }
  outcomes_.push_back({run, *failed});
}

std::optional<MarginEstimate> MarginStages::Estimate() const {
  if (outcomes_.empty()) return std::nullopt;
  std::map<double, LevelTally> by_place;
  std::map<double, double> value_of;
  for (const Outcome& one : outcomes_) {
    const double place = PlaceOf(one.run.value);
    value_of[place] = one.run.value;
    LevelTally& tally = by_place[place];
    tally.place = place;
    ++tally.runs;
    tally.failures += one.failed ? 1 : 0;
  }
  const auto rising = TalliesOf(by_place, false);
  const auto falling = TalliesOf(by_place, true);
  MarginEstimate estimate{.falls = LogLikelihood(falling) > LogLikelihood(rising)};
  const auto& levels = estimate.falls ? falling : rising;
  const std::vector<double> fit = MonotoneFit(levels);
  std::vector<CaseOutcome> outcomes;
  for (const Outcome& one : outcomes_) {
    const auto index =
        static_cast<std::size_t>(std::distance(by_place.begin(), by_place.find(PlaceOf(one.run.value))));
    outcomes.push_back({estimate.falls ? levels.size() - 1 - index : index, one.run.of_case, one.failed});
  }
  estimate.design_effect = DesignEffect(outcomes, fit);
  Crossing crossing = CrossingOf(levels, plan_.share, estimate.design_effect);
  if (estimate.falls) {
    crossing = {.low = Mirrored(crossing.high),
                .high = Mirrored(crossing.low),
                .estimate = Mirrored(crossing.estimate)};
  }
  // Ends are levels, whose values are known; what lies between two of them is rounded as values are.
  const auto value_at = [&](double place) {
    const auto known = value_of.lower_bound(place - 1e-12);
    if (known != value_of.end() && std::abs(known->first - place) < 1e-9) return known->second;
    return std::isfinite(place) ? ValueAt(place) : place;
  };
  estimate.low = value_at(crossing.low);
  estimate.high = value_at(crossing.high);
  estimate.estimate = value_at(crossing.estimate);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double place = estimate.falls ? Mirrored(levels[i].place) : levels[i].place;
    estimate.levels.push_back({value_at(place), levels[i].runs, levels[i].failures, fit[i]});
  }
  std::ranges::sort(estimate.levels, {}, &MarginLevel::value);
  return estimate;
}

}  // namespace gauntlet
