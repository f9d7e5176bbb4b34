// gauntlet evaluate --stdin as other programs use it: whole lines, accidents, and what is asked afterwards.
// Covers: cli/stream_run.cc
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "base/shell_quoted.h"
#include "base/system/unique_fd.h"
#include "tests/integration/service_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::SizeIs;

// Lines about different walls; every third has settings of its own.
std::string Lines(int count) {
  std::string lines;
  for (int i = 0; i < count; ++i) {
    json line = {
        {"id", "line-" + std::to_string(i)},
        {"case",
         {{"obstacles", {{{"x", 0.1 * (i % 40) - 2.0}, {"y", 0.5}, {"length", 1.5}, {"width", 0.2}}}}}}};
    if (i % 3 == 0) line["set"] = {{"controller_parameters.turn_rate", 0.5}};
    if (i % 5 == 0) line["replicates"] = 2;
    if (i % 7 == 0) line["seed"] = i;
    lines += line.dump() + "\n";
  }
  return lines;
}

std::vector<std::string> StreamArguments(const std::string& dir, int workers = 2) {
  // Short, since what is simulated does not matter.
  return {"evaluate",  "flocking",
          "--stdin",   "--dir",
          dir,         "--quiet",
          "--workers", std::to_string(workers),
          "--set",     "scenario_parameters.time_limit=30"};
}

// `sh -c` with the command behind `before`, in which "GAUNTLET" stands for it.
std::vector<std::string> InShell(const std::string& script, const std::vector<std::string>& arguments) {
  std::string command;
  for (const std::string& word : GauntletCommand(arguments)) command += ShellQuoted(word) + " ";
  std::string whole = script;
  whole.replace(whole.find("GAUNTLET"), 8, command);
  return {"/bin/sh", "-c", whole};
}

struct Stream {
  ProcessResult process;
  std::vector<json> answers;          // without the greeting
  std::map<std::string, json> by_id;  // without the number of their line
};

Stream StreamOf(ProcessResult process) {
  Stream stream{std::move(process), {}, {}};
  std::istringstream lines(stream.process.out);
  for (std::string line; std::getline(lines, line);) {
    json answer = json::parse(line, nullptr, false);
    if (answer.is_discarded() || answer.contains("protocol")) continue;
    stream.answers.push_back(answer);
    answer.erase("line");
    if (answer["id"].is_string()) stream.by_id[answer["id"]] = answer;
  }
  return stream;
}

Stream Piped(const std::string& lines, const std::vector<std::string>& arguments,
             const std::string& script = "exec GAUNTLET") {
  const TemporaryDirectory scratch;
  std::ofstream(scratch / "lines") << lines;
  return StreamOf(RunProcess(InShell(script + " < " + scratch / "lines", arguments)));
}

TEST(StreamTest, AnyNumberOfWorkersGivesTheSameAnswersAndTheSameState) {
  const TemporaryDirectory scratch;
  const Stream one = Piped(Lines(30), StreamArguments(scratch / "one", 1));
  const Stream eight = Piped(Lines(30), StreamArguments(scratch / "eight", 8));
  EXPECT_EQ(one.process.exit_code, 0) << one.process.err;
  EXPECT_THAT(one.by_id, SizeIs(30));
  EXPECT_EQ(one.by_id, eight.by_id);
  EXPECT_EQ(StateHash(scratch / "one"), StateHash(scratch / "eight"));
}

TEST(StreamTest, AnswersAreThoseOfEvaluate) {
  const TemporaryDirectory scratch;
  const std::string wall = R"({"obstacles": [{"x": 0.5, "y": 0.5, "length": 1.5, "width": 0.2}]})";
  std::ofstream(scratch / "wall.json") << wall;
  std::ofstream(scratch / "lines") << "{\"file\": \"" << scratch / "wall.json"
                                   << "\", \"replicates\": 3}\n";
  const Stream asked = StreamOf(
      RunProcess(InShell("exec GAUNTLET < " + scratch / "lines", StreamArguments(scratch / "stream"))));
  const ProcessResult file =
      Gauntlet({"evaluate", "flocking", "--case", scratch / "wall.json", "--replicates", "3", "--json",
                "--quiet", "--dir", scratch / "file", "--set", "scenario_parameters.time_limit=30"});
  ASSERT_THAT(asked.answers, SizeIs(1));
  EXPECT_EQ(asked.answers[0]["runs"], json::parse(file.out)["cases"][0]["runs"]);
}

TEST(StreamTest, KilledAtAnyMomentNoAnswerIsLostOrDifferent) {
  const TemporaryDirectory scratch;
  const Stream expected = Piped(Lines(60), StreamArguments(scratch / "whole"));
  ASSERT_THAT(expected.by_id, SizeIs(60));
  sim::RandomStream random(1, sim::StreamPurpose::kTest);
  std::ofstream(scratch / "lines") << Lines(60);
  int cut_short = 0;
  for (int kill = 0; kill < 6; ++kill) {
    Process process(InShell("exec GAUNTLET < " + scratch / "lines", StreamArguments(scratch / "killed")));
    const auto moment = RandomTime(random, std::chrono::milliseconds(700));
    Eventually([&] { return !process.Running(); }, moment);
    process.Signal(SIGKILL);
    const Stream cut = StreamOf(process.Wait());
    if (cut.by_id.size() < 60) ++cut_short;
    for (const auto& [id, answer] : cut.by_id) EXPECT_EQ(answer, expected.by_id.at(id));
  }
  EXPECT_GE(cut_short, 2);
  const Stream last = Piped(Lines(60), StreamArguments(scratch / "killed"));
  EXPECT_EQ(last.process.exit_code, 0) << last.process.err;
  EXPECT_EQ(last.by_id, expected.by_id);
  EXPECT_EQ(StateHash(scratch / "killed"), StateHash(scratch / "whole"));
}

TEST(StreamTest, WhatASearchElsewhereFoundIsAskedAbout) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  ASSERT_EQ(Piped(Lines(6), StreamArguments(dir)).process.exit_code, 0);
  // Runs of 30 s end before the prey arrives: all of them fail.
  const ProcessResult confirmed = Gauntlet({"confirm", dir, "1", "--replicates", "5", "--quiet"});
  EXPECT_EQ(confirmed.exit_code, 0) << confirmed.err;
  EXPECT_THAT(confirmed.out, HasSubstr("run 1"));
  EXPECT_EQ(Gauntlet({"replay", dir, "1"}).exit_code, 0);
  EXPECT_EQ(Gauntlet({"report", dir, "--out", scratch / "r.html"}).exit_code, 0);
  EXPECT_THAT(Gauntlet({"show", dir}).out, HasSubstr("a stream of cases"));
}

TEST(StreamTest, ASignalEndsItAndTheSameCommandGoesOn) {
  const TemporaryDirectory scratch;
  ASSERT_EQ(mkfifo((scratch / "in").c_str(), 0600), 0);
  Process process(InShell("exec GAUNTLET < " + scratch / "in", StreamArguments(scratch / "c")));
  std::ofstream in(scratch / "in");
  in << Lines(2) << std::flush;
  ASSERT_TRUE(Eventually([&] { return StreamOf({.out = process.Out()}).answers.size() == 2; }, kPatience));
  process.Signal(SIGTERM);
  EXPECT_EQ(process.Wait().exit_code, 3);
  const Stream next = Piped(Lines(3), StreamArguments(scratch / "c"));
  EXPECT_EQ(next.process.exit_code, 0);
  EXPECT_THAT(next.by_id, SizeIs(3));
  EXPECT_EQ(Show(scratch / "c")["runs_done"], 4) << "the first line asks for two";
}

TEST(StreamTest, WhoStopsReadingStopsIt) {
  const TemporaryDirectory scratch;
  std::ofstream(scratch / "lines") << Lines(60);
  const ProcessResult cut = RunProcess(
      InShell("{ GAUNTLET < " + scratch / "lines" + "; echo \"exit $?\" >&2; } | head -n 2 > /dev/null",
              StreamArguments(scratch / "c")));
  EXPECT_THAT(cut.err, HasSubstr("nobody reads the answers"));
  EXPECT_THAT(cut.err, HasSubstr("exit 3"));
  EXPECT_THAT(Piped(Lines(60), StreamArguments(scratch / "c")).by_id, SizeIs(60));
}

TEST(StreamTest, AnotherExperimentOrCampaignIsRefusedByName) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  ASSERT_EQ(Piped(Lines(1), StreamArguments(dir)).process.exit_code, 0);
  std::vector<std::string> other = StreamArguments(dir);
  other.back() = "scenario_parameters.time_limit=31";
  const Stream refused = Piped(Lines(1), other);
  EXPECT_EQ(refused.process.exit_code, 2);
  EXPECT_THAT(refused.process.err, HasSubstr("scenario_parameters.time_limit = 30"));
  const ProcessResult resumed = Gauntlet({"resume", dir});
  EXPECT_EQ(resumed.exit_code, 2);
  EXPECT_THAT(resumed.err, HasSubstr("--stdin --dir " + dir));
  const std::string evolved = scratch / "evolved";
  ASSERT_EQ(Gauntlet(EvolveArguments({.population = 4, .generations = 1}, evolved, 2)).exit_code, 0);
  const Stream wrong = Piped(Lines(1), StreamArguments(evolved));
  EXPECT_EQ(wrong.process.exit_code, 2);
  EXPECT_THAT(wrong.process.err, HasSubstr("no stream of cases"));
}

TEST(StreamTest, OptionsThatContradictItAreRefused) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--case", "x.json"}, {"--from", "x"}, {"--dry-run"}, {"--seeds", "1..3"}}) {
    const TemporaryDirectory scratch;
    std::vector<std::string> arguments = StreamArguments(scratch / "c");
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult refused = Gauntlet(arguments);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("--stdin goes without"));
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
