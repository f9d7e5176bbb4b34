#include "controllers/site_selection/site_selection_controller.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "controllers/registry.h"
#include "controllers/site_selection/site_selection_registry.h"

namespace gauntlet::controllers::site_selection {
namespace {

using sim::Device;

// One robot under a light that is ahead; steps are a tick.
class Robot {
 public:
  explicit Robot(int number, sim::Parameters changed = {}, std::uint64_t seed = 1)
      : controller_(SettingsWith(std::move(changed)), {.robot = number}), seed_(seed) {
    readings_.light[0] = readings_.light[23] = 0.1;
    On(1.0);
  }

  Robot& On(double grey) {
    readings_.motor_ground.fill(grey);
    return *this;
  }
  Robot& OnEdge(double ahead, double behind) {
    readings_.motor_ground = {ahead, behind, behind, ahead};
    return *this;
  }
  Robot& Near(int sensor, double reading) {
    readings_.proximity[static_cast<std::size_t>(sensor)] = reading;
    return *this;
  }
  SiteState Step(const std::vector<SiteMessage>& messages = {}) {
    std::vector<sim::Message> heard;
    for (const SiteMessage& message : messages) heard.push_back(sim::Message::At(1.0, 0.0, Encode(message)));
    readings_.range_and_bearing = heard;
    sim::RandomStream random(seed_, sim::StreamPurpose::kController, 0, static_cast<std::uint32_t>(++tick_));
    controller_.Step({.tick = tick_, .readings = readings_, .actuators = actuators_, .random = random});
    return controller_.state();
  }
  SiteState StepUntilNot(SiteState state, const std::vector<SiteMessage>& messages = {}) {
    for (int i = 0; i < 100'000 && controller_.state() == state; ++i) Step(messages);
    return controller_.state();
  }
  // Through a site of this quality to the nest.
  Robot& Tell(double quality) {
    On(GreyOf(quality)).Step();
    StepUntilNot(SiteState::kSurvey);
    On(kNestGrey).Step();
    EXPECT_EQ(controller_.state(), SiteState::kTell);
    return *this;
  }
  int ticks() const { return tick_; }
  const SiteSelectionController& controller() const { return controller_; }
  double forward() const { return actuators_.right_wheel + actuators_.left_wheel; }

 private:
  static SiteSelectionSettings SettingsWith(sim::Parameters changed) {
    const auto& table = ImprovedSiteSelectionParameters();
    changed.try_emplace("patience", 600.0);
    return table.Read(*ResolveParameters(table.infos(), changed));
  }

  SiteSelectionController controller_;
  std::uint64_t seed_;
  int tick_ = 0;
  sim::SensorReadings readings_;
  sim::Actuators actuators_;
};

std::vector<SiteMessage> Tellers(int first, int count, Site opinion) {
  std::vector<SiteMessage> messages;
  for (int i = first; i < first + count; ++i)
    messages.push_back({SiteState::kTell, opinion, true, static_cast<std::uint8_t>(i)});
  return messages;
}

TEST(SiteSelectionController, OpinionsAreHalfAndHalfAndSaidFromTheStart) {
  sim::Actuators actuators;
  SiteSelectionController({}, {.robot = 7}).Begin(actuators);
  const SiteMessage said = *DecodeSiteMessage(actuators.message);
  EXPECT_EQ(said.opinion, Site::kB);
  EXPECT_EQ(said.sender, 7);
  EXPECT_FALSE(said.aloud);
  EXPECT_EQ(Robot(0).controller().opinion(), Site::kA);
  EXPECT_FALSE(DecodeSiteMessage({}));
}

TEST(SiteSelectionController, GoesAlongTheLightToItsSite) {
  Robot to_a(0);
  EXPECT_EQ(to_a.Step(), SiteState::kGo);
  EXPECT_GT(to_a.forward(), 0.19) << "the light is ahead";
  Robot to_b(1);
  to_b.Step();
  EXPECT_EQ(to_b.forward(), 0.0) << "turns round";
  EXPECT_EQ(to_b.On(kNestGrey).Step(), SiteState::kGo);
  EXPECT_EQ(to_b.On(GreyOf(0.5)).Step(), SiteState::kSurvey);
}

TEST(SiteSelectionController, SurveysForAWhileThenGoesBackAndTells) {
  Robot robot(0);
  robot.On(GreyOf(1.0)).Step();
  EXPECT_EQ(robot.StepUntilNot(SiteState::kSurvey), SiteState::kBack);
  robot.On(1.0).Step();
  EXPECT_EQ(robot.forward(), 0.0) << "away from the light";
  EXPECT_EQ(robot.OnEdge(kNestGrey, 1.0).Step(), SiteState::kBack) << "not in the nest yet";
  EXPECT_EQ(robot.On(kNestGrey).Step(), SiteState::kTell);
}

TEST(SiteSelectionController, TellsInProportionToTheQuality) {
  for (const double quality : {0.5, 1.0}) {
    double ticks = 0.0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
      Robot robot(0, {}, seed);
      const int begin = robot.Tell(quality).ticks();
      robot.StepUntilNot(SiteState::kTell);
      ticks += robot.ticks() - begin;
    }
    EXPECT_NEAR(ticks / 300.0, 600.0 * quality, 120.0 * quality);
  }
}

TEST(SiteSelectionController, TakesTheMajorityOfTheLastGroupAndItself) {
  const auto decides = [](std::vector<SiteMessage> heard, const std::vector<SiteMessage>& later) {
    heard.insert(heard.end(), later.begin(), later.end());
    Robot robot(0);
    robot.Tell(1.0).StepUntilNot(SiteState::kTell, heard);
    return robot.controller().opinion();
  };
  EXPECT_EQ(decides(Tellers(20, 3, Site::kA), Tellers(1, 4, Site::kB)), Site::kB) << "4 against 1 and itself";
  EXPECT_EQ(decides(Tellers(1, 2, Site::kB), Tellers(20, 2, Site::kA)), Site::kA);
  std::vector<SiteMessage> others = Tellers(9, 3, Site::kB);
  for (SiteMessage& message : others) message.sender = 9;
  EXPECT_EQ(decides(Tellers(1, 1, Site::kA), others), Site::kA)
      << "a robot counts once, however often it tells";
  others = Tellers(9, 3, Site::kB);
  for (SiteMessage& message : others) message.aloud = false;
  EXPECT_EQ(decides({}, others), Site::kA) << "not told";
}

TEST(SiteSelectionController, ATieIsDecidedByChance) {
  int for_b = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Robot robot(0, {}, seed);
    robot.Tell(1.0).StepUntilNot(SiteState::kTell, Tellers(1, 1, Site::kB));
    if (robot.controller().opinion() == Site::kB) ++for_b;
  }
  EXPECT_NEAR(for_b, 100, 25);
}

TEST(SiteSelectionController, OldMessagesDoNotCount) {
  Robot robot(0, {{"tell_time", 600.0}}, 2);
  robot.Tell(1.0);
  while (!robot.controller().Attention(false).Has(Device::kRangeAndBearing)) {
    ASSERT_EQ(robot.Step(Tellers(1, 5, Site::kB)), SiteState::kTell);
  }
  const int begin = robot.ticks();
  robot.StepUntilNot(SiteState::kTell);
  EXPECT_LE(robot.ticks() - begin, 51) << "listens for the last 5 s";
  EXPECT_EQ(robot.controller().opinion(), Site::kA);
}

TEST(SiteSelectionController, TurnsBackAtTheEdgeOfTheNest) {
  Robot robot(0, {{"tell_time", 600.0}}, 2);
  robot.Tell(1.0);
  robot.OnEdge(1.0, kNestGrey).Step();
  EXPECT_TRUE(robot.controller().Attention(false).Has(Device::kLight));
  EXPECT_EQ(robot.forward(), 0.0) << "left it towards the light";
  robot.OnEdge(kNestGrey, 1.0).Step();
  EXPECT_GT(robot.forward(), 0.19);
  robot.On(kNestGrey).Step();
  EXPECT_FALSE(robot.controller().Attention(false).Has(Device::kLight));
}

TEST(SiteSelectionController, FollowsAnObstacleWhenItsPatienceIsOver) {
  Robot robot(0, {{"patience", 2.0}, {"detour_time", 3.0}});
  robot.Near(0, 0.5).Near(23, 0.5);
  for (int i = 0; i < 19; ++i) robot.Step();
  EXPECT_FALSE(robot.controller().on_detour());
  robot.Step();
  EXPECT_TRUE(robot.controller().on_detour());
  for (int i = 0; i < 30; ++i) robot.Step();
  EXPECT_FALSE(robot.controller().on_detour());
}

}  // namespace
}  // namespace gauntlet::controllers::site_selection
