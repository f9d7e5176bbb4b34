#include "search/cases/argos_template.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controllers/command/placeholders.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

// A file with these parts, which ARGoS would load.
std::string File(const std::string& controllers, const std::string& more = "",
                 const std::string& framework = "<experiment length=\"60\"/>") {
  return "<?xml version=\"1.0\"?>\n<?xml version=\"1.0\"?>\n<!-- mail a@b -- twice -->\n<argos-configuration>"
         "<framework><system threads=\"0\"/>" +
         framework + "</framework><controllers>" + controllers +
         "</controllers><arena size=\"4, 2, 1\" center=\"1,0,.5\"><box id=\"w\" size=\"1,.1,.5\">"
         "<body position=\"0,.5,0\" orientation=\"-90,0,0\"/></box></arena><physics_engines/>" +
         more + "</argos-configuration>";
}

ArgosTemplate Made(const std::string& text, const ArgosTemplateOptions& options = {}) {
  Result<ArgosTemplate> made = MakeArgosTemplate(text, "my.argos", options);
  EXPECT_TRUE(made.ok()) << made.error().message;
  return made.ok() ? *made : ArgosTemplate();
}

std::vector<std::pair<std::string, double>> ParametersOf(const ArgosTemplate& made) {
  std::vector<std::pair<std::string, double>> parameters;
  for (const ArgosParameter& parameter : made.parameters)
    parameters.emplace_back(parameter.name, parameter.value);
  return parameters;
}

// What a run with these obstacles gets.
std::string Filled(const ArgosTemplate& made, const sim::Genome& obstacles) {
  controllers::command::Definition definition;
  sim::RunSpec spec;
  spec.seed = 41;
  spec.test_case.obstacles = obstacles;
  for (const ArgosParameter& parameter : made.parameters) {
    definition.parameters.push_back({.name = parameter.name});
    spec.controller_parameters[parameter.name] = parameter.value;
  }
  EXPECT_TRUE(controllers::command::CheckTemplate(definition, made.text).ok());
  return controllers::command::FillTemplate(definition, made.text, spec);
}

TEST(ArgosTemplateTest, NumbersAreParametersByTheirPlace) {
  const ArgosTemplate one = Made(File(
      R"(<c id="a" library="x"><sensors><light noise_level=".1" show="false"/></sensors>
         <params speed="2.5" range="-5:5" name="3rd"><port at="1"/><port at="-2e-1"/></params></c>)",
      R"(<loop_functions label="f" library="y"><food items="12" radius="nan"/></loop_functions>)"));
  EXPECT_THAT(ParametersOf(one),
              ElementsAre(Pair("speed", 2.5), Pair("port.at", 1.0), Pair("port-2.at", -0.2),
                          Pair("sensors.light.noise_level", 0.1), Pair("loop_functions.food.items", 12.0)));
  EXPECT_THAT(one.libraries, ElementsAre("x", "y"));
  const ArgosTemplate two = Made(File(R"(<c id="a 1"><params v="1"/></c><c id="b"><params v="2"/></c>)"));
  EXPECT_THAT(ParametersOf(two), ElementsAre(Pair("a_1.v", 1.0), Pair("b.v", 2.0)));
}

TEST(ArgosTemplateTest, ARunsFileHasItsSeedItsObstaclesAndTheRecorder) {
  const ArgosTemplate made = Made(File("<c id=\"a\"><params v=\"1.50\" mail=\"a@b@c\"/></c>"));
  const std::string filled = Filled(made, {{0.5, -0.25, 1.0, 0.1, 45.0}, {1.0, 0.0, 0.5, 0.1, 0.0}});
  EXPECT_THAT(filled, HasSubstr("random_seed=\"42\""));
  EXPECT_THAT(filled, HasSubstr("<box id=\"gauntlet_obstacle_1\" size=\"1,0.1,0.5\" movable=\"false\">"));
  EXPECT_THAT(filled, HasSubstr("<body position=\"0.5,-0.25,0\" orientation=\"45,0,0\" />"));
  EXPECT_THAT(filled, HasSubstr("gauntlet_obstacle_2"));
  EXPECT_THAT(filled, HasSubstr("v=\"1.5\" mail=\"a@b@c\""));
  EXPECT_THAT(filled, HasSubstr("<!-- mail a@b - - twice -->")) << "XML wants it so";
  EXPECT_THAT(filled, HasSubstr("<gauntlet_recorder file=\"gauntlet-trajectory.csv\" every=\"1\" />"));
  EXPECT_THAT(WithWorld(filled, "w.txt"), HasSubstr("every=\"1\" world=\"w.txt\""));
  EXPECT_THAT(Filled(made, {}), Not(HasSubstr("gauntlet_obstacle")));
}

TEST(ArgosTemplateTest, WithoutTheRecorderTheFileIsThatOfTheProject) {
  const std::string own = "<visualization><qt-opengl/></visualization>";
  const ArgosTemplate made = Made(File("<c id=\"a\" library=\"/home/x\"><params/></c>", own),
                                  {.moved_libraries = {{"/home/x", "my.adopted/lib/x.so"}}});
  const std::string filled = Filled(made, {});
  EXPECT_THAT(filled, HasSubstr("library=\"my.adopted/lib/x.so\""));
  const std::string exported = WithoutRecorder(filled);
  EXPECT_THAT(exported, HasSubstr("<qt-opengl />"));
  EXPECT_THAT(exported, HasSubstr("library=\"/home/x\""));
  EXPECT_THAT(exported, Not(HasSubstr("gauntlet_")));
  EXPECT_THAT(WithoutRecorder(Filled(Made(File("")), {})), Not(HasSubstr("visualization")));
}

TEST(ArgosTemplateTest, WhatDiffersIsTold) {
  const ArgosTemplate made = Made(File("", "<visualization/>",
                                       "<experiment length=\"0\" random_seed=\"7\" "
                                       "real_time=\"true\"/><profiling file=\"p\" format=\"x\"/>"),
                                  {.length = 12.5});
  std::vector<std::string> elements;
  for (const ArgosRemark& remark : made.differs) elements.push_back(remark.element);
  EXPECT_THAT(elements,
              ElementsAre("framework/experiment length", "framework/experiment real_time",
                          "framework/profiling", "framework/experiment random_seed", "visualization"));
  EXPECT_EQ(made.length, 12.5);
  EXPECT_THAT(made.text, HasSubstr("length=\"12.5\""));
  EXPECT_THAT(made.text, Not(HasSubstr("real_time")));
}

TEST(ArgosTemplateTest, ArenaBoxesAndPathsAreRead) {
  const ArgosTemplate made =
      Made(File("<c id=\"a\"><params script=\"lua/a.lua\" out=\"/tmp/x\" at=\"0.1,2\"/></c>"));
  EXPECT_EQ(made.arena.min, sim::Vec2(-1.0, -1.0));
  EXPECT_EQ(made.arena.max, sim::Vec2(3.0, 1.0));
  ASSERT_TRUE(made.boxes.contains("w"));
  EXPECT_EQ(made.boxes.at("w").orientation_deg, 270.0);
  EXPECT_EQ(made.boxes.at("w").length, 1.0);
  EXPECT_THAT(made.paths, ElementsAre("lua/a.lua", "/tmp/x"));
}

}  // namespace
}  // namespace gauntlet
