#include "search/fit/fit_rounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/check.h"
#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

// Places beside those that are wanted, in case that some cannot begin.
constexpr std::size_t kSpare = 2;

// An even cover of the ranges: in each direction one place in each of `count` equal parts.
std::vector<SettingsPoint> LatinHypercube(std::size_t count, std::size_t dimensions,
                                          sim::RandomStream& random) {
  std::vector<SettingsPoint> places(count, SettingsPoint(dimensions));
  std::vector<std::uint32_t> parts(count);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::iota(parts.begin(), parts.end(), 0U);
    for (std::size_t i = count; i > 1; --i)
      std::swap(parts[i - 1], parts[random.Below(static_cast<std::uint32_t>(i))]);
    for (std::size_t i = 0; i < count; ++i)
      places[i][d] = (parts[i] + random.Uniform()) / static_cast<double>(count);
  }
  return places;
}

}  // namespace

std::vector<KeyValue> FitSetting::ValuesOf(std::span<const VariedKey> varied) const {
  std::vector<KeyValue> values_of_keys;
  for (std::size_t i = 0; i < varied.size(); ++i)
    values_of_keys.push_back(judged ? varied[i].RoundedAt(place[i]) : varied[i].ValueAt(place[i]));
  return values_of_keys;
}

FitRounds::FitRounds(FitPlan plan, std::uint64_t seed, FitPosterior::Allowed allowed)
    : plan_(std::move(plan)), seed_(seed), allowed_(std::move(allowed)) {}

std::vector<SettingsPoint> FitRounds::Propose() {
  sim::RandomStream random(seed_, sim::StreamPurpose::kVariation, static_cast<std::uint32_t>(round_));
  wanted_ = round_ < FitPlan::kRounds ? plan_.SettingsOfRound(round_) : 1;
  if (round_ == 0) {
    const std::size_t dimensions = plan_.varied.size();
    std::vector<SettingsPoint> places = LatinHypercube(wanted_, dimensions, random);
    std::vector<SettingsPoint> spare = LatinHypercube(kSpare * wanted_, dimensions, random);
    std::ranges::move(spare, std::back_inserter(places));
    std::erase_if(places, [&](const SettingsPoint& place) { return !allowed_(place); });
    return places;
  }
  Summarise();
  const std::size_t judged = settings_.size() - statistics_.size();
  if (!why().empty() || Chosen() != nullptr || judged >= kCandidates) return {};
  const std::unique_ptr<FitPosterior> posterior = Posterior();
  if (round_ < FitPlan::kRounds) return posterior->Draw((1 + kSpare) * wanted_, allowed_, random);
  std::vector<SettingsPoint> candidates = Accepted(*posterior);
  std::erase_if(candidates, [&](const SettingsPoint& place) {
    const auto values = FitSetting{.place = place, .judged = true}.ValuesOf(plan_.varied);
    return std::any_of(settings_.end() - static_cast<std::ptrdiff_t>(judged), settings_.end(),
                       [&](const FitSetting& one) { return one.ValuesOf(plan_.varied) == values; });
  });
  return candidates;
}

void FitRounds::Summarise() {
  while (statistics_.size() < settings_.size() && !settings_[statistics_.size()].judged)
    statistics_.push_back(StatisticsOf(statistics_.size()));
}

void FitRounds::Begin(std::vector<SettingsPoint> places) {
  for (SettingsPoint& place : places) {
    FitSetting& setting = settings_.emplace_back();
    setting.place = std::move(place);
    setting.judged = round_ >= FitPlan::kRounds;
    setting.values.resize(plan_.targets.size());
  }
  ++round_;
}

void FitRounds::Tell(std::size_t setting, std::size_t cases, const RunOutcome& run, TargetReader& reader) {
  FitSetting& one = settings_.at(setting);
  ++one.runs;
  if (!run.completed()) {
    ++one.without_result;
    return;
  }
  const std::vector<double> values = reader.Read(run);
  for (std::size_t t = 0; t < plan_.targets.size(); ++t) {
    if (plan_.CasesOf(plan_.targets[t]) == cases) one.values[t].push_back(values[t]);
  }
}

std::string FitRounds::why() const {
  std::size_t whole = 0;
  int runs = 0;
  int without_result = 0;
  for (const SettingStatistics& one : statistics_) whole += one.Whole() ? 1 : 0;
  for (const FitSetting& one : settings_) {
    runs += one.runs;
    without_result += one.without_result;
  }
  const std::size_t least = plan_.SettingsOfRound(0) / 2;
  if (statistics_.empty() || whole >= std::max<std::size_t>(least, 2)) return "";
  return fmt::format(
      "only {} of {} settings gave a value for every target; {} of {} runs ended without a result", whole,
      statistics_.size(), without_result, runs);
}

std::unique_ptr<FitPosterior> FitRounds::Posterior() const {
  if (statistics_.empty() || !why().empty()) return nullptr;
  return std::make_unique<FitPosterior>(plan_.varied, plan_.targets, statistics_);
}

std::vector<SettingsPoint> FitRounds::Accepted(const FitPosterior& posterior) const {
  sim::RandomStream random(seed_, sim::StreamPurpose::kVariation, FitPlan::kRounds);
  std::vector<std::pair<double, SettingsPoint>> ranked;
  for (SettingsPoint& place : posterior.Draw(kAccepted, allowed_, random)) {
    SettingsPoint rounded;
    for (std::size_t i = 0; i < place.size(); ++i)
      rounded.push_back(plan_.varied[i].PlaceOf(plan_.varied[i].RoundedAt(place[i])));
    const double log = allowed_(rounded) ? posterior.LogLikelihood(rounded) : -INFINITY;
    ranked.emplace_back(log, std::move(place));
  }
  std::ranges::stable_sort(ranked, [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<SettingsPoint> places;
  for (auto& [log, place] : ranked) places.push_back(std::move(place));
  return places;
}

SettingStatistics FitRounds::StatisticsOf(std::size_t setting) const {
  const FitSetting& one = settings_.at(setting);
  return gauntlet::StatisticsOf(
      one.place, plan_.targets, one.values,
      sim::RandomStream(seed_, sim::StreamPurpose::kStatistics, static_cast<std::uint32_t>(setting)));
}

bool FitRounds::KeepsTo(const FitSetting& setting) const {
  for (std::size_t t = 0; t < plan_.targets.size(); ++t) {
    if (plan_.targets[t].demand != FitTarget::Demand::kEvery) continue;
    const std::vector<double>& held = setting.values[t];
    const auto runs = static_cast<std::size_t>(plan_.judged[plan_.CasesOf(plan_.targets[t])]);
    if (held.size() < runs || std::ranges::any_of(held, [](double value) { return value != 1.0; }))
      return false;
  }
  return true;
}

const FitSetting* FitRounds::Chosen() const {
  if (settings_.empty() || !settings_.back().judged || !KeepsTo(settings_.back())) return nullptr;
  return &settings_.back();
}

}  // namespace gauntlet
