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
  EXPECT_EQ(out_.str(),
            "flocking, run 12: reproduced\n"
            "\n"
            "  test case    3 (generation 0)\n"
            "  seed         0\n"
            "  outcome      no bird lost\n"
            "  fitness      0.500000\n"
            "  stored hash  0000000000001234\n"
            "  new hash     0000000000001234  (the same)\n");
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
  EXPECT_EQ(err_.str(), "gauntlet: " + Path("r.csv") + ": cannot be written: cannot write " + Path("r.csv") +
                            ": File too large for this process (ulimit -f)\n");
  EXPECT_EQ(Read(Path("r.csv")), "of an earlier run\n");
}

TEST_F(Replay, NoiseAndFaultsOfTheRunAreNamed) {
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitDone);
  EXPECT_EQ(out_.str(),
            "flocking, run 12: reproduced\n"
            "\n"
            "  test case    3 (generation 0)\n"
            "  seed         0\n"
            "  outcome      no bird lost\n"
            "  fitness      0.500000\n"
            "  stored hash  0000000000001234\n"
            "  new hash     0000000000001234  (the same)\n");
  sim::Disturbances& disturbances = campaigns_.replay.report.spec.disturbances;
  disturbances.noise[sim::Device::kProximity].gaussian = 0.02;
  disturbances.faults = {{.robot = 3, .device = sim::Device::kWheels, .tick = 500}};
  disturbances.random_faults = {.count = 2, .tick = 40};
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitDone);
  ExpectText("replay_noise_and_faults_of_the_run_are_named", out_.str());
  EXPECT_EQ(Run({"replay", "d", "12", "--json"}), kExitDone);
  ExpectText("replay_noise_and_faults_of_the_run_are_named_2", out_.str());
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
  ExpectText("replay_difference_exits_one_and_says_what_differs", out_.str());
  EXPECT_EQ(err_.str(),
            "gauntlet: wrote " + Path("r.svg") +
                "\n"
                "gauntlet: run 12 of d was not reproduced: hash differs: stored 1234, replayed 9999\n");
  for (const Reproducible known : {Reproducible::kUnknown, Reproducible::kNo, Reproducible::kYes}) {
    campaigns_.replay.reproducible = known;
    EXPECT_EQ(Run({"replay", "d", "12"}), kExitNegative);
    EXPECT_EQ(err_.str(),
              std::string("gauntlet: run 12 of d was not reproduced") +
                  (known == Reproducible::kYes ? "" : ", and its program is not known to be reproducible") +
                  ": hash differs: stored 1234, replayed 9999\n");
  }
  EXPECT_TRUE(std::filesystem::exists(Path("r.svg"))) << "the picture helps to see why";
}

TEST_F(Replay, DamagedRunExitsOne) {
  campaigns_.replay.report.damage = "the stored spec of run 12 is damaged";
  EXPECT_EQ(Run({"replay", "d", "12"}), kExitNegative);
  EXPECT_EQ(err_.str(), "gauntlet: the stored spec of run 12 is damaged\n");
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
  EXPECT_EQ(out_.str(),
            "flocking, run 12: reproduced\n"
            "\n"
            "  test case    3 (generation 0)\n"
            "  seed         0\n"
            "  outcome      refused: no-room-to-spawn: 3 of 100 robots placed\n"
            "  verdict      refused\n"
            "  stored hash  0000000000001234\n"
            "  new hash     0000000000001234  (the same)\n");
  pugi::xml_document svg;
  EXPECT_TRUE(svg.load_file(Path("r.svg").c_str()));
}

TEST_F(Replay, TimelineIsWrittenForRunsThatSayWhatRobotsDid) {
  EXPECT_EQ(Run({"replay", "d", "12", "--timeline", Path("t.svg"), "--csv", Path("t.csv")}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: --timeline: runs of flocking do not say what their robots did when\n");
  EXPECT_FALSE(std::filesystem::exists(Path("t.svg")));
  campaigns_.replay.report.spec.scenario = "foraging";
  campaigns_.replay.report.replayed.annotations = {
      {"states", "wandering,beacon", {{0.0, 1.0}}, 0.0, -1, {0}}};
  EXPECT_EQ(Run({"replay", "d", "12", "--timeline", Path("t.svg")}), kExitDone);
  pugi::xml_document svg;
  EXPECT_TRUE(svg.load_file(Path("t.svg").c_str()));
}

}  // namespace
}  // namespace gauntlet
