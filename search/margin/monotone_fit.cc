#include "search/margin/monotone_fit.h"

#include <algorithm>
#include <map>

#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

// Quantile .95 of the chi-square distribution with one degree of freedom.
constexpr double kCritical = 3.841458820694124;

struct Block {
  double runs = 0.0;
  double failures = 0.0;
  std::size_t levels = 0;

  double share() const { return failures / runs; }
};

double LogLikelihoodOf(std::span<const LevelTally> levels, std::span<const double> shares) {
  double sum = 0.0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const int passes = levels[i].runs - levels[i].failures;
    if (levels[i].failures > 0) sum += levels[i].failures * sim::Log(shares[i]);
    if (passes > 0) sum += passes * sim::Log(1.0 - shares[i]);
  }
  return sum;
}

// The likeliest fit that crosses the share behind the first `below` levels.
double LikelihoodOfCrossing(std::span<const LevelTally> levels, std::size_t below, double share) {
  std::vector<double> shares = MonotoneFit(levels.first(below));
  for (double& one : shares) one = std::min(one, share);
  for (const double one : MonotoneFit(levels.subspan(below))) shares.push_back(std::max(one, share));
  return LogLikelihoodOf(levels, shares);
}

// Between the last level up to the share and the first one from it on.
double EstimateOf(std::span<const LevelTally> levels, double share) {
  const std::vector<double> fit = MonotoneFit(levels);
  const auto first_from = static_cast<std::size_t>(std::ranges::lower_bound(fit, share) - fit.begin());
  const auto first_above = static_cast<std::size_t>(std::ranges::upper_bound(fit, share) - fit.begin());
  if (first_from == fit.size()) return Crossing::kAbove;
  if (first_above == 0) return Crossing::kBelow;
  if (first_above > first_from) return (levels[first_from].place + levels[first_above - 1].place) / 2.0;
  const std::size_t i = first_from;
  const double part = (share - fit[i - 1]) / (fit[i] - fit[i - 1]);
  return levels[i - 1].place + part * (levels[i].place - levels[i - 1].place);
}

}  // namespace

std::vector<double> MonotoneFit(std::span<const LevelTally> levels) {
  std::vector<Block> blocks;
  for (const LevelTally& level : levels) {
    blocks.push_back({static_cast<double>(level.runs), static_cast<double>(level.failures), 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].share() >= blocks.back().share()) {
      const Block last = blocks.back();
      blocks.pop_back();
      blocks.back().runs += last.runs;
      blocks.back().failures += last.failures;
      blocks.back().levels += last.levels;
    }
  }
  std::vector<double> fit;
  for (const Block& block : blocks) fit.insert(fit.end(), block.levels, block.share());
  return fit;
}

double LogLikelihood(std::span<const LevelTally> levels) {
  return LogLikelihoodOf(levels, MonotoneFit(levels));
}

Crossing CrossingOf(std::span<const LevelTally> levels, double share, double design_effect) {
  Crossing crossing{.low = Crossing::kAbove, .high = Crossing::kBelow, .estimate = EstimateOf(levels, share)};
  const double best = LogLikelihood(levels);
  for (std::size_t below = 0; below <= levels.size(); ++below) {
    const double ratio = 2.0 * (best - LikelihoodOfCrossing(levels, below, share)) / design_effect;
    if (ratio > kCritical) continue;
    crossing.low = std::min(crossing.low, below == 0 ? Crossing::kBelow : levels[below - 1].place);
    crossing.high = std::max(crossing.high, below == levels.size() ? Crossing::kAbove : levels[below].place);
  }
  return crossing;
}

double DesignEffect(std::span<const CaseOutcome> outcomes, std::span<const double> fit) {
  std::map<std::size_t, double> sums;  // of residuals, by case
  double independent = 0.0;
  for (const CaseOutcome& one : outcomes) {
    const double residual = (one.failed ? 1.0 : 0.0) - fit[one.level];
    sums[one.of_case] += residual;
    independent += residual * residual;
  }
  if (independent == 0.0) return 1.0;
  double seen = 0.0;
  for (const auto& [of_case, sum] : sums) seen += sum * sum;
  return std::max(1.0, seen / independent);
}

}  // namespace gauntlet
