// The hand-over between two robots, message by message, whatever happens to either of them.
#include "controllers/partitioning/handover.h"

#include <rapidcheck/gtest.h>

#include <optional>
#include <vector>

#include "gtest/gtest.h"

namespace gauntlet::controllers {
namespace {

constexpr HandoverSettings kSettings = {
    .begin_reach = 0.25, .keep_reach = 0.30, .transfer = 150, .silence = 5, .answer = 20, .bar = 300};

HeardMessage Says(HandoverStep step, int self, int partner = 0, double range = 0.24) {
  return {range,
          {.from_robot = true,
           .step = step,
           .self = static_cast<std::uint8_t>(self),
           .partner = static_cast<std::uint8_t>(partner)}};
}

void Listen(Giver& giver, std::vector<HeardMessage> heard, int ticks = 1) {
  for (int i = 0; i < ticks; ++i) giver.Listen(heard);
}
void Listen(Receiver& receiver, bool at_carrier, std::vector<HeardMessage> heard, int ticks = 1) {
  for (int i = 0; i < ticks; ++i) receiver.Listen(at_carrier, heard);
}

TEST(Giver, OffersUntilAskedAndThenGrantsForTheTransferTime) {
  Giver giver(kSettings, 1);
  EXPECT_EQ(giver.step(), HandoverStep::kOffer);
  Listen(giver, {Says(HandoverStep::kRequest, 4, 1)});
  EXPECT_TRUE(giver.engaged());
  EXPECT_EQ(giver.partner(), 4);
  EXPECT_EQ(giver.step(), HandoverStep::kGrant);
  Listen(giver, {Says(HandoverStep::kRequest, 4, 1)}, 149);
  EXPECT_EQ(giver.step(), HandoverStep::kGrant);
  Listen(giver, {Says(HandoverStep::kRequest, 4, 1)});
  EXPECT_EQ(giver.step(), HandoverStep::kRelease) << "after 15 s";
}

TEST(Giver, TakesTheLowestNumberOfSeveralAndKeepsIt) {
  Giver giver(kSettings, 1);
  Listen(giver, {Says(HandoverStep::kRequest, 4, 1), Says(HandoverStep::kRequest, 2, 1)});
  EXPECT_EQ(giver.partner(), 2);
  Listen(giver, {Says(HandoverStep::kRequest, 0, 1), Says(HandoverStep::kRequest, 2, 1)});
  EXPECT_EQ(giver.partner(), 2);
}

TEST(Giver, IgnoresRequestsToOthersAndFromAfar) {
  Giver giver(kSettings, 1);
  Listen(giver, {Says(HandoverStep::kRequest, 4, 2), Says(HandoverStep::kRequest, 5, 1, 0.31),
                 Says(HandoverStep::kOffer, 6, 1)});
  EXPECT_FALSE(giver.engaged());
}

TEST(Giver, GivesUpAPartnerThatFallsSilentOrGoesAway) {
  for (const auto& heard : {std::vector<HeardMessage>{},
                            {Says(HandoverStep::kRequest, 4, 1, 0.31)},
                            {Says(HandoverStep::kNone, 4)},
                            {Says(HandoverStep::kRequest, 4, 2)}}) {
    Giver giver(kSettings, 1);
    Listen(giver, {Says(HandoverStep::kRequest, 4, 1)}, 100);
    Listen(giver, heard, 5);
    EXPECT_TRUE(giver.engaged()) << "a short silence";
    Listen(giver, heard);
    EXPECT_FALSE(giver.engaged());
    EXPECT_EQ(giver.step(), HandoverStep::kOffer);
    Listen(giver, {Says(HandoverStep::kRequest, 4, 1)});
    EXPECT_EQ(giver.step(), HandoverStep::kGrant) << "from the beginning";
  }
}

TEST(Giver, IsNotHeldForEverByAPartnerThatTakesNothing) {
  Giver giver(kSettings, 1);
  Listen(giver, {Says(HandoverStep::kRequest, 4, 1)}, 150 + 20 + 1);
  EXPECT_TRUE(giver.engaged());
  Listen(giver, {Says(HandoverStep::kRequest, 4, 1)});
  EXPECT_FALSE(giver.engaged());
}

TEST(Receiver, AsksTheNearestWhoOffersWithinReach) {
  Receiver receiver(kSettings, 4);
  Listen(receiver, true, {Says(HandoverStep::kOffer, 1, 0, 0.26), Says(HandoverStep::kOffer, 2, 0, 0.24)});
  EXPECT_TRUE(receiver.engaged());
  EXPECT_EQ(receiver.step(), HandoverStep::kRequest);
  EXPECT_EQ(receiver.partner(), 2);
}

TEST(Receiver, StandsWhileItIsGranted) {
  Receiver receiver(kSettings, 4);
  Listen(receiver, true, {Says(HandoverStep::kOffer, 1)}, 3);
  Listen(receiver, false, {Says(HandoverStep::kGrant, 1, 4)}, 150);  // the beacon is dark now
  Listen(receiver, false, {Says(HandoverStep::kRelease, 1, 4)}, 5);
  EXPECT_TRUE(receiver.engaged());
  receiver.Reset();
  EXPECT_FALSE(receiver.engaged());
  EXPECT_EQ(receiver.step(), HandoverStep::kNone);
}

TEST(Receiver, LeavesWhenAnotherIsGranted) {
  Receiver receiver(kSettings, 4);
  Listen(receiver, true, {Says(HandoverStep::kOffer, 1)}, 2);
  Listen(receiver, true, {Says(HandoverStep::kGrant, 1, 2)});
  EXPECT_FALSE(receiver.engaged());
  EXPECT_FALSE(receiver.barred());
}

TEST(Receiver, LeavesAGiverThatFallsSilentGoesAwayOrChangesItsMind) {
  for (const auto& heard : {std::vector<HeardMessage>{}, {Says(HandoverStep::kGrant, 1, 4, 0.31)}}) {
    Receiver receiver(kSettings, 4);
    Listen(receiver, true, {Says(HandoverStep::kOffer, 1)}, 2);
    Listen(receiver, false, {Says(HandoverStep::kGrant, 1, 4)}, 100);
    Listen(receiver, false, heard, 5);
    EXPECT_TRUE(receiver.engaged());
    Listen(receiver, false, heard);
    EXPECT_FALSE(receiver.engaged());
  }
  for (const HandoverStep step : {HandoverStep::kNone, HandoverStep::kOffer}) {
    Receiver receiver(kSettings, 4);
    Listen(receiver, true, {Says(HandoverStep::kOffer, 1)}, 2);
    Listen(receiver, false, {Says(HandoverStep::kGrant, 1, 4)}, 100);
    Listen(receiver, false, {Says(step, 1)});
    EXPECT_FALSE(receiver.engaged());
  }
}

TEST(Receiver, AGiverThatNeverAnswersIsLeftAndBarred) {
  Receiver receiver(kSettings, 4);
  Listen(receiver, true, {Says(HandoverStep::kOffer, 1)}, 20);
  EXPECT_TRUE(receiver.engaged());
  Listen(receiver, true, {Says(HandoverStep::kOffer, 1)});
  EXPECT_FALSE(receiver.engaged());
  EXPECT_TRUE(receiver.barred());
  Listen(receiver, true, {Says(HandoverStep::kOffer, 1)}, 299);
  EXPECT_FALSE(receiver.engaged());
  Listen(receiver, true, {Says(HandoverStep::kOffer, 1)});
  EXPECT_TRUE(receiver.engaged()) << "after 30 s it may try again";
}

TEST(Receiver, ABeaconWithoutAVoiceIsLeftAndBarred) {
  Receiver receiver(kSettings, 4);
  Listen(receiver, true, {}, 21);
  EXPECT_FALSE(receiver.engaged());
  EXPECT_TRUE(receiver.barred());
}

TEST(Receiver, AGiverThatStopsInTheMiddleIsLeftAndBarred) {
  Receiver receiver(kSettings, 4);
  Listen(receiver, true, {Says(HandoverStep::kOffer, 1)}, 2);
  Listen(receiver, false, {Says(HandoverStep::kGrant, 1, 4)}, 192);
  EXPECT_FALSE(receiver.engaged());
  EXPECT_TRUE(receiver.barred());
}

// Two robots beside each other. Commands of a tick are heard in the next one.
struct Pair {
  Giver giver{kSettings, 1};
  Receiver receiver{kSettings, 4};
  HeardMessage giver_says = Says(HandoverStep::kOffer, 1);
  HeardMessage receiver_says = Says(HandoverStep::kNone, 4);
  bool giver_holds = true;
  bool receiver_holds = false;
  int handed_over_at = -1;

  // One tick in which each hears the other or not, and works or is dead.
  void Tick(int tick, bool in_touch, bool giver_lives = true, bool receiver_lives = true) {
    if (in_touch && giver_says.message.step == HandoverStep::kRelease && giver_says.message.partner == 4 &&
        receiver_says.message.step == HandoverStep::kRequest && receiver_says.message.partner == 1 &&
        giver_holds && !receiver_holds) {
      giver_holds = false;
      receiver_holds = true;
      handed_over_at = tick;
    }
    std::vector<HeardMessage> giver_hears;
    std::vector<HeardMessage> receiver_hears;
    if (in_touch) giver_hears.push_back(receiver_says);
    if (in_touch) receiver_hears.push_back(giver_says);
    const bool beacon = giver_says.message.step == HandoverStep::kOffer;
    if (giver_lives) {
      if (giver_holds) giver.Listen(giver_hears);
      giver_says = giver_holds ? Says(giver.step(), 1, giver.partner()) : Says(HandoverStep::kNone, 1);
    }
    if (receiver_lives) {
      if (receiver_holds) {
        receiver.Reset();
      } else {
        receiver.Listen(in_touch && beacon, receiver_hears);
      }
      receiver_says = Says(receiver.step(), 4, receiver.partner());
    }
  }
};

TEST(Handover, TakesFifteenSecondsAndAFewTicks) {
  Pair pair;
  for (int tick = 0; tick < 200; ++tick) pair.Tick(tick, true);
  EXPECT_TRUE(pair.receiver_holds);
  EXPECT_GE(pair.handed_over_at, 150);
  EXPECT_LE(pair.handed_over_at, 156);
}

// Whenever one of them dies (and goes on saying what it said last) or they lose each other for a while: there
// is one item, and who lives stands no longer than a bounded time.
RC_GTEST_PROP(Handover, OneItemWhateverHappens, ()) {
  Pair pair;
  const int dies = *rc::gen::inRange(0, 200);
  const int who = *rc::gen::inRange(0, 3);  // 2 = nobody
  const int parts = *rc::gen::inRange(0, 200);
  const int apart = *rc::gen::inRange(0, 12);
  for (int tick = 0; tick < 420; ++tick) {
    const bool in_touch = tick < parts || tick >= parts + apart;
    pair.Tick(tick, in_touch, who != 0 || tick < dies, who != 1 || tick < dies);
    RC_ASSERT(pair.giver_holds != pair.receiver_holds);
  }
  if (who == 2) RC_ASSERT(pair.receiver_holds);
  RC_TAG(pair.receiver_holds ? "handed over" : "kept");
}

TEST(Handover, ADeadPartnerHoldsNobodyForEver) {
  for (int dies = 0; dies < 160; dies += 3) {
    Pair giver_dies;
    int standing = 0;  // longest time the receiver stood
    int now = 0;
    for (int tick = 0; tick < 1000; ++tick) {
      giver_dies.Tick(tick, true, tick < dies, true);
      now = giver_dies.receiver.engaged() ? now + 1 : 0;
      standing = std::max(standing, now);
    }
    EXPECT_LE(standing, 150 + 5 * 20) << "giver died in tick " << dies;
    EXPECT_NE(giver_dies.giver_holds, giver_dies.receiver_holds);
    Pair receiver_dies;
    for (int tick = 0; tick < 1000; ++tick) receiver_dies.Tick(tick, true, true, tick < dies);
    EXPECT_FALSE(receiver_dies.giver_holds && receiver_dies.giver.engaged()) << dies;
    EXPECT_NE(receiver_dies.giver_holds, receiver_dies.receiver_holds);
  }
}

}  // namespace
}  // namespace gauntlet::controllers
