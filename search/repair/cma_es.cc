#include "search/repair/cma_es.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/geometry/trigonometry.h"
#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

constexpr int kMostSweeps = 50;

double Norm(const std::vector<double>& v) {
  double squared = 0.0;
  for (const double x : v) squared += x * x;
  return std::sqrt(squared);
}

// Turns rows and columns p and q of the matrix so that its element (p, q) is 0, and the vectors with them.
void Rotate(std::vector<double>& matrix, std::vector<double>& vectors, std::size_t n, std::size_t p,
            std::size_t q) {
  const double off = matrix[p * n + q];
  if (off == 0.0) return;
  const double theta = (matrix[q * n + q] - matrix[p * n + p]) / (2.0 * off);
  const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
  const double c = 1.0 / std::sqrt(t * t + 1.0);
  const double s = t * c;
  for (std::size_t k = 0; k < n; ++k) {
    const double kp = matrix[k * n + p];
    const double kq = matrix[k * n + q];
    matrix[k * n + p] = c * kp - s * kq;
    matrix[k * n + q] = s * kp + c * kq;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double pk = matrix[p * n + k];
    const double qk = matrix[q * n + k];
    matrix[p * n + k] = c * pk - s * qk;
    matrix[q * n + k] = s * pk + c * qk;
    const double vp = vectors[k * n + p];
    const double vq = vectors[k * n + q];
    vectors[k * n + p] = c * vp - s * vq;
    vectors[k * n + q] = s * vp + c * vq;
  }
}

}  // namespace

Eigensystem EigensystemOf(std::vector<double> matrix, std::size_t n) {
  Eigensystem system{std::vector<double>(n), std::vector<double>(n * n, 0.0)};
  for (std::size_t i = 0; i < n; ++i) system.vectors[i * n + i] = 1.0;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double off = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < n * n; ++i) {
      all += matrix[i] * matrix[i];
      if (i % n != i / n) off += matrix[i] * matrix[i];
    }
    if (off <= 1e-30 * all) break;
    for (std::size_t p = 0; p + 1 < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) Rotate(matrix, system.vectors, n, p, q);
    }
  }
  for (std::size_t i = 0; i < n; ++i) system.values[i] = matrix[i * n + i];
  return system;
}

CmaEs::CmaEs(SettingsPoint start, double step, std::uint64_t seed)
    : n_(start.size()), seed_(seed), mean_(std::move(start)), step_(step) {
  const auto n = static_cast<double>(n_);
  population_ = 4 + static_cast<std::size_t>(3.0 * sim::Log(n));
  double sum = 0.0;
  for (std::size_t i = 0; i < population_ / 2; ++i) {
    weights_.push_back(sim::Log((static_cast<double>(population_) + 1.0) / 2.0) -
                       sim::Log(static_cast<double>(i) + 1.0));
    sum += weights_.back();
  }
  double squares = 0.0;
  for (double& weight : weights_) {
    weight /= sum;
    squares += weight * weight;
  }
  effective_ = 1.0 / squares;
  covariance_.assign(n_ * n_, 0.0);
  for (std::size_t i = 0; i < n_; ++i) covariance_[i * n_ + i] = 1.0;
  eigen_ = EigensystemOf(covariance_, n_);
  step_path_.assign(n_, 0.0);
  covariance_path_.assign(n_, 0.0);
}

std::vector<SettingsPoint> CmaEs::Ask() {
  asked_.clear();
  ++generation_;
  for (std::size_t one = 0; one < population_; ++one) {
    sim::RandomStream random(seed_, sim::StreamPurpose::kProposals, generation_,
                             static_cast<std::uint32_t>(one));
    std::vector<double> along(n_);  // the axes of the distribution
    for (std::size_t i = 0; i < n_; ++i)
      along[i] = std::sqrt(std::max(eigen_.values[i], 0.0)) * random.Gaussian();
    SettingsPoint point = mean_;
    for (std::size_t i = 0; i < n_; ++i) {
      double offset = 0.0;
      for (std::size_t k = 0; k < n_; ++k) offset += eigen_.vectors[i * n_ + k] * along[k];
      point[i] = std::clamp(point[i] + step_ * offset, 0.0, 1.0);
    }
    asked_.push_back(std::move(point));
  }
  return asked_;
}

void CmaEs::Tell(const std::vector<std::size_t>& best_first) {
  const auto n = static_cast<double>(n_);
  // Default constants of the tutorial's table 1, without negative weights.
  const double c_step = (effective_ + 2.0) / (n + effective_ + 5.0);
  const double damping = 1.0 + 2.0 * std::max(0.0, std::sqrt((effective_ - 1.0) / (n + 1.0)) - 1.0) + c_step;
  const double c_path = (4.0 + effective_ / n) / (n + 4.0 + 2.0 * effective_ / n);
  const double c_one = 2.0 / ((n + 1.3) * (n + 1.3) + effective_);
  const double c_rank = std::min(
      1.0 - c_one, 2.0 * (effective_ - 2.0 + 1.0 / effective_) / ((n + 2.0) * (n + 2.0) + effective_));
  const double expected = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

  std::vector<std::vector<double>> moves;  // of the better half, in steps
  std::vector<double> move(n_, 0.0);       // of the mean
  for (std::size_t rank = 0; rank < weights_.size(); ++rank) {
    std::vector<double>& one = moves.emplace_back(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      one[i] = (asked_[best_first[rank]][i] - mean_[i]) / step_;
      move[i] += weights_[rank] * one[i];
    }
  }
  for (std::size_t i = 0; i < n_; ++i) mean_[i] = std::clamp(mean_[i] + step_ * move[i], 0.0, 1.0);

  // C^(-1/2) of the mean's move.
  std::vector<double> whitened(n_, 0.0);
  for (std::size_t k = 0; k < n_; ++k) {
    double along = 0.0;
    for (std::size_t i = 0; i < n_; ++i) along += eigen_.vectors[i * n_ + k] * move[i];
    along /= std::sqrt(std::max(eigen_.values[k], 1e-20));
    for (std::size_t i = 0; i < n_; ++i) whitened[i] += eigen_.vectors[i * n_ + k] * along;
  }
  double decay = 1.0;  // (1 - c_step)^(2 generations)
  for (std::uint32_t i = 0; i < 2 * generation_; ++i) decay *= 1.0 - c_step;
  for (std::size_t i = 0; i < n_; ++i) {
    step_path_[i] =
        (1.0 - c_step) * step_path_[i] + std::sqrt(c_step * (2.0 - c_step) * effective_) * whitened[i];
  }
  const double length = Norm(step_path_);
  const double stalls = length / std::sqrt(1.0 - decay) < (1.4 + 2.0 / (n + 1.0)) * expected ? 1.0 : 0.0;
  for (std::size_t i = 0; i < n_; ++i) {
    covariance_path_[i] = (1.0 - c_path) * covariance_path_[i] +
                          stalls * std::sqrt(c_path * (2.0 - c_path) * effective_) * move[i];
  }
  const double lost = (1.0 - stalls) * c_path * (2.0 - c_path);
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) {
      double rank_mu = 0.0;
      for (std::size_t rank = 0; rank < weights_.size(); ++rank)
        rank_mu += weights_[rank] * moves[rank][i] * moves[rank][j];
      double& one = covariance_[i * n_ + j];
      one = (1.0 - c_one - c_rank + c_one * lost) * one + c_one * covariance_path_[i] * covariance_path_[j] +
            c_rank * rank_mu;
    }
  }
  constexpr double kLargestStep = 1.0;
  step_ = std::min(kLargestStep, step_ * sim::Exp(c_step / damping * (length / expected - 1.0)));
  eigen_ = EigensystemOf(covariance_, n_);
}

}  // namespace gauntlet
