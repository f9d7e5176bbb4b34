// A Gaussian process that stands for a statistic of runs as a function of their settings, learnt from noisy
// estimates of it (Rasmussen and Williams 2006, chapter 2; as a stand-in for a stochastic simulator
// Andrianakis et al. 2015). Matern kernel of smoothness 5/2 with a length for each input, a linear kernel,
// and noise that is known for each estimate. The same bits on every machine: nothing of it depends on caches
// or libm.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace gauntlet {

inline double Squared(double x) {
  return x * x;
}

// The lower triangle L of L L' in place of a symmetric matrix, of which the lower triangle is read; false
// when it is not positive definite. Column by column, so that no sum depends on how it is cut.
bool Cholesky(Eigen::MatrixXd& matrix);
// L^-1 b in place.
void SolveLower(const Eigen::MatrixXd& factor, Eigen::VectorXd& b);

class Emulator {
 public:
  using Input = Eigen::Ref<const Eigen::VectorXd>;
  struct Prediction {
    double mean = 0.0;
    double variance = 0.0;  // of the statistic's expectation, as far as it is not known
  };
  // Column i of `inputs` gave estimate `values[i]` with sampling variance `noise[i]`, at least two of each.
  // The shape is the likeliest one found.
  Emulator(Eigen::MatrixXd inputs, std::span<const double> values, std::span<const double> noise);

  Prediction At(const Input& input) const;

 private:
  // What the kernel looks like, as natural logarithms: a length for each input, then the standard deviation
  // of the process, and that of what is left unexplained beside the known noise.
  using Shape = std::vector<double>;

  // Of columns 0, stride, 2 stride, ...: the Cholesky factor of their covariance, and L^-1 y. False: it has
  // none.
  bool Factorise(const Shape& shape, Eigen::Index stride);
  // Logarithm of the marginal likelihood, and of weak priors over the shape.
  double LogEvidence(const Shape& shape, Eigen::Index stride);
  double Kernel(const Input& a, const Input& b) const;
  void SetShape(const Shape& shape);

  Eigen::MatrixXd inputs_;
  Eigen::VectorXd values_;  // mean 0, standard deviation 1
  Eigen::VectorXd noise_;   // in the same scale
  double middle_ = 0.0;
  double scale_ = 1.0;
  Shape shape_;
  Eigen::VectorXd inverse_lengths_;
  double process_variance_ = 1.0;
  double nugget_ = 0.0;
  Eigen::MatrixXd factor_;    // lower triangle
  Eigen::VectorXd solution_;  // L^-1 y
  Eigen::MatrixXd used_;      // the inputs that factor_ is of
};

}  // namespace gauntlet
