// What is shown of a compiler's output.
#include "cli/build_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace gauntlet {
namespace {

using testing::HasSubstr;

std::string OfMissing(const std::string& header) {
  return BuildErrors("a.cpp:1:10: fatal error: " + header + ": No such file or directory\n");
}

TEST(BuildErrors, AreTheLinesThatTellOfErrorsEachOnce) {
  EXPECT_EQ(BuildErrors(
                "[1/2] building\na.cpp:1:9: error: no\n  int x = ;\na.cpp:1:9: error: no\nld: undefined x\n"),
            "  a.cpp:1:9: error: no\n  ld: undefined x\n");
  EXPECT_EQ(BuildErrors("it broke\n"), "it broke\n");
  EXPECT_EQ(BuildErrors("a.cpp:(.text+0x8): undefined reference to `CNet::CNet()'\n"),
            "  a.cpp:(.text+0x8): undefined reference to `CNet::CNet()'\n"
            "CNet::CNet() of the class CNet is in a source that was not named: name all that the controller "
            "consists "
            "of\n");
  EXPECT_THAT(BuildErrors("mine.so: undefined symbol: _ZN4CNet5WeighEd\n"),
              HasSubstr("\nCNet::Weigh(double) of the class CNet is in a source"));
  EXPECT_THAT(BuildErrors("a.cpp: undefined reference to `Weigh(double)'\n"),
              HasSubstr("\nWeigh(double) is in a source"));
  EXPECT_THAT(BuildErrors("a.cpp: undefined reference to `vtable for CNet'\n"),
              HasSubstr("\nvtable for CNet of the class CNet is in a source"));
}

TEST(BuildErrors, SayWhereAMissingHeaderBelongs) {
  EXPECT_EQ(
      OfMissing("argos3/plugins/robots/e-puck/control_interface/ci_epuck_wheels_actuator.h"),
      "  a.cpp:1:10: fatal error: argos3/plugins/robots/e-puck/control_interface/ci_epuck_wheels_actuator.h: "
      "No such file or directory\n"
      "<argos3/plugins/robots/e-puck/control_interface/ci_epuck_wheels_actuator.h> is of another robot; "
      "robots of Gauntlet are foot-bots\n");
  EXPECT_EQ(OfMissing("argos3/plugins/robots/generic/control_interface/ci_quadrotor_position_actuator.h"),
            "  a.cpp:1:10: fatal error: "
            "argos3/plugins/robots/generic/control_interface/ci_quadrotor_position_actuator.h: No such file "
            "or directory\n"
            "<argos3/plugins/robots/generic/control_interface/ci_quadrotor_position_actuator.h> is for "
            "flying robots; robots of Gauntlet are foot-bots\n");
  EXPECT_THAT(OfMissing("argos3/core/simulator/query_plugins.h"), HasSubstr("has its interface alone"));
  EXPECT_EQ(OfMissing("ros/ros.h"),
            "  a.cpp:1:10: fatal error: ros/ros.h: No such file or directory\n"
            "<ros/ros.h> is of ROS, which no run in Gauntlet has: build the part of the controller that "
            "decides, and leave out its nodes and messages\n");
  EXPECT_EQ(OfMissing("geometry_msgs/Twist.h"),
            "  a.cpp:1:10: fatal error: geometry_msgs/Twist.h: No such file or directory\n"
            "<geometry_msgs/Twist.h> is of ROS, which no run in Gauntlet has: build the part of the "
            "controller that decides, and leave out its nodes and messages\n");
  EXPECT_EQ(OfMissing("QWidget"),
            "  a.cpp:1:10: fatal error: QWidget: No such file or directory\n"
            "<QWidget> is for windows, and Gauntlet shows none: leave that source out; `gauntlet replay` "
            "draws runs\n");
  EXPECT_EQ(OfMissing("QtGui/QWidget"),
            "  a.cpp:1:10: fatal error: QtGui/QWidget: No such file or directory\n"
            "<QtGui/QWidget> is for windows, and Gauntlet shows none: leave that source out; `gauntlet "
            "replay` draws runs\n");
  EXPECT_EQ(
      OfMissing("my/net.h"),
      "  a.cpp:1:10: fatal error: my/net.h: No such file or directory\n"
      "<my/net.h> was not found: name the folder that it is in by -I DIR; libraries have to be installed\n");
}

TEST(BuildErrors, SayHowToDefineAMacro) {
  for (const char* line : {"a.cpp:6:2: error: ‘GIT_BRANCH’ was not declared in this scope",
                           "a.cpp:6:2: error: use of undeclared identifier 'GIT_BRANCH'"})
    EXPECT_THAT(BuildErrors(line), HasSubstr("say -D GIT_BRANCH=VALUE")) << line;
  EXPECT_EQ(BuildErrors("a.cpp:6:2: error: use of undeclared identifier 'speed'"),
            "  a.cpp:6:2: error: use of undeclared identifier 'speed'\n");
}

TEST(BuildErrors, SayHowToBuildTheSdk) {
  const std::string advice =
      "Gauntlet's SDK is not built: give './dev build' in the folder of Gauntlet's sources\n";
  const std::string line = "/usr/bin/ld: cannot find -lgauntlet_argos: No such file or directory";
  EXPECT_EQ(BuildErrors("a note\n" + line + "\n"), "  " + line + "\n" + advice);
}

TEST(BuildErrors, ReadClangToo) {
  const std::string shown = BuildErrors(
      "a.cpp:1:10: fatal error: 'ros/ros.h' file not found\nb.cpp:1:10: fatal error: 'ros/ros.h' file not "
      "found\n");
  EXPECT_EQ(shown,
            "  a.cpp:1:10: fatal error: 'ros/ros.h' file not found\n"
            "  b.cpp:1:10: fatal error: 'ros/ros.h' file not found\n"
            "<ros/ros.h> is of ROS, which no run in Gauntlet has: build the part of the controller that "
            "decides, and leave out its nodes and messages\n");
  EXPECT_EQ(shown.find("is of ROS"), shown.rfind("is of ROS"));
}

}  // namespace
}  // namespace gauntlet
