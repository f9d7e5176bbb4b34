// Files for ARGoS: that it loads them, by the rules that were found by deleting one thing after the other
// from files that it loads, and that they are read back as what they were.
#include "search/cases/argos_export.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <pugixml.hpp>

#include "controllers/registry.h"
#include "controllers/run_start.h"
#include "proto/case_json.h"
#include "search/cases/case_file.h"

namespace gauntlet {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

sim::RunSpec SpecOf(const std::string& scenario) {
  sim::RunSpec spec;
  spec.scenario = scenario;
  spec.controller = controllers::FindScenario(scenario)->default_controller;
  spec.seed = 8'000'000'000'000'000'001;
  spec.test_case.name = "a \"case\" -- of <two>";
  spec.test_case.obstacles = {{0.1 + 0.2, -0.4 / 3, 0.6, 0.2, 322.0}, {-0.8, 0.7, 0.4, 0.4, 0.1}};
  return spec;
}

ArgosFile FileOf(const sim::RunSpec& spec, const ArgosControllers* controllers = nullptr) {
  const auto start = controllers::StartOf(spec);
  EXPECT_TRUE(start.ok()) << start.error().message;
  return WriteArgos(spec, *start, controllers, "A run.");
}

// What ARGoS would not load or run, a sentence each.
class Loading {
 public:
  explicit Loading(const std::string& text) {
    EXPECT_TRUE(document_.load_buffer(text.data(), text.size()));
    root_ = document_.document_element();
    Want(std::string_view(root_.name()) == "argos-configuration", "another root");
    JudgeFramework();
    JudgeControllers();
    JudgeArena();
    Want(root_.child("physics_engines").child("dynamics2d").attribute("id"), "no physics engine");
    for (const auto& medium : media_)
      Want(root_.child("media").find_child_by_attribute("id", medium.c_str()), "no medium " + medium);
    Want(!root_.child("visualization"), "a visualization, which a program without a screen has not");
  }
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  void Want(bool condition, const std::string& complaint) {
    if (!condition) complaints_.push_back(complaint);
  }

  void JudgeFramework() {
    const pugi::xml_node experiment = root_.child("framework").child("experiment");
    Want(experiment.attribute("ticks_per_second").as_int() == 10, "no ticks_per_second");
    Want(experiment.attribute("length").as_double() > 0.0, "no end");
    const long long seed = experiment.attribute("random_seed").as_llong();
    Want(seed > 0 && seed < 1LL << 32, "a seed that is none or the time of day");
  }

  void JudgeControllers() {
    for (const pugi::xml_node controller : root_.child("controllers")) {
      Want(controller.attribute("id"), "a controller without id");
      controllers_.insert(controller.attribute("id").value());
      const bool lua = std::string_view(controller.name()) == "lua_controller";
      Want(lua || controller.attribute("library"), "a controller without library");
      Want(controller.child("params"), "a controller without params");
      for (const char* group : {"actuators", "sensors"}) {
        Want(controller.child(group), std::string("a controller without ") + group);
        for (const pugi::xml_node device : controller.child(group)) JudgeDevice(group, device);
      }
    }
  }

  void JudgeDevice(const std::string& group, const pugi::xml_node& device) {
    const std::string name = device.name();
    Want(device.attribute("implementation"), name + " without implementation");
    const bool reads_medium = name == "leds" || name == "colored_blob_omnidirectional_camera" ||
                              (name == "range_and_bearing" && group == "sensors");
    Want(!reads_medium || device.attribute("medium"), name + " without medium");
    if (device.attribute("medium")) media_.insert(device.attribute("medium").value());
    const bool ground = name == "footbot_motor_ground" || name == "footbot_base_ground";
    Want(!ground || root_.child("arena").child("floor"), name + " without a floor");
  }

  void JudgeArena() {
    const pugi::xml_node arena = root_.child("arena");
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    Want(std::sscanf(arena.attribute("size").value(), "%lf,%lf,%lf", &x, &y, &z) == 3, "no size");
    Want(z >= 1.0, "an arena lower than 1 m");
    EXPECT_EQ(arena.attribute("center").value(), fmt::format("0,0,{}", z / 2)) << "the floor is at 0";
    std::set<std::string> ids;
    for (const pugi::xml_node entity : arena) {
      const std::string name = entity.name();
      Want(ids.insert(entity.attribute("id").value()).second && entity.attribute("id"),
           name + " without an id of its own");
      if (name == "floor") Want(entity.attribute("pixels_per_meter"), "a floor without pixels");
      if (name == "box") Want(entity.child("body") && entity.attribute("size"), "a box without body or size");
      if (name == "light") JudgeLight(entity, {x / 2, y / 2, std::floor(z)});
      if (name == "foot-bot") JudgeRobot(entity);
    }
  }

  void JudgeLight(const pugi::xml_node& light, const std::array<double, 3>& limits) {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    Want(std::sscanf(light.attribute("position").value(), "%lf,%lf,%lf", &x, &y, &z) == 3, "a light nowhere");
    Want(std::abs(x) < limits[0] && std::abs(y) < limits[1] && z < limits[2], "a light outside of the grid");
    for (const char* name : {"color", "intensity", "medium"})
      Want(light.attribute(name), std::string("a light without ") + name);
    media_.insert(light.attribute("medium").value());
  }

  void JudgeRobot(const pugi::xml_node& robot) {
    Want(robot.child("body").attribute("position"), "a robot without a position");
    Want(controllers_.contains(robot.child("controller").attribute("config").value()),
         "a robot without a controller");
  }

  pugi::xml_document document_;
  pugi::xml_node root_;
  std::set<std::string> controllers_;
  std::set<std::string> media_;
  std::vector<std::string> complaints_;
};

class ArgosExport : public testing::TestWithParam<std::string> {};

TEST_P(ArgosExport, GivesWhatArgosLoads) {
  const sim::RunSpec spec = SpecOf(GetParam());
  EXPECT_THAT(Loading(FileOf(spec).text).complaints(), IsEmpty());
}

TEST_P(ArgosExport, PutsEveryRobotWhereTheRunHasIt) {
  const sim::RunSpec spec = SpecOf(GetParam());
  const auto start = controllers::StartOf(spec);
  ASSERT_TRUE(start.ok());
  const std::string text = FileOf(spec).text;
  const Result<LoadedCase> read = ParseArgos(text, "c.argos");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->notice, "");
  const std::vector<sim::Pose>& poses = read->test_case.start_poses;
  std::size_t tested = 0;
  for (const sim::StartingRobot& robot : start->robots) {
    if (!robot.under_test) continue;
    ASSERT_LT(tested, poses.size());
    EXPECT_EQ(poses[tested].position, robot.pose.position);
    EXPECT_EQ(poses[tested].heading, robot.pose.heading);
    ++tested;
  }
  EXPECT_EQ(poses.size(), tested);

  // The case that was read begins with the same swarm whatever the seed, and gives the same file again.
  sim::RunSpec again = spec;
  again.test_case = read->test_case;
  EXPECT_EQ(FileOf(again).text, text);
  again.seed = 5;
  const auto elsewhere = controllers::StartOf(again);
  ASSERT_TRUE(elsewhere.ok()) << elsewhere.error().message;
  for (std::size_t i = 0; i < start->robots.size(); ++i)
    EXPECT_EQ(elsewhere->robots[i].pose.position, start->robots[i].pose.position);
}

INSTANTIATE_TEST_SUITE_P(Scenarios, ArgosExport,
                         testing::Values("flocking", "foraging", "task-partitioning", "light-flocking"),
                         [](const auto& scenario) {
                           std::string name = scenario.param;
                           std::erase(name, '-');
                           return name;
                         });

RC_GTEST_PROP(ArgosExportProperty, IsReadBackToTheBit, ()) {
  sim::RunSpec spec;
  sim::TestCase& written = spec.test_case;
  const auto number = [](double least, double most) {
    return least + (most - least) * *rc::gen::inRange(0, 1 << 30) / (1 << 30);
  };
  written.name = *rc::gen::container<std::string>(rc::gen::inRange(' ', '\x7f'));
  written.side_x = number(1.0, 20.0);
  written.side_y = number(1.0, 20.0);
  written.wall_thickness = number(0.05, 0.3);
  if (*rc::gen::arbitrary<bool>()) written.center = {number(-9, 9), number(-9, 9)};
  const int obstacles = *rc::gen::inRange(0, 6);
  for (int i = 0; i < obstacles; ++i) {
    sim::ObstacleGene& gene = written.obstacles.emplace_back(sim::ObstacleGene{
        number(-10, 10), number(-10, 10), number(0.05, 4), number(0.05, 4), number(0, 360)});
    if (*rc::gen::arbitrary<bool>()) gene = {0.0, written.side_y / 2, written.side_x, 0.1, 0.0};  // as a wall
    if (*rc::gen::arbitrary<bool>()) gene.path = {{number(-9, 9), number(-9, 9)}, {number(-9, 9), 0.0}};
    if (*rc::gen::arbitrary<bool>()) gene.speed = number(0.0, 0.05);
    gene.light = *rc::gen::element(sim::Color::kBlack, sim::Color::kRed, sim::Color::kOrange);
  }
  if (*rc::gen::arbitrary<bool>())
    written.spawn_area = sim::Rectangle{{number(-9, 0), -1.0}, {1.0, number(2, 9)}};
  sim::RunStart start;
  const int robots = *rc::gen::inRange(1, 5);
  for (int i = 0; i < robots; ++i) {
    start.robots.push_back({.pose = {{number(-9, 9), number(-9, 9)}, number(-3.14, 3.14)}});
    written.start_poses.push_back(start.robots.back().pose);
  }
  written.robots = robots;

  const std::string text = WriteArgos(spec, start, nullptr, written.name).text;
  const Result<LoadedCase> read = ParseArgos(text, "c.argos");
  if (!read.ok()) RC_FAIL(read.error().message);
  sim::TestCase found = read->test_case;
  RC_ASSERT(proto::WriteCaseJson(found) == proto::WriteCaseJson(written));
  spec.test_case = found;
  RC_ASSERT(WriteArgos(spec, start, nullptr, written.name).text == text);
}

// A robot in ARGoS draws the numbers that it draws here (argos/controller_adapter.cc).
TEST(ArgosExportSeed, IsThatOfControllersThatWereWrittenForArgos) {
  const std::pair<std::uint64_t, const char*> seeds[] = {
      {7, "7"}, {0x2'0000'0005, "7"}, {0x1'0000'0001, "1"}, {0xffff'ffff'0000'0000, "4294967295"}};
  for (const auto& [seed, written] : seeds) {
    sim::RunSpec spec = SpecOf("light-flocking");
    spec.seed = seed;
    EXPECT_THAT(FileOf(spec).text, HasSubstr(fmt::format("random_seed=\"{}\"", written))) << seed;
  }
}

TEST(ArgosExportNotices, SayWhatArgosHasNot) {
  sim::RunSpec spec = SpecOf("foraging");
  spec.test_case.obstacles[1].path = {{-0.8, 0.6}};
  spec.test_case.obstacles[1].speed = 0.02;
  spec.test_case.obstacles[0].light = sim::Color::kRed;
  const ArgosFile file = FileOf(spec);
  for (const char* part : {"placeholder", "that move stand", "no lamps", "The nest is a disc of radius 0.5 m",
                           "loop functions", "come from no robot", "hide messages"}) {
    EXPECT_THAT(file.notices, Contains(HasSubstr(part)));
    EXPECT_THAT(file.text.substr(0, file.text.find("<argos-configuration>")), HasSubstr(part));
  }
  EXPECT_THAT(FileOf(SpecOf("light-flocking")).notices, testing::SizeIs(1));
}

TEST(ArgosExportControllers, AreThoseOfAFile) {
  const ArgosControllers given = {R"(<mine id="m" library="libmine"><actuators/><sensors/><params/></mine>)",
                                  "m"};
  const ArgosFile file = FileOf(SpecOf("flocking"), &given);
  EXPECT_THAT(Loading(file.text).complaints(), IsEmpty());
  EXPECT_THAT(file.text, HasSubstr(R"(<mine id="m" library="libmine">)"));
  EXPECT_THAT(file.text, HasSubstr(R"(<controller config="m" />)"));
  EXPECT_THAT(file.text, HasSubstr(R"(<controller config="scenario" />)"));  // the prey
  EXPECT_THAT(file.notices, Not(Contains(HasSubstr("placeholder"))));
}

}  // namespace
}  // namespace gauntlet
