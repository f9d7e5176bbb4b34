#include "search/fit/emulator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

double Curve(double x, double y) {
  return std::sin(4.0 * x) + 2.0 * y * y - 3.0 * y;
}

struct Noisy {
  Eigen::MatrixXd inputs;
  std::vector<double> values;
};

Noisy EstimatesOfCurve(int count, double noise) {
  sim::RandomStream random(7, sim::StreamPurpose::kTest);
  Noisy estimates{Eigen::MatrixXd(2, count), {}};
  for (int i = 0; i < count; ++i) {
    estimates.inputs(0, i) = random.Uniform();
    estimates.inputs(1, i) = random.Uniform();
    estimates.values.push_back(Curve(estimates.inputs(0, i), estimates.inputs(1, i)) +
                               noise * random.Gaussian());
  }
  return estimates;
}

// Standardised errors at places that it has not seen have about the spread that it promises.
TEST(EmulatorTest, KnowsACurveAndHowWellItKnowsIt) {
  constexpr double kNoise = 0.1;
  const Noisy estimates = EstimatesOfCurve(80, kNoise);
  const Emulator emulator(estimates.inputs, estimates.values, std::vector<double>(80, kNoise * kNoise));
  sim::RandomStream random(8, sim::StreamPurpose::kTest);
  double squares = 0.0;
  double standardised = 0.0;
  constexpr int kPlaces = 400;
  for (int i = 0; i < kPlaces; ++i) {
    const Eigen::Vector2d place(random.Uniform(), random.Uniform());
    const Emulator::Prediction predicted = emulator.At(place);
    const double error = predicted.mean - Curve(place.x(), place.y());
    squares += error * error / kPlaces;
    standardised += error * error / predicted.variance / kPlaces;
  }
  EXPECT_LT(std::sqrt(squares), 0.6 * kNoise);
  EXPECT_GT(standardised, 0.3);
  EXPECT_LT(standardised, 1.6);
}

TEST(EmulatorTest, GoesThroughEstimatesWithoutNoise) {
  const Noisy estimates = EstimatesOfCurve(60, 0.0);
  const Emulator emulator(estimates.inputs, estimates.values, std::vector<double>(60, 1e-10));
  for (Eigen::Index i = 0; i < 60; ++i)
    EXPECT_NEAR(emulator.At(estimates.inputs.col(i)).mean, estimates.values[static_cast<std::size_t>(i)],
                0.03);
}

TEST(EmulatorTest, IsUnsureWhereItHasSeenNothing) {
  Noisy estimates = EstimatesOfCurve(40, 0.0);
  estimates.inputs.row(0) *= 0.3;
  const Emulator emulator(estimates.inputs, estimates.values, std::vector<double>(40, 1e-4));
  const double near = emulator.At(Eigen::Vector2d(0.15, 0.5)).variance;
  EXPECT_GT(emulator.At(Eigen::Vector2d(0.95, 0.5)).variance, 10.0 * near);
}

TEST(EmulatorTest, EqualEstimatesGiveThatValue) {
  const Noisy estimates = EstimatesOfCurve(20, 0.0);
  const Emulator emulator(estimates.inputs, std::vector<double>(20, 3.0), std::vector<double>(20, 0.0));
  EXPECT_NEAR(emulator.At(Eigen::Vector2d(0.5, 0.5)).mean, 3.0, 1e-9);
}

}  // namespace
}  // namespace gauntlet
