// gauntlet adopt, on a project of files that the stand-in for ARGoS (programs/argos3) runs.
// Covers: cli/adopt/adoption.cc, cli/adopt/argos_installation.cc, cli/adopt/trial_run.cc
// Covers: cli/commands/adopt_command.cc, cli/argos_files.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_driver.h"
#include "tests/support/paths.h"
#include "tests/support/sanitizer.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

constexpr const char* kArgos = GAUNTLET_SOURCE_DIR "/tests/integration/programs/walker.argos";

class AdoptTest : public testing::Test {
 protected:
  AdoptTest() {
    // What `make install` makes of ARGoS, and a compiler whose libraries the stand-in does not load.
    fs::create_directories(scratch_ / "argos/bin");
    fs::create_directories(scratch_ / "argos/include/argos3/core");
    fs::copy_file(GAUNTLET_SOURCE_DIR "/tests/integration/programs/argos3", scratch_ / "argos/bin/argos3");
    Script("c++", "while [ \"$1\" != -o ]; do shift; done\nhead -c 1 \"$0\" > \"$2\"\n");
    fs::create_directories(scratch_ / "project/build");
    fs::create_directories(scratch_ / "project/results");
    Write("project/results/score.csv", "20,9\n");
    Write("project/build/libwalker.so", "7");
    Argos("", "");
  }

  void Write(const std::string& name, const std::string& text) { std::ofstream(scratch_ / name) << text; }
  void Script(const std::string& name, const std::string& text) {
    Write(name, "#!/bin/sh\n" + text);
    chmod((scratch_ / name).c_str(), 0755);
  }
  // The project's file with one text of it replaced.
  void Argos(const std::string& what, const std::string& by) {
    std::string text = ReadFile(kArgos);
    if (!what.empty()) text.replace(text.find(what), what.size(), by);
    Write("project/my.argos", text);
  }
  void Mode(const std::string& mode) { Argos("mode=\"\"", "mode=\"" + mode + "\""); }

  // In the project's folder.
  ProcessResult Run(const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {"/bin/sh", "-c",
                                        "cd " + (scratch_ / "project") + " && exec \"$0\" \"$@\""};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const char* const path = getenv("PATH");
    return RunProcess(command, {"PATH=" + (scratch_ / "argos/bin") + ":" + (path == nullptr ? "" : path),
                                "CXX=" + (scratch_ / "c++"), "ARGOS_PLUGIN_PATH="});
  }
  ProcessResult Gauntlet(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), GauntletPath());
    return Run(arguments);
  }
  ProcessResult Adopt(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"adopt", "my.argos", "-o", scratch_ / "my.toml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Gauntlet(arguments);
  }
  // A few random cases of what was adopted, as rows of their runs.
  json Runs(const std::string& directory, int exit_code = 0) {
    const ProcessResult searched = Gauntlet({"random", scratch_ / "my.toml", "--cases", "6", "--dir",
                                             scratch_ / directory, "--quiet", "--no-progress"});
    EXPECT_EQ(searched.exit_code, exit_code) << searched.err;
    return json::parse(Gauntlet({"show", scratch_ / directory, "--json", "--runs"}).out).at("runs");
  }

  TemporaryDirectory scratch_;
};

TEST_F(AdoptTest, AProjectBecomesAnExperiment) {
  if (kSanitized) GTEST_SKIP();
  const ProcessResult adopted = Adopt({"--json"});
  ASSERT_EQ(adopted.exit_code, 0) << adopted.err;
  const json document = json::parse(adopted.out);
  EXPECT_EQ(document.at("reproducible"), true);
  EXPECT_EQ(document.at("libraries"), json({"libwalker.so"}));
  EXPECT_EQ(document.at("score"), "log:^robots: [-+.0-9eE]+ of [-+.0-9eE]+, arrived: ([-+.0-9eE]+)$");
  std::vector<std::string> differs;
  for (const json& one : document.at("differs")) differs.push_back(one.at("element"));
  EXPECT_THAT(differs,
              testing::UnorderedElementsAre("framework/system threads", "framework/experiment real_time",
                                            "framework/experiment random_seed", "visualization"));
  EXPECT_EQ(document.at("unsupported").at(0).at("element"), "the path /nowhere/log.txt");
  std::vector<std::string> scores;
  for (const json& one : document.at("scores")) scores.push_back(one.at("from"));
  EXPECT_THAT(scores, Contains("csv:results/score.csv:2"));

  EXPECT_EQ(ReadFile(scratch_ / "project/results/score.csv"), "20,9\n")
      << "nothing is written into the project";
  const std::string experiment = ReadFile(scratch_ / "my.toml");
  EXPECT_THAT(experiment, HasSubstr("name = \"speed\"\ndefault = 0.2\nlow = 0\nhigh = 2\n"));
  EXPECT_THAT(experiment, HasSubstr("# foot-bot fb0\n[[command.keep_out]]\n"));
  EXPECT_THAT(experiment, HasSubstr("[[command.standing]]\nx = 2\ny = 0\nlength = 0.1\nwidth = 2\n"));
}

// The exported file is the run's, as ARGoS itself takes it; what was kept is run whatever becomes of the
// project.
TEST_F(AdoptTest, ItsRunsAreThoseOfTheFileThatIsExported) {
  if (kSanitized) GTEST_SKIP();
  ASSERT_EQ(Adopt({"--quiet"}).exit_code, 0);
  Write("project/build/libwalker.so", "8");
  const json runs = Runs("c");
  ASSERT_EQ(runs.size(), 6U);
  const ProcessResult exported = Gauntlet({"export", scratch_ / "c", "--format", "argos", "--run", "2",
                                           "--run", "5", "--out", scratch_ / "files"});
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  for (const char* run : {"2", "5"}) {
    const std::string file = scratch_ / "files/run-" + run + ".argos";
    EXPECT_THAT(ReadFile(file), HasSubstr("<qt-opengl />"));
    EXPECT_THAT(ReadFile(file), HasSubstr("name=\"a@b\""));
    EXPECT_THAT(ReadFile(file), Not(HasSubstr("recorder")));
    const ProcessResult by_hand = Run({"argos3", "-n", "-c", file});
    ASSERT_EQ(by_hand.exit_code, 0) << by_hand.err;
    const json& row = runs.at(static_cast<std::size_t>(std::stoi(run) - 1));
    EXPECT_THAT(by_hand.out, HasSubstr("arrived: " + std::to_string(row.at("fitness").get<int>()) + "\n"));
  }
  const ProcessResult replayed = Gauntlet(
      {"replay", scratch_ / "c", "2", "--scratch", scratch_ / "kept", "--csv", scratch_ / "kept.csv"});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  // Positions between those that the run's measures are made of.
  EXPECT_THAT(ReadFile(scratch_ / "kept.csv"), HasSubstr("5,0.5,0,-0.9,"));
  EXPECT_THAT(ReadFile(scratch_ / "kept/.gauntlet-stdout"), HasSubstr("library: 7"));
  EXPECT_EQ(ReadFile(scratch_ / "kept/results/score.csv").substr(0, 5), "20,9\n");
}

TEST_F(AdoptTest, RunsInWhichRobotsFindNoRoomAreRefused) {
  if (kSanitized) GTEST_SKIP();
  ASSERT_EQ(Adopt({"--quiet"}).exit_code, 0);
  // Only what has boxes: the search begins with the empty arena.
  std::string form = ReadFile(scratch_ / "my.adopted/case.argos");
  form.replace(form.find("mode=\"\""), 7, "mode=\"no room\"");
  Write("my.adopted/case.argos", form);
  for (const json& run : Runs("c", 1)) {
    EXPECT_EQ(run.at("verdict"), "refused");
    EXPECT_EQ(run.at("message"), "the program refuses this case: gauntlet: the robots find no room");
  }
}

TEST_F(AdoptTest, WhatDiffersFromRunToRunIsSaid) {
  if (kSanitized) GTEST_SKIP();
  Mode("random");
  const ProcessResult adopted = Adopt();
  ASSERT_EQ(adopted.exit_code, 0) << adopted.err;
  EXPECT_THAT(adopted.out, HasSubstr("Two runs with one seed differ."));
}

TEST_F(AdoptTest, TheScoreCanBeChosen) {
  if (kSanitized) GTEST_SKIP();
  for (const char* score : {"csv:results/score.csv:2", "displacement", "log:of (\\d+)"}) {
    const ProcessResult adopted = Adopt({"--quiet", "--check", "--json", "--score", score});
    ASSERT_EQ(adopted.exit_code, 0) << adopted.err;
    EXPECT_THAT(json::parse(adopted.out).at("score").get<std::string>(), testing::EndsWith(score));
    EXPECT_FALSE(fs::exists(scratch_ / "my.toml"));
  }
}

TEST_F(AdoptTest, WhatCannotWorkIsToldAndNothingIsWritten) {
  if (kSanitized) GTEST_SKIP();
  const auto said = [&](const std::vector<std::string>& more = {}) {
    const ProcessResult adopted = Adopt(more);
    EXPECT_EQ(adopted.exit_code, 2) << adopted.out;
    EXPECT_FALSE(fs::exists(scratch_ / "my.toml"));
    EXPECT_FALSE(fs::exists(scratch_ / "my.adopted"));
    return adopted.err;
  };
  const struct {
    std::string what;
    std::string by;
    std::string said;
  } files[] = {
      {"length=\"20\"", "length=\"0\"", "Say how long runs are, in s: --length S"},
      {"</arena>", "</arena><arena size=\"1,1,1\"/>", "a second <arena>: ARGoS reads the first one only"},
      {"size=\"4,2,1\"", "size=\"wide\"", "<arena> has size=\"wide\", expected x,y,z in m"},
      {"<arena size", "<arena sise", "<arena> has size=\"\", expected x,y,z in m"},
      {"</argos-configuration>", "", "my.argos:16:1: malformed XML"},
      {"build/libwalker", "build/libother", "its library build/libother is neither in"},
      {"mode=\"\"", "mode=\"no boxes\"", "boxes do nothing here"},
      {"mode=\"\"", "mode=\"no room\"", "I managed to place only 0 objects"},
      {"mode=\"\"", "mode=\"no robots\"", "no robot has a controller when the experiment begins"},
      {"mode=\"\"", "mode=\"ends early\"", "ended with exit code 0, but before the experiment did"},
  };
  for (const auto& file : files) {
    Argos(file.what, file.by);
    EXPECT_THAT(said(), HasSubstr(file.said));
  }
  Argos("", "");
  EXPECT_THAT(said({"--score", "log:name: (.*)"}), HasSubstr("nothing that it printed matches name: (.*)"));
  EXPECT_THAT(said({"--score", "height"}), HasSubstr("unknown measure 'height'"));
  EXPECT_THAT(said({"--length", "-3"}), HasSubstr("--length -3: expected a number from 0.1 to 1000000"));
  Script("c++", "echo \"recorder.cpp:1:2: fatal error: lua.h: No such file or directory\" >&2; exit 1\n");
  EXPECT_THAT(said(), testing::AllOf(HasSubstr("lua.h"), HasSubstr("the headers of Lua may be missing")));
  fs::remove_all(scratch_ / "argos/include");
  EXPECT_THAT(said(), HasSubstr("its headers are not in"));
  fs::remove(scratch_ / "argos/bin/argos3");
  if (Run({"sh", "-c", "command -v argos3"}).exit_code != 0) {
    EXPECT_THAT(said(), HasSubstr("there is no argos3 in PATH"));
  }
}

TEST_F(AdoptTest, NothingThatIsThereIsOverwritten) {
  Write("my.toml", "mine");
  const ProcessResult adopted = Adopt();
  EXPECT_EQ(adopted.exit_code, 2);
  EXPECT_THAT(adopted.err, HasSubstr("my.toml is there already"));
  EXPECT_EQ(ReadFile(scratch_ / "my.toml"), "mine");
}

}  // namespace
}  // namespace gauntlet::testing_support
