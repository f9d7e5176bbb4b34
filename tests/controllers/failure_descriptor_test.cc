#include "controllers/failure_descriptor.h"

#include <gtest/gtest.h>

namespace gauntlet::controllers {
namespace {

using Metrics = std::vector<std::pair<std::string, double>>;
using Axes = std::vector<DescriptorAxis>;

TEST(FailureDescriptor, FindsThePlaceWhereBothCoordinatesAreReported) {
  const FailureDescriptor descriptor{.place = {{"x", "y", 1.0}}};
  EXPECT_EQ(descriptor.PlaceOf(Metrics{{"y", 2.0}, {"x", 1.0}}), sim::Vec2(1.0, 2.0));
  EXPECT_EQ(descriptor.PlaceOf(Metrics{{"x", 1.0}}), std::nullopt);
  EXPECT_EQ(descriptor.PlaceOf(Metrics{{"x", 1.0}, {"y", kNowhere}}), std::nullopt);
  EXPECT_EQ(FailureDescriptor{}.PlaceOf(Metrics{{"x", 1.0}, {"y", 2.0}}), std::nullopt);
}

TEST(FailureDescriptor, TakesTheFirstKindThatFits) {
  const FailureDescriptor descriptor{.kinds = {{"taken", 0.0, "none taken"}, {"taken", 5.0, "few taken"}}};
  EXPECT_EQ(descriptor.KindOf(Metrics{{"taken", 0.0}}), 0U);
  EXPECT_EQ(descriptor.KindOf(Metrics{{"taken", 5.0}}), 1U);
  EXPECT_EQ(descriptor.KindOf(Metrics{{"taken", 6.0}}), 2U);
  EXPECT_EQ(descriptor.KindOf(Metrics{}), 2U);
}

TEST(FailureDescriptor, KnowsItsPlaceByTheAxes) {
  const FailureDescriptor descriptor{.place = {{"x", "y", 1.0}}};
  EXPECT_TRUE(descriptor.ArePlaces(Axes{{"x", 0, 1, 2}, {"y", 0, 1, 2}}));
  EXPECT_FALSE(descriptor.ArePlaces(Axes{{"y", 0, 1, 2}, {"x", 0, 1, 2}}));
  EXPECT_FALSE(descriptor.ArePlaces(Axes{{"x", 0, 1, 2}}));
  EXPECT_FALSE(FailureDescriptor{}.ArePlaces(Axes{{"x", 0, 1, 2}, {"y", 0, 1, 2}}));
}

TEST(FailureTypes, AreFoundByTheirNumber) {
  const FailureTypes types{.types = {{1, "no path"}, {3, "no food"}}};
  EXPECT_EQ(types.Find(3)->name, "no food");
  EXPECT_EQ(types.Find(2), nullptr);
}

}  // namespace
}  // namespace gauntlet::controllers
