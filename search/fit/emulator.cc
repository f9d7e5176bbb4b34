#include "search/fit/emulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/check.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

// The prior standard deviation of a slope, in standard deviations of the estimates for each whole range.
constexpr double kSlope = 1.5;
constexpr double kJitter = 1e-8;
// The shape is looked for on at most so many of the estimates: it costs the cube of their number.
constexpr Eigen::Index kMostForShape = 160;
// Lognormal priors, median and width, that keep a shape away from where few estimates say nothing.
constexpr double kLengthMedian = 0.8;
constexpr double kLengthWidth = 0.8;
constexpr double kProcessWidth = 1.5;
constexpr double kNuggetMedian = 0.03;
constexpr double kNuggetWidth = 1.5;
// Steps of the search, in logarithms.
constexpr double kSteps[] = {0.8, 0.4, 0.2};

double Sum(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) sum += a(i) * b(i);
  return sum;
}

}  // namespace

bool Cholesky(Eigen::MatrixXd& matrix) {
  const Eigen::Index n = matrix.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < j; ++k)
      matrix.col(j).tail(n - j) -= matrix(j, k) * matrix.col(k).tail(n - j);
    if (!(matrix(j, j) > 0.0)) return false;
    matrix.col(j).tail(n - j) /= std::sqrt(matrix(j, j));
  }
  return true;
}

void SolveLower(const Eigen::MatrixXd& factor, Eigen::VectorXd& b) {
  const Eigen::Index n = factor.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    b(j) /= factor(j, j);
    b.tail(n - j - 1) -= b(j) * factor.col(j).tail(n - j - 1);
  }
}

Emulator::Emulator(Eigen::MatrixXd inputs, std::span<const double> values, std::span<const double> noise)
    : inputs_(std::move(inputs)), values_(inputs_.cols()), noise_(inputs_.cols()) {
  const Eigen::Index n = inputs_.cols();
  GAUNTLET_CHECK(n >= 2 && std::ssize(values) == n && std::ssize(noise) == n, "estimates do not fit");
  double sum = 0.0;
  for (const double value : values) sum += value;
  middle_ = sum / static_cast<double>(n);
  double squares = 0.0;
  for (const double value : values) squares += Squared(value - middle_);
  scale_ = std::sqrt(squares / static_cast<double>(n));
  if (!(scale_ > 1e-12 * std::abs(middle_))) scale_ = 1.0;  // but for rounding they are equal
  for (Eigen::Index i = 0; i < n; ++i) {
    values_(i) = (values[static_cast<std::size_t>(i)] - middle_) / scale_;
    noise_(i) = noise[static_cast<std::size_t>(i)] / Squared(scale_);
  }
  const auto dimensions = static_cast<std::size_t>(inputs_.rows());
  shape_.assign(dimensions, sim::Log(kLengthMedian));
  shape_.push_back(0.0);
  shape_.push_back(sim::Log(kNuggetMedian));
  const Eigen::Index stride = (n + kMostForShape - 1) / kMostForShape;
  double best = LogEvidence(shape_, stride);
  for (const double step : kSteps) {
    for (double& number : shape_) {
      const double here = number;
      double best_here = here;
      for (const double sign : {1.0, -1.0}) {
        for (double offset = sign * step; std::abs(offset) < 2.5 * step; offset += sign * step) {
          number = here + offset;
          const double evidence = LogEvidence(shape_, stride);
          if (!(evidence > best)) break;
          best = evidence;
          best_here = number;
        }
        if (best_here != here) break;
      }
      number = best_here;
    }
  }
  GAUNTLET_CHECK(Factorise(shape_, 1), "a covariance without a Cholesky factor");
}

void Emulator::SetShape(const Shape& shape) {
  inverse_lengths_.resize(inputs_.rows());
  for (Eigen::Index d = 0; d < inputs_.rows(); ++d)
    inverse_lengths_(d) = sim::Exp(-shape[static_cast<std::size_t>(d)]);
  process_variance_ = sim::Exp(2.0 * shape[shape.size() - 2]);
  nugget_ = sim::Exp(2.0 * shape.back());
}

double Emulator::Kernel(const Input& a, const Input& b) const {
  double squared = 0.0;
  double product = 0.0;
  for (Eigen::Index d = 0; d < a.size(); ++d) {
    squared += Squared((a(d) - b(d)) * inverse_lengths_(d));
    product += (a(d) - 0.5) * (b(d) - 0.5);
  }
  const double r = std::sqrt(5.0 * squared);
  return process_variance_ * (1.0 + r + r * r / 3.0) * sim::Exp(-r) + kSlope * kSlope * product;
}

bool Emulator::Factorise(const Shape& shape, Eigen::Index stride) {
  SetShape(shape);
  const Eigen::Index n = (inputs_.cols() + stride - 1) / stride;
  used_.resize(inputs_.rows(), n);
  solution_.resize(n);
  factor_.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    used_.col(i) = inputs_.col(i * stride);
    solution_(i) = values_(i * stride);
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) factor_(i, j) = Kernel(used_.col(i), used_.col(j));
    factor_(j, j) += noise_(j * stride) + nugget_ + kJitter;
  }
  if (!Cholesky(factor_)) return false;
  SolveLower(factor_, solution_);
  return true;
}

double Emulator::LogEvidence(const Shape& shape, Eigen::Index stride) {
  if (!Factorise(shape, stride)) return -std::numeric_limits<double>::infinity();
  double log = -0.5 * Sum(solution_, solution_);
  for (Eigen::Index i = 0; i < factor_.rows(); ++i) log -= sim::Log(factor_(i, i));
  const auto prior = [&](double number, double median, double width) {
    log -= 0.5 * Squared((number - sim::Log(median)) / width);
  };
  for (std::size_t d = 0; d + 2 < shape.size(); ++d) prior(shape[d], kLengthMedian, kLengthWidth);
  prior(shape[shape.size() - 2], 1.0, kProcessWidth);
  prior(shape.back(), kNuggetMedian, kNuggetWidth);
  return log;
}

Emulator::Prediction Emulator::At(const Input& input) const {
  Eigen::VectorXd covariance(used_.cols());
  for (Eigen::Index i = 0; i < used_.cols(); ++i) covariance(i) = Kernel(input, used_.col(i));
  SolveLower(factor_, covariance);
  const double variance = Kernel(input, input) - Sum(covariance, covariance) + nugget_;
  return {middle_ + scale_ * Sum(covariance, solution_), Squared(scale_) * std::max(variance, 0.0)};
}

}  // namespace gauntlet
