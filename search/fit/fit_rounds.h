// The course of a fit, pure: which settings are simulated next, given what runs of the earlier ones gave. The
// first round covers the ranges (a Latin hypercube; McKay, Beckman and Conover 1979), each later one draws
// from the posterior as it is known by then, and at the end one setting is chosen and judged on fresh cases.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "search/fit/fit_plan.h"
#include "search/fit/posterior.h"

namespace gauntlet {

struct FitSetting {
  SettingsPoint place;
  bool judged = false;                           // chosen: its values have two digits that count
  std::vector<std::vector<double>> values = {};  // [target][run]; NaN: nothing to measure
  int runs = 0;
  int without_result = 0;  // of these

  std::vector<KeyValue> ValuesOf(std::span<const VariedKey> varied) const;
};

class FitRounds {
 public:
  static constexpr std::size_t kAccepted = 1000;  // draws from the posterior
  static constexpr std::size_t kCandidates = 5;   // that are judged at most

  // `seed` of its random numbers; `allowed` whether a place breaks no rule that can be told at once.
  FitRounds(FitPlan plan, std::uint64_t seed, FitPosterior::Allowed allowed);

  const FitPlan& plan() const { return plan_; }
  std::uint64_t seed() const { return seed_; }
  const FitPosterior::Allowed& allowed() const { return allowed_; }
  const std::vector<FitSetting>& settings() const { return settings_; }
  std::size_t round() const { return round_; }  // that have been proposed

  // Places for the next round, once all runs of the last are told; more of them than `wanted`, in case that
  // some cannot begin. Empty: it has come to its end, and `why` says so where that is not as planned.
  std::vector<SettingsPoint> Propose();
  std::size_t wanted() const { return wanted_; }
  // That these of the proposed ones are simulated.
  void Begin(std::vector<SettingsPoint> places);
  void Tell(std::size_t setting, std::size_t cases, const RunOutcome& run, TargetReader& reader);
  // Works out the statistics of settings that are not judged, once all their runs are told. Propose does it
  // too.
  void Summarise();
  bool judging() const { return round_ > FitPlan::kRounds; }
  // Why there is no posterior; "" = there is, or it is not known yet.
  std::string why() const;

  // Of what was told so far. nullptr: too few settings have a result.
  std::unique_ptr<FitPosterior> Posterior() const;
  // kAccepted draws, the same each time; the likeliest first, judged by their rounded values.
  std::vector<SettingsPoint> Accepted(const FitPosterior& posterior) const;
  // The statistics of a setting.
  SettingStatistics StatisticsOf(std::size_t setting) const;
  // The last one that was judged, if every run that has to keep to something did; nullptr before.
  const FitSetting* Chosen() const;

 private:
  bool KeepsTo(const FitSetting& setting) const;  // what every run has to

  FitPlan plan_;
  std::uint64_t seed_;
  FitPosterior::Allowed allowed_;
  std::vector<FitSetting> settings_;
  std::vector<SettingStatistics> statistics_;  // of those of earlier rounds
  std::size_t round_ = 0;
  std::size_t wanted_ = 0;
};

}  // namespace gauntlet
