#include "controllers/partitioning/source_estimate.h"

#include <cmath>

#include "gtest/gtest.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::controllers {
namespace {

using sim::kPi;

// One trip in the world's frame: nest at the origin, the robot gets an item at (0, 4), drives `way` towards
// the nest and back again, turning on the spot. Returns where it then believes the source to be, from where
// it is.
sim::Vec2 AfterTrip(SourceEstimate& estimate, double way, sim::RandomStream& random) {
  double heading = -sim::kPi / 2.0;
  estimate.Begin(0.0, random);
  for (int leg = 0; leg < 2; ++leg) {
    for (int i = 0; i < 100; ++i) estimate.Move({{way / 100.0, 0.0}, 0.0}, true);
    estimate.Move({sim::Vec2::Zero(), sim::kPi}, true);
    heading += sim::kPi;
  }
  const sim::Vec2 seen = estimate.value();
  return seen.norm() * sim::UnitVector(sim::WrapAngle(heading) + sim::AngleOf(seen));
}

TEST(SourceEstimate, IsWhereTheItemWasWithoutErrors) {
  SourceEstimate estimate(0.0);
  sim::RandomStream random(4, sim::StreamPurpose::kTest);
  EXPECT_NEAR(AfterTrip(estimate, 2.0, random).norm(), 0.0, 1e-12);
}

// Worked by hand for the published program: 2 m and back are 4 m, counted as 5; twice the gap of an arc of
// curvature 0.0027 / 0.14 is 5^2 0.0027 / 0.14 = 0.482 m for a draw of exactly the scale. The mean square of
// a Rayleigh distribution is twice its scale's square.
TEST(SourceEstimate, IsOffAsInThePublishedProgram) {
  double squares = 0.0;
  constexpr int kTrips = 2000;
  SourceEstimate estimate(0.0027);
  sim::RandomStream random(4, sim::StreamPurpose::kTest);
  for (int trip = 0; trip < kTrips; ++trip) {
    const sim::Vec2 error = AfterTrip(estimate, 2.0, random);
    ASSERT_LT(error.x(), 0.0) << "left of the line from nest to source is -x here";
    ASSERT_LT(std::abs(error.y()), 0.2 * std::abs(error.x()) + 1e-9);
    squares += error.x() * error.x();
  }
  EXPECT_NEAR(std::sqrt(squares / kTrips), 0.482 * std::sqrt(2.0), 0.03);
}

TEST(SourceEstimate, ErrorsGrowWhileTravellingOnly) {
  SourceEstimate estimate(0.1);
  sim::RandomStream random(4, sim::StreamPurpose::kTest);
  estimate.Begin(1.0, random);
  for (int i = 0; i < 100; ++i) estimate.Move({{0.01, 0.0}, 0.1}, false);
  for (int i = 0; i < 100; ++i) estimate.Move({sim::Vec2::Zero(), 0.1}, true);
  const double exact = estimate.value().norm();
  SourceEstimate without(0.0);
  without.Begin(1.0, random);
  for (int i = 0; i < 100; ++i) without.Move({{0.01, 0.0}, 0.1}, false);
  EXPECT_NEAR(exact, without.value().norm(), 1e-12);
}

}  // namespace
}  // namespace gauntlet::controllers
