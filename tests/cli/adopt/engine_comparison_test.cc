#include "cli/adopt/engine_comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/process.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class EngineComparisonTest : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) {
    fs::create_directories(fs::path(project_ / name).parent_path());
    std::ofstream(project_ / name) << text;
  }
  EngineComparison Compare(const std::vector<std::string>& kinds,
                           const std::vector<std::string>& controllers) {
    ArgosTemplate form;
    form.controllers = controllers;
    return CompareEngines(
        {.argos_file = project_ / "my.argos",
         .project = project_.path(),
         .form = form,
         .starts = {},
         .kinds = kinds,
         .run = [](const std::string&) -> Result<TrialRun> { return InvalidInput("unused"); }});
  }

  testing_support::TemporaryDirectory project_;
};

TEST_F(EngineComparisonTest, SourcesAreThoseBesideTheOneThatRegistersIt) {
  Write("controllers/walk/walk.cpp", "REGISTER_CONTROLLER( CWalk ,\n  \"walk\")");
  Write("controllers/walk/legs.cc", "int Legs();");
  Write("controllers/walk/walk.h", "REGISTER_CONTROLLER(CWalk, \"walk\")");
  Write("controllers/walk/run.cpp", "REGISTER_CONTROLLER(CRun, \"run\")");
  Write("controllers/walk/loop.cpp", "REGISTER_LOOP_FUNCTIONS(CLoop, \"loop\")");
  Write("controllers/walk/main.cpp", "int main(int argc, char** argv) {}");
  Write("main.cpp", "walk");
  EXPECT_THAT(ControllerSources(project_.path(), "walk"),
              ElementsAre(project_ / "controllers/walk/legs.cc", project_ / "controllers/walk/walk.cpp"));
  EXPECT_THAT(ControllerSources(project_.path(), "wal"), IsEmpty());
  EXPECT_THAT(ControllerSources(project_ / "nowhere", "walk"), IsEmpty());
}

TEST_F(EngineComparisonTest, WhatCannotBeComparedIsTold) {
  const auto said = [&](const std::vector<std::string>& kinds, const std::vector<std::string>& controllers) {
    const EngineComparison made = Compare(kinds, controllers);
    EXPECT_FALSE(made.compiles);
    EXPECT_FALSE(made.trusted);
    return made.said;
  };
  EXPECT_THAT(said({"e-puck"}, {"walk"}), HasSubstr("it has foot-bots alone"));
  EXPECT_THAT(said({"e-puck", "foot-bot"}, {"walk"}), HasSubstr("it has foot-bots alone"));
  EXPECT_THAT(said({"foot-bot"}, {"walk", "run"}), HasSubstr("all robots must have one controller"));
  EXPECT_EQ(said({"foot-bot"}, {"walk"}), "is not compared: no C++ source of walk lies in the project");
}

}  // namespace
}  // namespace gauntlet
