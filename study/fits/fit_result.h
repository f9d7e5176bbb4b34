// What a campaign of the search "fit" has come to: the settings under which runs are as they were measured.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics/interval.h"
#include "base/result.h"
#include "search/fit/fit_rounds.h"

namespace gauntlet {

// A setting that was drawn from the posterior.
struct AcceptedSetting {
  SettingsPoint place;
  double weight = 0.0;  // of all that were drawn, 0 to 1
};

// What is known of a key.
struct FittedKey {
  std::string path;
  std::string range = {};   // as it was given: "0.5..2"
  std::string chosen = {};  // value of the chosen setting; "" = none
  std::string likely = {};  // the middle 90 % of the accepted values, or choices with their shares
  bool determined = true;   // that is at most .8 of the range, or not every choice
};

// Two keys that make up for each other.
struct TradeOff {
  std::string one;
  std::string other;
  double correlation = 0.0;  // of ranks
};

// A target as the chosen setting meets it in its fresh runs.
struct JudgedTarget {
  std::string title;
  std::string wanted;
  double ours = 0.0;                 // of a distribution its mean
  analysis::Interval interval = {};  // 95 %
  double misfit = 0.0;               // MisfitOf
  bool met = false;
};

struct FitResult {
  Experiment experiment;  // of the fit
  FitPlan plan;
  bool finished = false;
  std::uint64_t runs = 0;
  std::uint64_t without_result = 0;            // of these
  std::size_t settings = 0;                    // simulated, without those that were judged
  std::size_t candidates = 0;                  // that were judged
  double refused = 0.0;                        // share of the ranges that breaks a rule of the experiment
  std::string why = {};                        // there is no posterior; "" = there is one
  std::vector<SettingsPoint> draws = {};       // from the posterior, equally likely
  std::vector<AcceptedSetting> accepted = {};  // the different ones of them, the likeliest first
  std::vector<FittedKey> keys = {};
  std::vector<TradeOff> trade_offs = {};
  std::vector<JudgedTarget> targets = {};        // empty before a setting was judged
  std::vector<std::string> contradictions = {};  // sentences: what cannot be met, alone or together
  std::optional<SettingsPoint> chosen = {};      // that was judged last
  std::optional<Experiment> fitted = {};         // with its values

  bool Met() const;  // the chosen setting meets every target
};

// A target is met when its misfit is at most this: two standard errors, those of the measurement and ours
// together.
inline constexpr double kMetWithin = 2.0;
// Of a key that the targets leave undetermined: the least share of its range.
inline constexpr double kUndetermined = 0.8;
inline constexpr double kTradeOff = 0.5;

// `experiment` is that of the fit.
FitResult ResultOf(const Experiment& experiment, const FitRounds& rounds, bool finished);
// Of a stored campaign. Error: kInvalidInput when it is none of a fit; those of OpenStoredCampaign and
// RestoreSearch.
Result<FitResult> ReadFit(const std::string& dir);

// The accepted settings with their weights, a line of keys first.
std::string AcceptedCsv(const FitResult& fit);
// The fitted experiment as TOML; how it came about stands above it. There is one.
std::string FittedToml(const FitResult& fit, const std::string& dir);

}  // namespace gauntlet
