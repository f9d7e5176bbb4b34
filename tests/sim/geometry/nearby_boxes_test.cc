#include "sim/geometry/nearby_boxes.h"
#include "tests/support/make_box.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace gauntlet::sim {
namespace {

RC_GTEST_PROP(NearbyBoxes, MissNoBoxInReachOnAnyWay, ()) {
  constexpr double kReach = 0.3;
  NearbyBoxes nearby(kReach);
  const int boxes = *rc::gen::inRange(0, 40);
  const auto coordinate = [] { return *rc::gen::inRange(-3000, 3001) * 1e-3; };
  for (int i = 0; i < boxes; ++i) {
    nearby.AddBox(MakeBox({coordinate(), coordinate()}, *rc::gen::inRange(1, 2000) * 1e-3,
                          *rc::gen::inRange(1, 400) * 1e-3, *rc::gen::inRange(0, 628) * 1e-2));
  }
  nearby.SetVisitors(1);
  Vec2 p(coordinate(), coordinate());
  for (int step = 0; step < 50; ++step) {
    p += Vec2(*rc::gen::inRange(-100, 101) * 1e-3, *rc::gen::inRange(-100, 101) * 1e-3);
    const std::span<const std::size_t> near = nearby.Near(0, p);
    RC_ASSERT(std::ranges::is_sorted(near));
    for (std::size_t i = 0; i < static_cast<std::size_t>(boxes); ++i) {
      const bool listed = std::ranges::find(near, i) != near.end();
      RC_ASSERT(listed || Distance(nearby.box(i), p) > kReach);
    }
  }
}

TEST(NearbyBoxes, LeaveOutFarBoxes) {
  NearbyBoxes nearby(0.3);
  nearby.AddBox(MakeBox({0.0, 0.0}, 0.2, 0.2, 0.0));
  nearby.AddBox(MakeBox({2.0, 0.0}, 0.2, 0.2, 0.0));
  nearby.SetVisitors(1);
  ASSERT_EQ(nearby.Near(0, {1.9, 0.3}).size(), 1u);
  EXPECT_EQ(nearby.Near(0, {1.9, 0.3})[0], 1u);
}

}  // namespace
}  // namespace gauntlet::sim
