#include "search/repair/cma_es.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "sim/random/random_stream.h"

namespace gauntlet {
namespace {

TEST(Eigensystem, OfAKnownMatrix) {
  const Eigensystem system = EigensystemOf({2.0, 1.0, 1.0, 2.0}, 2);
  EXPECT_NEAR(std::min(system.values[0], system.values[1]), 1.0, 1e-14);
  EXPECT_NEAR(std::max(system.values[0], system.values[1]), 3.0, 1e-14);
}

TEST(Eigensystem, VectorsAreOrthonormalAndMakeTheMatrixAgain) {
  constexpr std::size_t kSize = 7;
  sim::RandomStream random(5, sim::StreamPurpose::kTest);
  std::vector<double> matrix(kSize * kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = 0; j <= i; ++j) matrix[i * kSize + j] = matrix[j * kSize + i] = random.Gaussian();
  }
  const Eigensystem system = EigensystemOf(matrix, kSize);
  for (std::size_t i = 0; i < kSize; ++i) {
    for (std::size_t j = 0; j < kSize; ++j) {
      double product = 0.0;
      double again = 0.0;
      for (std::size_t k = 0; k < kSize; ++k) {
        product += system.vectors[k * kSize + i] * system.vectors[k * kSize + j];
        again += system.vectors[i * kSize + k] * system.values[k] * system.vectors[j * kSize + k];
      }
      EXPECT_NEAR(product, i == j ? 1.0 : 0.0, 1e-12);
      EXPECT_NEAR(again, matrix[i * kSize + j], 1e-12);
    }
  }
}

using Function = std::function<double(const SettingsPoint&)>;

void Descend(CmaEs& search, const Function& value, int generations) {
  for (int i = 0; i < generations; ++i) {
    const std::vector<SettingsPoint> points = search.Ask();
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t one) { return value(points[one]); });
    search.Tell(order);
  }
}

TEST(CmaEs, FindsTheMinimumOfANarrowTurnedValley) {
  const Function valley = [](const SettingsPoint& x) {
    const double along = (x[0] - 0.3) + (x[1] - 0.6);
    const double across = (x[0] - 0.3) - (x[1] - 0.6);
    return along * along + 1e4 * across * across + (x[2] - 0.5) * (x[2] - 0.5);
  };
  CmaEs search({0.8, 0.2, 0.9}, 0.25, 3);
  Descend(search, valley, 150);
  EXPECT_LT(valley(search.mean()), 1e-8);
}

TEST(CmaEs, StaysInTheRangesAndGoesToTheirCorner) {
  const Function corner = [](const SettingsPoint& x) { return x[0] - x[1]; };
  CmaEs search({0.5, 0.5}, 0.25, 4);
  for (int i = 0; i < 40; ++i) {
    for (const SettingsPoint& point : CmaEs(search).Ask()) {
      for (const double place : point) EXPECT_TRUE(place >= 0.0 && place <= 1.0) << place;
    }
    Descend(search, corner, 1);
  }
  EXPECT_LT(search.mean()[0], 0.02);
  EXPECT_GT(search.mean()[1], 0.98);
}

TEST(CmaEs, HasTheTutorialsNumbersOfProposalsAndParents) {
  for (const auto& [dimensions, population] : {std::pair(1, 4), {2, 6}, {7, 9}, {10, 10}}) {
    const CmaEs search(SettingsPoint(static_cast<std::size_t>(dimensions), 0.5), 0.25, 1);
    EXPECT_EQ(search.population(), static_cast<std::size_t>(population));
    EXPECT_EQ(search.parents(), static_cast<std::size_t>(population) / 2);
  }
}

TEST(CmaEs, TheSeedDecidesEverything) {
  CmaEs one({0.5, 0.5}, 0.25, 9);
  CmaEs same({0.5, 0.5}, 0.25, 9);
  CmaEs other({0.5, 0.5}, 0.25, 10);
  EXPECT_EQ(one.Ask(), same.Ask());
  EXPECT_NE(one.Ask(), other.Ask());
}

}  // namespace
}  // namespace gauntlet
