// Covers: search/cases/case_file.cc
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/cases/case_file.h"
#include "tests/support/paths.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kWalls = R"(
    <box id="north" movable="false" size="6,0.1,1"><body position="0,3,0" orientation="0,0,0"/></box>
    <box id="south" movable="false" size="6,0.1,1"><body position="0,-3,0" orientation="0,0,0"/></box>
    <box id="east" movable="false" size="6,0.1,1"><body position="3,0,0" orientation="270,0,0"/></box>
    <box id="west" movable="false" size="0.1,6,1"><body position="-3,0,0" orientation="0,0,0"/></box>)";

constexpr const char* kTenRobots = R"(
    <distribute>
      <position method="uniform" min="2,2,0" max="3,2.9,0"/>
      <orientation method="gaussian" mean="0,0,0" std_dev="360,0,0"/>
      <entity quantity="10" max_trials="100"><foot-bot id="fb"><controller config="c"/></foot-bot></entity>
    </distribute>)";

std::string Document(const std::string& arena_content,
                     const std::string& arena = R"(size="6,6,1" center="0,0,0.5")") {
  return "<?xml version=\"1.0\"?>\n<argos-configuration>\n  <framework/>\n  <arena " + arena + ">" +
         arena_content + "\n  </arena>\n  <media/>\n</argos-configuration>\n";
}

std::string ImportError(const std::string& text) {
  const Result<LoadedCase> imported = ParseArgos(text, "case.argos");
  return imported.ok() ? "imported" : imported.error().message;
}

TEST(ArgosImport, TakesArenaObstaclesRobotsAndSpawnArea) {
  const auto imported = ParseArgos(Document(std::string(kWalls) + R"(
    <box id="a" movable="false" size="1.4,0.4,1"><body position="0.8,2.4,0" orientation="100,0,0"/></box>
    <box id="b" movable="false" size="3.2,0.2,1"><body position="-2.7, 2.7 ,0" orientation="-30,0,0"/></box>)" +
                                            kTenRobots),
                                   "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  const sim::TestCase& test_case = imported->test_case;
  EXPECT_EQ(test_case.side_x, 6.0);
  EXPECT_EQ(test_case.side_y, 6.0);
  EXPECT_EQ(test_case.wall_thickness, 0.1);
  ASSERT_EQ(test_case.obstacles.size(), 2U);
  EXPECT_EQ(test_case.obstacles[0], (sim::ObstacleGene{0.8, 2.4, 1.4, 0.4, 100.0}));
  EXPECT_EQ(test_case.obstacles[1], (sim::ObstacleGene{-2.7, 2.7, 3.2, 0.2, 330.0}));
  EXPECT_EQ(test_case.robots, 10);
  ASSERT_TRUE(test_case.spawn_area.has_value());
  EXPECT_EQ(test_case.spawn_area->min, sim::Vec2(2.0, 2.0));
  EXPECT_EQ(test_case.spawn_area->max, sim::Vec2(3.0, 2.9));
}

TEST(ArgosImport, SaysInOneLineWhatWasIgnored) {
  const auto imported = ParseArgos(
      Document(std::string(kWalls) + "<light id=\"l\" position=\"0,0,1\"/>" + kTenRobots), "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  EXPECT_EQ(imported->notice, "ignored: framework, media, light, start orientations");
}

TEST(ArgosImport, BoxesNearTheEdgeThatAreNoWallsStayObstacles) {
  const auto imported = ParseArgos(Document(R"(
    <box id="moved" size="6,0.1,1"><body position="0,2.98,0" orientation="0,0,0"/></box>
    <box id="short" size="5.9,0.1,1"><body position="0,-3,0" orientation="0,0,0"/></box>
    <box id="askew" size="6,0.1,1"><body position="3,0,0" orientation="89,0,0"/></box>
    <box id="almost" size="6.005,0.1,1"><body position="-2.995,0,0" orientation="90,0,0"/></box>)"),
                                   "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  EXPECT_EQ(imported->test_case.obstacles.size(), 3U);
  EXPECT_EQ(imported->notice,
            "1 of 4 walls are in the file, the others were added; no foot-bots, so the scenario's number is "
            "taken; ignored: framework, media");
}

TEST(ArgosImport, ThicknessComesFromTheWallsOfTheFile) {
  const auto imported = ParseArgos(Document(R"(
    <box id="n" size="4,0.2,1"><body position="0,2.5,0"/></box>
    <box id="s" size="4.2,0.2,1"><body position="0,-2.5,0"/></box>
    <box id="e" size="0.2,5,1"><body position="2,0,0"/></box>
    <box id="w" size="0.2,5,1"><body position="-2,0,0"/></box>)",
                                            R"(size="4,5,1")"),
                                   "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  EXPECT_EQ(imported->test_case.side_x, 4.0);
  EXPECT_EQ(imported->test_case.side_y, 5.0);
  EXPECT_EQ(imported->test_case.wall_thickness, 0.2);
  EXPECT_TRUE(imported->test_case.obstacles.empty());
  EXPECT_THAT(imported->notice, Not(HasSubstr("walls")));
}

TEST(ArgosImport, CoordinatesAreRelativeToTheArenasCenter) {
  const auto imported = ParseArgos(
      Document(R"(<box id="a" size="1,0.2,1"><body position="11,20.5,0" orientation="45,0,0"/></box>
    <distribute><position method="uniform" min="12,22,0" max="13,23,0"/>
      <entity quantity="3"><foot-bot id="f"/></entity></distribute>)",
               R"(size="6,6,1" center="10,20,0.5")"),
      "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  ASSERT_EQ(imported->test_case.obstacles.size(), 1U);
  EXPECT_EQ(imported->test_case.obstacles[0], (sim::ObstacleGene{1.0, 0.5, 1.0, 0.2, 45.0}));
  EXPECT_EQ(imported->test_case.spawn_area->min, sim::Vec2(2.0, 2.0));
}

TEST(ArgosImport, FixedFootBotsAreCountedAndSeveralAreasJoined) {
  const auto imported = ParseArgos(Document(R"(
    <foot-bot id="x"><body/></foot-bot><foot-bot id="y"><body/></foot-bot>
    <distribute><position method="uniform" min="0,0,0" max="1,1,0"/>
      <entity quantity="3"><foot-bot id="f"/></entity></distribute>
    <distribute><position method="uniform" min="-1,0.5,0" max="0,2,0"/>
      <entity quantity="4"><foot-bot id="g"/></entity></distribute>
    <distribute><position method="grid" center="0,0,0" distances="1,1,0" layout="2,2,1"/>
      <entity quantity="1"><foot-bot id="h"/></entity></distribute>)"),
                                   "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  EXPECT_EQ(imported->test_case.robots, 10);
  EXPECT_EQ(imported->test_case.spawn_area->min, sim::Vec2(-1.0, 0.0));
  EXPECT_EQ(imported->test_case.spawn_area->max, sim::Vec2(1.0, 2.0));
  EXPECT_EQ(imported->notice,
            "0 of 4 walls are in the file, the others were added; ignored: framework, media, start positions "
            "(method \"grid\"), poses of single foot-bots, as others are distributed");
}

TEST(ArgosImport, FootBotsThatStandByThemselvesStartThere) {
  const auto imported = ParseArgos(Document(R"(
    <foot-bot id="a"><body position="1.5,2,0" orientation="270,0,0"/><controller config="c"/></foot-bot>
    <foot-bot id="b"><body position="-1,0.5,0"/><controller config="scenario"/></foot-bot>)",
                                            R"(size="6,6,1" center="1,1,0.5")"),
                                   "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  EXPECT_EQ(imported->test_case.robots, 2);
  const std::vector<sim::Pose>& poses = imported->test_case.start_poses;
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[0].position, sim::Vec2(0.5, 1.0));
  EXPECT_NEAR(poses[0].heading, -std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(poses[1].heading, 0.0);
  EXPECT_THAT(imported->notice, Not(HasSubstr("foot-bots")));

  const auto in = [](const std::string& robot) { return ImportError(Document("\n" + robot)); };
  EXPECT_EQ(in("<foot-bot id='a'/>"), "case.argos:5:2: <foot-bot id=\"a\"> has no <body>");
  EXPECT_EQ(in("<foot-bot id='a'><body position='1,nan,0'/></foot-bot>"),
            "case.argos:5:19: <foot-bot id=\"a\"> has position=\"1,nan,0\": 'nan' is not a number, expected "
            "\"x,y,z in m\"");
  EXPECT_EQ(in("<foot-bot id='a'><body orientation='1e400,0,0'/></foot-bot>"),
            "case.argos:5:19: <foot-bot id=\"a\"> has orientation=\"1e400,0,0\": '1e400' is not a number, "
            "expected \"z,y,x in degrees\"");
}

TEST(ArgosImport, HostileFilesAreRefusedAtOnce) {
  std::string bomb = "<?xml version=\"1.0\"?><!DOCTYPE a [<!ENTITY a \"1,1\">";
  for (char c = 'b'; c < 'z'; ++c)
    bomb += fmt::format("<!ENTITY {0} \"&{1};&{1};&{1};&{1};\">", c, static_cast<char>(c - 1));
  EXPECT_THAT(ImportError(bomb + "]><argos-configuration><arena size=\"&y;\"/></argos-configuration>"),
              HasSubstr("'&y;' is not a number"));
  std::string deep = "<argos-configuration>";
  for (int i = 0; i < 1'000'000; ++i) deep += "<a>";
  EXPECT_EQ(ImportError(deep), "case.argos:1:3000021: malformed XML: Start-end tags mismatch");
}

TEST(ArgosImport, ReadsWhatOnlyWeSay) {
  const auto own = [](const std::string& content) {
    std::string text = Document(R"(<box id="b" size="1,0.2,1"><body position="1,1,0"/></box>)");
    return text.insert(text.find("<media/>"), "<gauntlet>" + content + "</gauntlet>");
  };
  const auto read =
      ParseArgos(own(R"(<obstacle id="b" path="1,2 3,-1" speed="0.02" light="red"/>)"), "case.argos");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const sim::ObstacleGene& obstacle = read->test_case.obstacles.front();
  EXPECT_THAT(obstacle.path, testing::ElementsAre(sim::Vec2(1, 2), sim::Vec2(3, -1)));
  EXPECT_EQ(obstacle.speed, 0.02);
  EXPECT_EQ(obstacle.light, sim::Color::kRed);
  EXPECT_EQ(ImportError(own(R"(<obstacle id="c" path="" speed="0" light="red"/>)")),
            "case.argos:6:14: <obstacle id=\"c\"> of <gauntlet> is no box of the arena");
  EXPECT_EQ(ImportError(own(R"(<obstacle id="b" path="1" speed="0" light="red"/>)")),
            "case.argos:6:14: <obstacle id=\"b\"> has path=\"1\": 1 numbers, expected \"x,y x,y in m\"");
  EXPECT_EQ(ImportError(own(R"(<obstacle id="b" path="" speed="0" light="mauve"/>)")),
            "case.argos:6:14: <obstacle id=\"b\"> has light=\"mauve\", expected one of black, red, green, "
            "blue, yellow, white, magenta, cyan, orange");
}

TEST(ArgosImport, WithoutFootBotsTheScenarioDecides) {
  const auto imported = ParseArgos(Document(kWalls), "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  EXPECT_FALSE(imported->test_case.robots.has_value());
  EXPECT_FALSE(imported->test_case.spawn_area.has_value());
  EXPECT_EQ(imported->notice, "no foot-bots, so the scenario's number is taken; ignored: framework, media");
}

TEST(ArgosImport, MovableAndLowBoxesAreNoticed) {
  const auto imported = ParseArgos(Document(R"(
    <box id="m" movable="true" mass="1" size="1,0.2,0.2"><body position="1,1,0" orientation="0,0,0"/></box>)"),
                                   "case.argos");
  ASSERT_TRUE(imported.ok()) << imported.error().message;
  EXPECT_EQ(imported->notice,
            "0 of 4 walls are in the file, the others were added; no foot-bots, so the scenario's number is "
            "taken; 1 movable boxes were made fixed; 1 boxes lower than a robot's camera were made as high "
            "as a wall; ignored: framework, media");
}

TEST(ArgosImport, MalformedXmlIsNamedWithLineAndColumn) {
  const std::string message =
      ImportError("<argos-configuration>\n  <arena size=\"6,6,1\">\n  </aren>\n</argos-configuration>");
  EXPECT_EQ(message, "case.argos:3:5: malformed XML: Start-end tags mismatch");
  EXPECT_THAT(ImportError(""), StartsWith("case.argos:1:1: malformed XML"));
}

TEST(ArgosImport, ErrorsPointAtTheElement) {
  // <body> stands in line 5, after 13 characters.
  const std::string message =
      ImportError(Document("\n    <box id=\"Wall3\" movable=\"false\" size=\"1,0.1,1\">\n            <body "
                           "position=\"0,abc,0\"/></box>"));
  EXPECT_EQ(message,
            "case.argos:6:14: <box id=\"Wall3\"> has position=\"0,abc,0\": 'abc' is not a number, expected "
            "\"x,y,z in m\"");
}

TEST(ArgosImport, RefusesWhatItCannotRepresent) {
  EXPECT_EQ(ImportError("<lua/>"),
            "case.argos:1:2: the root element is <lua>, expected <argos-configuration>");
  EXPECT_EQ(ImportError("<argos-configuration><framework/></argos-configuration>"),
            "case.argos:1:2: <argos-configuration> has no <arena>");
  EXPECT_EQ(ImportError(Document("", "")), "case.argos:4:4: <arena> has no size=\"x,y,z in m\"");
  EXPECT_EQ(ImportError(Document("", R"(size="6,6")")),
            "case.argos:4:4: <arena> has size=\"6,6\": 2 numbers, expected \"x,y,z in m\"");
  EXPECT_EQ(ImportError(Document("", R"(size="6,nan,1")")),
            "case.argos:4:4: <arena> has size=\"6,nan,1\": 'nan' is not a number, expected \"x,y,z in m\"");
  EXPECT_EQ(ImportError(Document(R"(<cylinder id="c7" radius="1" height="1"/>)")),
            "case.argos:4:41: <cylinder id=\"c7\"> is round: obstacles must be boxes");
  EXPECT_EQ(ImportError(
                Document(R"(<box id="t" size="1,1,1"><body position="0,0,0" orientation="0,15,0"/></box>)")),
            "case.argos:4:66: <box id=\"t\"> has orientation=\"0,15,0\": boxes may be rotated about z only, "
            "the first number");
  EXPECT_EQ(ImportError(Document(R"(<box id="t" size="1,1,1"/>)")),
            "case.argos:4:41: <box id=\"t\"> has no <body>");
  EXPECT_EQ(ImportError(Document(R"(<distribute><position method="uniform" min="2,2,0" max="3,3,0"/>
      <entity quantity="ten"><foot-bot id="f"/></entity></distribute>)")),
            "case.argos:5:8: <entity> of <foot-bot id=\"f\"> has quantity=\"ten\", expected a whole number "
            "from 1 on");
  EXPECT_EQ(ImportError(Document(R"(<distribute><position method="uniform" min="4,2,0" max="3,3,0"/>
      <entity quantity="2"><foot-bot id="f"/></entity></distribute>)")),
            "case.argos:4:53: <position> has min=\"4,2,0\" beyond max=\"3,3,0\"");
  EXPECT_EQ(ImportError(Document(R"(<distribute><entity quantity="2000000000"><foot-bot id="f"/></entity>
      <entity quantity="2000000000"><foot-bot id="g"/></entity></distribute>)")),
            "case.argos:4:4: 4000000000 foot-bots; at most 10000 can be meant");
}

class CaseFile : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ = std::filesystem::path(::testing::TempDir()) /
                 (std::string("gauntlet-case-file-") +
                  ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }
  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name, std::ios::binary) << text;
    return directory_ / name;
  }

  std::filesystem::path directory_;
};

TEST_F(CaseFile, FormatFollowsFromExtensionOrContent) {
  const std::string xml = Document(std::string(kWalls) + kTenRobots);
  const std::string json =
      R"({"obstacles": [{"x": 1, "y": 0.5, "length": 1, "width": 0.2, "orientationDeg": 10}]})";
  for (const auto& path : {Write("a.argos", xml), Write("a.txt", "\n  " + xml)}) {
    const auto loaded = LoadCase(path);
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    EXPECT_EQ(loaded->test_case.robots, 10);
    EXPECT_EQ(loaded->test_case.name, path.filename().string());
    EXPECT_EQ(loaded->notice, "ignored: framework, media, start orientations");
  }
  for (const auto& path : {Write("b.json", json), Write("b", json)}) {
    const auto loaded = LoadCase(path);
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    ASSERT_EQ(loaded->test_case.obstacles.size(), 1U);
    EXPECT_EQ(loaded->test_case.obstacles[0].y, 0.5);
    EXPECT_EQ(loaded->test_case.name, path.filename().string());
    EXPECT_EQ(loaded->notice, "");
  }
}

TEST_F(CaseFile, AnEndlessFileIsReadToTheLimitOnly) {
  EXPECT_EQ(LoadCase("/dev/zero").error().message,
            "/dev/zero has more than 16777216 bytes, the most for a case file");
}

TEST(ArgosImport, NoFootBotsAreNotTenAndOneDocumentIsEnough) {
  std::string none = kTenRobots;
  none.replace(none.find("\"10\""), 4, "\"0\"");
  EXPECT_EQ(ImportError(Document(none)),
            "case.argos:8:8: <entity> of <foot-bot id=\"fb\"> has quantity=\"0\", expected a whole number "
            "from 1 on");
  EXPECT_EQ(ImportError(Document("") + "<argos-configuration/>"),
            "case.argos:8:2: <argos-configuration> follows the end of <argos-configuration>: a file holds "
            "one document");
}

TEST_F(CaseFile, ErrorsNameTheFile) {
  EXPECT_EQ(LoadCase(directory_ / "none.json").error().message,
            directory_.string() + "/none.json: no such file");
  EXPECT_EQ(LoadCase(directory_).error().message,
            directory_.string() + " is a directory, expected a case file (.json or .argos)");
  EXPECT_EQ(LoadCase(Write("bad.argos", "<arena")).error().message,
            directory_.string() + "/bad.argos:1:6: malformed XML: Error parsing start element tag");
  EXPECT_EQ(LoadCase(Write("bad.json", "{\n\"obstacles\": 3\n}")).error().message,
            directory_.string() + "/bad.json: obstacles must be a list [ ... ], not 3");
}

// Files of the thesis' author; not part of the repository.
TEST(RealArgosCases, EveryFileImports) {
  const char* given = std::getenv("GAUNTLET_ARGOS_CASES");
  const std::filesystem::path directory =
      given != nullptr ? given : std::filesystem::path(GAUNTLET_SOURCE_DIR) / "../shared/data/argos-cases";
  if (!std::filesystem::is_directory(directory)) {
    GTEST_SKIP() << "no " << directory << "; set GAUNTLET_ARGOS_CASES to the directory of the author's files";
  }
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (entry.path().extension() != ".argos") continue;
    ++files;
    const auto loaded = LoadCase(entry.path());
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    EXPECT_EQ(loaded->test_case.side_x, 6.0) << entry.path();
    EXPECT_EQ(loaded->test_case.wall_thickness, 0.1) << entry.path();
    EXPECT_EQ(loaded->test_case.obstacles.size(), 6U) << entry.path();
    EXPECT_EQ(loaded->test_case.robots, 10) << entry.path();
    ASSERT_TRUE(loaded->test_case.spawn_area.has_value()) << entry.path();
    EXPECT_EQ(loaded->test_case.spawn_area->min, sim::Vec2(2.0, 2.0)) << entry.path();
    EXPECT_EQ(loaded->test_case.spawn_area->max, sim::Vec2(3.0, 3.0)) << entry.path();
  }
  EXPECT_GT(files, 0);
}

}  // namespace
}  // namespace gauntlet
