// What is shown of a compiler's output.
#include "cli/build_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace gauntlet {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string OfMissing(const std::string& header) {
  return BuildErrors("a.cpp:1:10: fatal error: " + header + ": No such file or directory\n");
}

TEST(BuildErrors, AreTheLinesThatTellOfErrorsEachOnce) {
  EXPECT_EQ(BuildErrors(
                "[1/2] building\na.cpp:1:9: error: no\n  int x = ;\na.cpp:1:9: error: no\nld: undefined x\n"),
            "  a.cpp:1:9: error: no\n  ld: undefined x\n");
  EXPECT_EQ(BuildErrors("it broke\n"), "it broke\n");
  EXPECT_THAT(BuildErrors("a.cpp:(.text+0x8): undefined reference to `CNet::CNet()'\n"),
              HasSubstr("name all that the controller consists of"));
}

TEST(BuildErrors, SayWhereAMissingHeaderBelongs) {
  EXPECT_THAT(OfMissing("argos3/plugins/robots/e-puck/control_interface/ci_epuck_wheels_actuator.h"),
              HasSubstr("is of another robot"));
  EXPECT_THAT(OfMissing("argos3/plugins/robots/generic/control_interface/ci_quadrotor_position_actuator.h"),
              HasSubstr("is for flying robots"));
  EXPECT_THAT(OfMissing("argos3/core/simulator/query_plugins.h"), HasSubstr("has its interface alone"));
  EXPECT_THAT(OfMissing("ros/ros.h"), HasSubstr("is of ROS"));
  EXPECT_THAT(OfMissing("geometry_msgs/Twist.h"), HasSubstr("is of ROS"));
  EXPECT_THAT(OfMissing("QWidget"), HasSubstr("is for windows"));
  EXPECT_THAT(OfMissing("QtGui/QWidget"), HasSubstr("is for windows"));
  EXPECT_THAT(OfMissing("my/net.h"),
              HasSubstr("<my/net.h> was not found: name the folder that it is in by -I"));
}

TEST(BuildErrors, SayHowToDefineAMacro) {
  for (const char* line : {"a.cpp:6:2: error: ‘GIT_BRANCH’ was not declared in this scope",
                           "a.cpp:6:2: error: use of undeclared identifier 'GIT_BRANCH'"})
    EXPECT_THAT(BuildErrors(line), HasSubstr("say -D GIT_BRANCH=VALUE")) << line;
  EXPECT_THAT(BuildErrors("a.cpp:6:2: error: use of undeclared identifier 'speed'"), Not(HasSubstr("-D")));
}

TEST(BuildErrors, ReadClangToo) {
  const std::string shown = BuildErrors(
      "a.cpp:1:10: fatal error: 'ros/ros.h' file not found\nb.cpp:1:10: fatal error: 'ros/ros.h' file not "
      "found\n");
  EXPECT_THAT(shown, HasSubstr("  b.cpp:1:10"));
  EXPECT_EQ(shown.find("is of ROS"), shown.rfind("is of ROS"));
}

}  // namespace
}  // namespace gauntlet
