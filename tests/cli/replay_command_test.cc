#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class Replay : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    campaigns_.replay.experiment.name = "flocking";
    ReplayReport& report = campaigns_.replay.report;
    report.stored.id = 12;
    report.stored.individual = 3;
    report.spec.scenario = "flocking";
    report.stored_result.fitness = report.replayed.fitness = 0.5;
    report.stored_result.hash = report.replayed.hash = 0x1234;
    report.replayed.trajectory = {{{0, 0, 0, 0}}, {{0.1, 0, 0, 1.0}}};
    report.replayed.robots.resize(1);
  }
};

TEST_F(Replay, ReproducedRunExitsZeroAndWritesItsFiles) {
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("r.svg"), "--csv", Path("r.csv")}), kExitDone);
  EXPECT_EQ(campaigns_.replayed_run, 12U);
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("run 12: reproduced"), HasSubstr("0000000000001234  (the same)")));
  pugi::xml_document svg;
  EXPECT_TRUE(svg.load_file(Path("r.svg").c_str()));
  EXPECT_THAT(Read(Path("r.csv")),
              StartsWith("tick,time_s,robot,x,y,heading,speed\n0,0.0,0,0,0,0,0\n1,0.1,0,0.1,"));
}

TEST_F(Replay, AFileThatCannotBeWrittenWholeKeepsWhatItHeld) {
  { std::ofstream(Path("r.csv")) << "of an earlier run\n"; }
  campaigns_.replay.report.replayed.trajectory.resize(5000, {{0, 0, 0, 0}});
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const int code = Run({"replay", "d", "12", "--csv", Path("r.csv")});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(code, kExitDone);
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("r.csv: cannot be written"), HasSubstr("File too large")));
  EXPECT_EQ(Read(Path("r.csv")), "of an earlier run\n");
}

TEST_F(Replay, NoiseAndFaultsOfTheRunAreNamed) {
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitDone);
  EXPECT_THAT(out_.str(), AllOf(Not(HasSubstr("noise.")), Not(HasSubstr("faults"))));
  sim::Disturbances& disturbances = campaigns_.replay.report.spec.disturbances;
  disturbances.noise[sim::Device::kProximity].gaussian = 0.02;
  disturbances.faults = {{.robot = 3, .device = sim::Device::kWheels, .tick = 500}};
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitDone);
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("noise.proximity.gaussian"), HasSubstr("0.02"), HasSubstr("3:wheels@500")));
  EXPECT_EQ(Run({"replay", "d", "12", "--json"}), kExitDone);
  EXPECT_THAT(out_.str(), HasSubstr("\"noise.proximity.gaussian\": \"0.02\""));
}

TEST_F(Replay, MetricsHaveUnitsAndNoneWhereNothingWasMeasured) {
  campaigns_.replay.report.spec.test_case.name = "three-walls.json";
  campaigns_.replay.report.replayed.metrics = {
      {"birds_left", 7},          {"arrival_time", 61.5},     {"timeout", 0},      {"split_time", -1},
      {"split_angle", 1.5707963}, {"prey_path_length", 8.25}, {"home_made", 0.125}};
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("r.svg")}), kExitDone);
  for (const std::string& text : {out_.str(), Read(Path("r.svg"))}) {
    EXPECT_THAT(text,
                AllOf(HasSubstr("three-walls.json"), HasSubstr("61.5 s"), HasSubstr("8.25 m"),
                      HasSubstr("90 deg"), HasSubstr("none"), HasSubstr("0.125"), Not(HasSubstr("-1"))));
  }
}

TEST_F(Replay, DifferenceExitsOneAndSaysWhatDiffers) {
  campaigns_.replay.report.replayed.hash = 0x9999;
  campaigns_.replay.report.differences = {"hash differs: stored 1234, replayed 9999", "fitness differs"};
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("r.svg")}), kExitNegative);
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("NOT REPRODUCED"), HasSubstr("(DIFFERENT)"), HasSubstr("  fitness differs\n")));
  EXPECT_THAT(err_.str(), HasSubstr("run 12 of d was not reproduced: hash differs"));
  EXPECT_TRUE(std::filesystem::exists(Path("r.svg"))) << "the picture helps to see why";
}

TEST_F(Replay, DamagedRunExitsOne) {
  campaigns_.replay.report.damage = "the stored spec of run 12 is damaged";
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitNegative);
  EXPECT_THAT(err_.str(), HasSubstr("the stored spec of run 12 is damaged"));
  EXPECT_THAT(out_.str(), IsEmpty());
}

TEST_F(Replay, DamagedDatabaseExitsTwoBecauseNothingWasCompared) {
  campaigns_.error = Error{ErrorKind::kCorrupt, "campaign.db is damaged"};
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitUsage);
}

TEST_F(Replay, RefusedRunIsReproducedWithItsRule) {
  campaigns_.replay.report.stored_result.verdict = campaigns_.replay.report.replayed.verdict =
      sim::Verdict::kRefused;
  campaigns_.replay.report.replayed.message = "no-room-to-spawn: 3 of 100 robots placed";
  campaigns_.replay.report.replayed.trajectory.clear();
  campaigns_.replay.report.replayed.robots.clear();
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("r.svg")}), kExitDone);
  EXPECT_THAT(out_.str(), HasSubstr("no-room-to-spawn: 3 of 100 robots placed"));
  pugi::xml_document svg;
  EXPECT_TRUE(svg.load_file(Path("r.svg").c_str()));
}

TEST_F(Replay, OneFileForTwoOutputsIsRefused) {
  ExpectUsageError({"replay", "d", "12", "--svg", Path("a"), "--csv", Path("./a")},
                   AllOf(HasSubstr("--svg"), HasSubstr("--csv")));
  ExpectUsageError({"replay", "d", "12", "--timeline", Path("a"), "--csv", Path("./a")},
                   AllOf(HasSubstr("--timeline"), HasSubstr("--csv")));
  EXPECT_FALSE(std::filesystem::exists(Path("a")));
}

TEST_F(Replay, TimelineIsWrittenForRunsThatSayWhatRobotsDid) {
  EXPECT_EQ(Run({"replay", "d", "12", "--timeline", Path("t.svg"), "--csv", Path("t.csv")}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("--timeline: runs of flocking do not say what their robots did when"));
  EXPECT_FALSE(std::filesystem::exists(Path("t.svg")));
  campaigns_.replay.report.spec.scenario = "foraging";
  campaigns_.replay.report.replayed.annotations = {
      {"states", "wandering,beacon", {{0.0, 1.0}}, 0.0, -1, {0}}};
  EXPECT_EQ(Run({"replay", "d", "12", "--timeline", Path("t.svg")}), kExitDone);
  pugi::xml_document svg;
  EXPECT_TRUE(svg.load_file(Path("t.svg").c_str()));
}

TEST_F(Replay, BadRunIdsAndFilesAreUsageErrors) {
  ExpectUsageError({"replay", "d", "twelve"}, HasSubstr("twelve is no run"));
  ExpectUsageError({"replay", "d", "0"}, HasSubstr("0 is no run"));
  EXPECT_EQ(Run({"replay", "d", "12", "--svg", Path("none/r.svg")}), kExitUsage);
  EXPECT_THAT(err_.str(),
              AllOf(HasSubstr("none/r.svg: cannot be written: "), HasSubstr("No such file or directory")));
}

}  // namespace
}  // namespace gauntlet
