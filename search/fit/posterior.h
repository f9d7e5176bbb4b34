// Which settings are likely, given what was measured: a synthetic likelihood (Wood 2010) whose means come
// from emulators of the statistics and whose covariances come from the simulated runs, under a prior that is
// even over the places of keys in their ranges; its draws by sequential Monte Carlo (Del Moral, Doucet and
// Jasra 2006) with moves along differences of the population (ter Braak 2006).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "search/experiment/varied_keys.h"
#include "search/fit/emulator.h"
#include "search/fit/fit_targets.h"
#include "sim/random/random_stream.h"

namespace gauntlet {

// What runs of one setting gave: for the numbers of all targets, one behind the other ("components").
struct SettingStatistics {
  SettingsPoint place;
  std::vector<double> values = {};  // NaN: there was nothing to measure
  Eigen::MatrixXd covariance = {};  // of `values`, times `runs`: what a single run would give
  std::vector<double> runs = {};    // that a component stands on

  bool Whole() const;  // every component has a value
};
// `values[target][run]`; runs of targets with equal FitTarget::cases are the same ones. The covariance is
// that of resampled runs (Efron 1979).
SettingStatistics StatisticsOf(SettingsPoint place, std::span<const FitTarget> targets,
                               const std::vector<std::vector<double>>& values, sim::RandomStream random);

// How far a statistic is from what is wanted, in standard errors, 0 = as wanted; of a distribution the root
// of the mean square. `covariance`: of our components of the target; for bounds and equalities in full.
double MisfitOf(const FitTarget& target, std::span<const double> ours, const Eigen::MatrixXd& covariance);

class FitPosterior {
 public:
  using Allowed = std::function<bool(const SettingsPoint& place)>;

  // Of settings without every component nothing is used; at least two have them. `varied` and `targets`
  // outlive it.
  FitPosterior(std::span<const VariedKey> varied, std::span<const FitTarget> targets,
               std::span<const SettingStatistics> settings);

  // Up to a constant. `only`: these targets, all when empty.
  double LogLikelihood(const SettingsPoint& place, std::span<const std::size_t> only = {}) const;
  // Of the target's statistic at a place: how far it is from what is wanted, its uncertainty included.
  double Misfit(const SettingsPoint& place, std::size_t target) const;
  // The expectations of all components.
  std::vector<double> ExpectedAt(const SettingsPoint& place) const;

  // Equally likely draws, of which some may be equal; places of `allowed` only. Empty: there is hardly one.
  std::vector<SettingsPoint> Draw(std::size_t count, const Allowed& allowed, sim::RandomStream& random,
                                  std::span<const std::size_t> only = {}) const;

 private:
  struct Part {  // the components of a target
    std::size_t begin = 0;
    std::size_t count = 0;
  };
  Eigen::VectorXd InputOf(const SettingsPoint& place) const;
  // The covariance of a single run near a place: the mean over its neighbours.
  Eigen::MatrixXd CovarianceNear(const Eigen::VectorXd& input) const;
  double LogOfEqualities(std::span<const std::size_t> targets, const Eigen::VectorXd& mean,
                         const Eigen::MatrixXd& unsure, const Eigen::MatrixXd& covariance) const;
  // Expectations, the covariance of what is not known of them, and that of a single run; of components of
  // `only`, of all when it is empty; others are 0.
  void Predict(const SettingsPoint& place, std::span<const std::size_t> only, Eigen::VectorXd& mean,
               Eigen::MatrixXd& unsure, Eigen::MatrixXd& covariance) const;

  std::span<const VariedKey> varied_;
  std::span<const FitTarget> targets_;
  std::vector<Part> parts_;
  std::vector<std::size_t> target_of_;  // [component]
  Eigen::MatrixXd inputs_;              // of the settings
  std::vector<Eigen::MatrixXd> covariances_;
  std::vector<Emulator> emulators_;  // [component]
};

}  // namespace gauntlet
