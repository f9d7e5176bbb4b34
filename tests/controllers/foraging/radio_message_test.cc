#include "controllers/foraging/radio_message.h"

#include <cmath>
#include <limits>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

TEST(RadioMessage, SurvivesItsTenBytes) {
  for (int state = 0; state < kForagingStates; ++state) {
    const RadioMessage message{.sender = RadioMessage::Sender::kRobot,
                               .state = static_cast<ForagingState>(state),
                               .carrying = state % 2 == 1,
                               .first = 0.1F + static_cast<float>(state),
                               .second = std::numeric_limits<float>::infinity()};
    EXPECT_EQ(Decode(Encode(message)), message);
  }
  const RadioMessage nest{.sender = RadioMessage::Sender::kNest};
  EXPECT_EQ(Decode(Encode(nest)), nest);
}

TEST(RadioMessage, HasFixedBytes) {
  const sim::Payload payload = Encode({.sender = RadioMessage::Sender::kRobot,
                                       .state = ForagingState::kBeacon,
                                       .carrying = false,
                                       .first = 1.0F,
                                       .second = -2.0F});
  EXPECT_THAT(payload, ::testing::ElementsAre(7, 0, 0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0));
}

TEST(RadioMessage, SilenceAndGarbageComeFromNobody) {
  EXPECT_EQ(Decode(sim::Payload{}).sender, RadioMessage::Sender::kNobody);
  EXPECT_EQ(Decode(sim::Payload{8}).sender, RadioMessage::Sender::kNobody);
  EXPECT_EQ(Decode(sim::Payload{200, 1, 2, 3}).sender, RadioMessage::Sender::kNobody);
  EXPECT_EQ(Encode({}), sim::Payload{});
}

}  // namespace
}  // namespace gauntlet::controllers
