#include "proto/run_beginning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace gauntlet::proto {
namespace {

using testing::HasSubstr;

sim::RunBeginning Beginning() {
  sim::RunStart start;
  start.robots = {{.pose = {{0.1, 1.0 / 3.0}, -2.5},
                   .camera_range = 1.6373,
                   .radio_range = 3.0,
                   .bodies_block_radio = false,
                   .devices = sim::Device::kWheels | sim::Device::kLight,
                   .under_test = false}};
  start.lights = {{.position = {1.0, 2.0},
                   .height = 0.25,
                   .intensity = 3.0,
                   .color = sim::Color::kOrange,
                   .occludable = false}};
  start.radio_beacons = 2;
  start.ground_areas = {
      {.name = "nest", .center = {0.5, 0.5}, .radius = 0.0, .half_extents = {0.2, 0.1}, .grey = 0.7}};
  start.tick_limit = 1234;
  return {{.start = {0.0, 0.1}, .goal = {-2.0, 0.3}, .clearance = 0.4, .inflation = 0.2}, start};
}

TEST(RunBeginning, ReadsBackBitForBit) {
  const sim::RunBeginning written = Beginning();
  const Result<sim::RunBeginning> read = ReadBeginning(WriteBeginning(written), "here");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->requirements.start, written.requirements.start);
  EXPECT_EQ(read->requirements.goal, written.requirements.goal);
  EXPECT_EQ(read->requirements.clearance, written.requirements.clearance);
  EXPECT_EQ(read->requirements.inflation, written.requirements.inflation);
  ASSERT_TRUE(read->start.ok());
  const sim::StartingRobot& robot = read->start->robots.at(0);
  EXPECT_EQ(robot.pose.position, sim::Vec2(0.1, 1.0 / 3.0));
  EXPECT_EQ(robot.pose.heading, -2.5);
  EXPECT_EQ(robot.camera_range, 1.6373);
  EXPECT_EQ(robot.radio_range, 3.0);
  EXPECT_FALSE(robot.bodies_block_radio);
  EXPECT_EQ(robot.devices, sim::Device::kWheels | sim::Device::kLight);
  EXPECT_FALSE(robot.under_test);
  const sim::Light& light = read->start->lights.at(0);
  EXPECT_EQ(light.position, sim::Vec2(1.0, 2.0));
  EXPECT_EQ(light.height, 0.25);
  EXPECT_EQ(light.intensity, 3.0);
  EXPECT_EQ(light.color, sim::Color::kOrange);
  EXPECT_FALSE(light.occludable);
  EXPECT_EQ(read->start->radio_beacons, 2u);
  const sim::GroundArea& area = read->start->ground_areas.at(0);
  EXPECT_EQ(area.name, "nest");
  EXPECT_EQ(area.center, sim::Vec2(0.5, 0.5));
  EXPECT_EQ(area.half_extents, sim::Vec2(0.2, 0.1));
  EXPECT_EQ(area.grey, 0.7);
  EXPECT_EQ(read->start->tick_limit, 1234);
}

TEST(RunBeginning, KeepsWhyARunCannotBegin) {
  sim::RunBeginning refused = Beginning();
  refused.start = InvalidInput("no-room-to-spawn: 3 of 9 robots");
  const Result<sim::RunBeginning> read = ReadBeginning(WriteBeginning(refused), "here");
  ASSERT_TRUE(read.ok());
  ASSERT_FALSE(read->start.ok());
  EXPECT_EQ(read->start.error().message, "no-room-to-spawn: 3 of 9 robots");
}

TEST(RunBeginning, RefusesWhatNoArenaHas) {
  const auto message = [](const sim::RunBeginning& beginning) {
    const Status checked = CheckBeginning(beginning);
    return checked.ok() ? "" : checked.error().message;
  };
  sim::RunBeginning wrong = Beginning();
  wrong.requirements.goal = {0.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(
      message(wrong),
      "what it asks of an arena is wrong: its goal is at (0, nan); up to 1000 m from the middle is possible");
  wrong = Beginning();
  wrong.requirements.clearance = -0.1;
  EXPECT_EQ(message(wrong),
            "what it asks of an arena is wrong: its clearance is -0.1 m; 0 to 100 m is possible");
  wrong = Beginning();
  wrong.start->robots.clear();
  EXPECT_EQ(message(wrong), "its swarm has no robots");
  wrong = Beginning();
  wrong.start->robots[0].pose.position = {1e7, 0.0};
  EXPECT_EQ(message(wrong),
            "its swarm is wrong: its robot is at (1e+07, 0); up to 1000 m from the middle is possible");
}

TEST(RunBeginning, RefusesForeignText) {
  for (const std::string text : {"", "[]", "{}", R"({"format": 2})", R"({"format": 1, "requirements": 3})"}) {
    const Result<sim::RunBeginning> read = ReadBeginning(text, "answer");
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_THAT(read.error().message, HasSubstr("answer"));
  }
}

}  // namespace
TEST(RunBeginning, WhatFewScenariosAskForIsWrittenOnlyThere) {
  sim::RunBeginning written = Beginning();
  const std::string usual = WriteBeginning(written);
  for (const char* key :
       {"cell_size", "asks_for_path", "further_goals", "keep_outs", "standing", "anywhere", "open_share"})
    EXPECT_EQ(usual.find(key), std::string::npos) << key;
  sim::ArenaRequirements& asked = written.requirements;
  asked.cell_size = 0.0085;
  asked.asks_for_path = false;
  asked.further_goals = {{1.0 / 3.0, 2.0}};
  asked.keep_outs = {{{{1.0, 2.0}, {0.1, 0.2}, {0.6, 0.8}}, 0.0}};
  asked.standing = {{{{-1.0, 2.0}, {0.0, 0.0}}, 0.3}};
  asked.least_side = 0.1;
  asked.anywhere = true;
  asked.open_share = 0.75;
  const std::string text = WriteBeginning(written);
  const Result<sim::RunBeginning> read = ReadBeginning(text, "here");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(WriteBeginning(*read), text);
  EXPECT_EQ(read->requirements.cell_size, 0.0085);
  EXPECT_FALSE(read->requirements.asks_for_path);
  EXPECT_EQ(read->requirements.further_goals, asked.further_goals);
  EXPECT_EQ(read->requirements.keep_outs.at(0).box.axis, sim::Vec2(0.6, 0.8));
  EXPECT_EQ(read->requirements.standing.at(0).radius, 0.3);
  EXPECT_EQ(read->requirements.least_side, 0.1);
  EXPECT_TRUE(read->requirements.anywhere);
  EXPECT_EQ(read->requirements.open_share, 0.75);
  asked.keep_outs[0].radius = -1.0;
  EXPECT_THAT(CheckBeginning(written).error().message, HasSubstr("its keep-out is -1 m"));
}

}  // namespace gauntlet::proto
