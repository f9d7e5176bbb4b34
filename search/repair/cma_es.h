// CMA-ES, the covariance matrix adaptation evolution strategy: proposals from a normal distribution whose
// mean and covariance follow the better half of the earlier ones. Equations and default constants: N. Hansen,
// "The CMA Evolution Strategy: A Tutorial" (arXiv:1604.00772, 2016). Pure: the same bits on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "search/experiment/varied_keys.h"

namespace gauntlet {

// The eigenvalues of a symmetric matrix of n rows, and its eigenvectors as columns, by Jacobi's rotations
// (Golub and Van Loan, Matrix Computations, 8.5): `matrix` row by row.
struct Eigensystem {
  std::vector<double> values;
  std::vector<double> vectors;  // row by row
};
Eigensystem EigensystemOf(std::vector<double> matrix, std::size_t n);

// Minimises over [0, 1]^n. What is drawn outside is put on the bound.
class CmaEs {
 public:
  // `start`: the first mean; `step`: the first standard deviation along each axis, above 0.
  CmaEs(SettingsPoint start, double step, std::uint64_t seed);

  std::size_t population() const { return population_; }
  // Of which the next generation is made.
  std::size_t parents() const { return weights_.size(); }
  const SettingsPoint& mean() const { return mean_; }
  double step() const { return step_; }

  // The proposals of the next generation.
  std::vector<SettingsPoint> Ask();
  // The order of those that Ask gave last, the best first: all of them.
  void Tell(const std::vector<std::size_t>& best_first);

 private:
  std::size_t n_;
  std::size_t population_;
  std::uint64_t seed_;
  std::vector<double> weights_;
  double effective_ = 0.0;  // variance-effective selection mass, mu_eff
  SettingsPoint mean_;
  double step_;
  std::vector<double> covariance_;  // row by row
  Eigensystem eigen_;
  std::vector<double> step_path_;
  std::vector<double> covariance_path_;
  std::vector<SettingsPoint> asked_;
  std::uint32_t generation_ = 0;
};

}  // namespace gauntlet
