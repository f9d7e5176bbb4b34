#include "controllers/command/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/process.h"

namespace gauntlet::controllers::command {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing_support::TemporaryDirectory;

class TrajectoryFile : public testing::Test {
 protected:
  std::string Read(const std::string& content, bool record = false) {
    std::ofstream(scratch_ / "t.csv") << content;
    result_ = {};
    const Status status = ReadTrajectory(scratch_ / "t.csv", "t.csv", record, result_);
    return status.ok() ? "" : status.error().message;
  }

  TemporaryDirectory scratch_;
  sim::RunResult result_;
};

TEST_F(TrajectoryFile, BecomesSummariesInTheOrderOfComing) {
  ASSERT_EQ(Read("time,robot,kind,x,y,heading\n"
                 "0,b,robot,1,0,0\n0,a,robot,0,0,0\n"
                 "5,b,robot,1,2,7\n5,a,robot,3,4,-7\n"
                 "10,b,robot,1,2,0\n"),
            "");
  EXPECT_EQ(result_.ticks, 100);
  ASSERT_EQ(result_.robots.size(), 2U);
  EXPECT_EQ(result_.robots[0].path_length, 2.0);
  EXPECT_EQ(result_.robots[1].path_length, 5.0);
  EXPECT_EQ(result_.robots[1].end.position, sim::Vec2(3, 4));
  EXPECT_THAT(result_.robots[1].end.heading, DoubleNear(-7 + 2 * 3.141592653589793, 1e-12));
  EXPECT_EQ(result_.robots[1].waypoints, (std::vector<sim::Vec2>{{0, 0}, {3, 4}, {3, 4}}));
  EXPECT_TRUE(result_.trajectory.empty());
}

TEST_F(TrajectoryFile, RecordedItHoldsEveryRobotAtEveryTick) {
  ASSERT_EQ(Read("0,1,robot,0,0\n0.2,2,robot,5,5\n0.3,1,robot,1,0\n", /*record=*/true), "");
  ASSERT_EQ(result_.trajectory.size(), 4U);
  EXPECT_EQ(result_.trajectory[0][1].position(), sim::Vec2(5, 5));
  EXPECT_EQ(result_.trajectory[2][0].position(), sim::Vec2(0, 0));
  EXPECT_EQ(result_.trajectory[3][0].position(), sim::Vec2(1, 0));
}

TEST_F(TrajectoryFile, ColumnsHaveAnyOrderAndTwoMayBeMissing) {
  ASSERT_EQ(Read("y,x,robot,time\r\n2,1,r,0\r\n"), "");
  EXPECT_EQ(result_.robots[0].start.position, sim::Vec2(1, 2));
  EXPECT_THAT(Read("y,robot,time\n"), HasSubstr("line 1 has no column x"));
}

TEST_F(TrajectoryFile, SaysTheLineOfWhatIsWrong) {
  EXPECT_EQ(Read(""), "its file t.csv has no rows");
  EXPECT_EQ(Read("0,a,k,1,2\n0,a,k,one,2\n"), "its file t.csv, line 2: x = 'one' is no finite number");
  EXPECT_EQ(Read("1,a,k,1,2\n0.5,a,k,1,2\n"), "its file t.csv, line 2: time 0.5 lies before the last");
  EXPECT_THAT(Read("-1,a,k,1,2\n"), HasSubstr("line 1: time -1; s from the beginning"));
  EXPECT_THAT(Read("0,a,k\n"), HasSubstr("line 1: x = '' is no finite number"));
  EXPECT_THAT(Read("0,a,k,1,2\n900000,a,k,1,2\n900000,b,k,1,2\n900000,c,k,1,2\n", /*record=*/true),
              HasSubstr("too long to be replayed"));
}

}  // namespace
}  // namespace gauntlet::controllers::command
