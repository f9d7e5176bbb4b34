// gauntlet minimise with real processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/question_drill.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

// Of the first 24 cases three fail: those of runs 4, 23 and 24.
void MakeCampaignToMinimise(const std::string& dir, int cases) {
  ASSERT_EQ(
      Gauntlet({"random", "flocking", "--cases", std::to_string(cases), "--dir", dir, "--quiet"}).exit_code,
      0);
}

// The numbers of runs that failed, or that did not.
std::vector<std::string> Runs(const std::string& dir, bool failed, std::size_t most) {
  const nlohmann::json shown = nlohmann::json::parse(Gauntlet({"show", dir, "--json", "--runs"}).out);
  std::vector<std::string> ids;
  for (const nlohmann::json& run : shown["runs"]) {
    if (run["total_failure"].get<bool>() == failed && ids.size() < most) ids.push_back(run["id"].dump());
  }
  return ids;
}

std::vector<std::string> Minimise(const std::string& dir, std::vector<std::string> cases, int workers) {
  cases.insert(cases.begin(), {"minimise", dir});
  cases.insert(cases.end(), {"--workers", std::to_string(workers), "--json", "--quiet"});
  return cases;
}

// What it says, without the paths of files.
nlohmann::json FoundMinimal(const std::vector<std::string>& arguments) {
  const ProcessResult result = Gauntlet(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  nlohmann::json found = nlohmann::json::parse(result.out);
  for (nlohmann::json& one : found["cases"]) {
    if (one["minimised"].is_object()) one["minimised"].erase("files");
  }
  return found;
}

std::string CallOf(const std::string& dir) {
  return std::filesystem::directory_iterator(dir + "/minimise")->path().string();
}

std::string Write(const std::string& path, const nlohmann::json& document) {
  std::ofstream(path) << document;
  return path;
}

TEST(MinimiseTest, WhatIsLeftFailsAndSaysWhereItComesFrom) {
  const TemporaryDirectory scratch;
  MakeCampaignToMinimise(scratch / "c", 24);
  const std::string before = StateHash(scratch / "c");
  const std::vector<std::string> failing = Runs(scratch / "c", true, 3);
  const nlohmann::json found = FoundMinimal(Minimise(scratch / "c", failing, 2));
  ASSERT_EQ(found["cases"].size(), failing.size());
  EXPECT_EQ(StateHash(scratch / "c"), before);
  int kept = 0;
  int smaller = 0;
  for (const nlohmann::json& one : found["cases"]) {
    const nlohmann::json& left = one["minimised"];
    if (!left.is_null()) ++kept;
    if (left.is_null() || left["obstacles"] == 8) continue;
    ++smaller;
    EXPECT_EQ(left["n"], 30);
    EXPECT_GE(left["k"], 24);
    EXPECT_EQ(one["kept_same_way"], true);
    const nlohmann::json& lineage = left["case"]["lineage"];
    EXPECT_EQ(lineage["parent"]["obstacles"].size(), 8U);
    EXPECT_EQ(lineage["verified"]["k"], left["k"]);
    EXPECT_EQ(lineage["steps"].back()["obstacles"].size(), left["obstacles"]);
    // It is a case file like any other.
    const std::string file = Write(scratch / "left.json", left["case"]);
    const ProcessResult evaluated =
        Gauntlet({"evaluate", "flocking", "--case", file, "--replicates", "10", "--dir",
                  scratch / ("e" + std::to_string(smaller)), "--json", "--quiet"});
    ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
    int failures = 0;
    const nlohmann::json runs = nlohmann::json::parse(evaluated.out)["cases"][0]["runs"];
    for (const nlohmann::json& run : runs) failures += run["failure"]["total"].get<bool>() ? 1 : 0;
    EXPECT_GE(failures, 5);
  }
  EXPECT_GE(smaller, 2);
  const auto entries = std::filesystem::directory_iterator(CallOf(scratch / "c"));
  EXPECT_EQ(
      std::ranges::count_if(entries, [](const auto& entry) { return entry.path().extension() == ".svg"; }),
      kept);
}

// So that one looks at the small layout rather than at the case it was found in.
TEST(MinimiseTest, ShowNamesTheSmallestLayoutOfEachFailure) {
  const TemporaryDirectory scratch;
  MakeCampaignToMinimise(scratch / "c", 24);
  ASSERT_EQ(Gauntlet({"confirm", scratch / "c", "--all-failing", "--quiet"}).exit_code, 0);
  const nlohmann::json found = FoundMinimal(Minimise(scratch / "c", Runs(scratch / "c", true, 2), 2));
  const nlohmann::json shown = Show(scratch / "c");
  std::set<std::size_t> left;  // obstacles of all
  for (const nlohmann::json& one : found["cases"]) {
    if (!one["minimised"].is_null()) left.insert(one["minimised"]["obstacles"].get<std::size_t>());
  }
  ASSERT_FALSE(left.empty());
  std::set<std::size_t> told;
  for (const nlohmann::json& failure : shown["distinct_failures"]) {
    const nlohmann::json& smallest = failure["smallest"];
    if (smallest.is_null()) continue;
    EXPECT_THAT(failure["cases"], testing::Contains(smallest["case"]));
    const nlohmann::json kept = nlohmann::json::parse(ReadFile(smallest["file"]));
    EXPECT_EQ(kept["obstacles"].size(), smallest["obstacles"]);
    told.insert(smallest["obstacles"].get<std::size_t>());
  }
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(std::ranges::includes(left, told));
  EXPECT_EQ(*told.begin(), *left.begin()) << "the smallest of all is the smallest of its failure";
}

TEST(MinimiseTest, TheSameForAnyNumberOfWorkersAndAfterAKill) {
  const TemporaryDirectory scratch;
  MakeCampaignToMinimise(scratch / "one", 24);
  // Not the first, of which no part fails: to find that takes three times as many runs.
  const std::vector<std::string> failing = {Runs(scratch / "one", true, 2).back()};
  for (const char* copy : {"three", "killed"})
    std::filesystem::copy(scratch / "one", scratch / copy, std::filesystem::copy_options::recursive);
  const nlohmann::json one = FoundMinimal(Minimise(scratch / "one", failing, 1));
  EXPECT_EQ(FoundMinimal(Minimise(scratch / "three", failing, 3)), one);
  AskThroughKills(Minimise(scratch / "killed", failing, 2), scratch / "killed/minimise", 5);
  EXPECT_EQ(FoundMinimal(Minimise(scratch / "killed", failing, 2)), one);
  for (const char* copy : {"three/minimise", "killed/minimise"})
    EXPECT_EQ(StateHashesIn(scratch / copy), StateHashesIn(scratch / "one/minimise"));
  // Once it is known, nothing is simulated again.
  const ProcessResult again = Gauntlet({"minimise", scratch / "one", failing[0]});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err, "");
}

// Two runs of every case.
TEST(MinimiseTest, AnswersForACloneUnderTheNumberThatItWasGiven) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "30", "--set", "search.replicates=2", "--dir", dir,
                      "--quiet"})
                .exit_code,
            0);
  const nlohmann::json shown = nlohmann::json::parse(Gauntlet({"show", dir, "--json", "--runs"}).out);
  std::map<std::string, std::vector<std::string>> failed;  // runs by individual
  for (const nlohmann::json& run : shown["runs"]) {
    if (run["total_failure"].get<bool>()) failed[run["individual"].dump()].push_back(run["id"].dump());
  }
  const auto twice = std::ranges::find_if(failed, [](const auto& one) { return one.second.size() == 2; });
  ASSERT_NE(twice, failed.end());
  const std::string& first = twice->second[0];
  const std::string& second = twice->second[1];

  const nlohmann::json one = FoundMinimal(Minimise(dir, {first}, 2))["cases"][0];
  const ProcessResult again = Gauntlet(Minimise(dir, {second}, 2));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const nlohmann::json other = nlohmann::json::parse(again.out)["cases"][0];
  EXPECT_EQ(again.err, "") << "nothing is simulated again";
  EXPECT_EQ(other["name"], "run " + second);
  EXPECT_EQ(other["minimised"]["obstacles"], one["minimised"]["obstacles"]);
  EXPECT_EQ(std::string(other["minimised"]["files"][0]),
            scratch / "c/minimise/6aebb277c1f00de7/run-46-minimised.json");

  const ProcessResult both = Gauntlet({"confirm", dir, first, second, "--json"});
  EXPECT_EQ(nlohmann::json::parse(both.out)["cases"].size(), 1U);
  EXPECT_THAT(both.err, HasSubstr("run " + second + " has the same case as run " + first));

  std::filesystem::remove(other["minimised"]["files"][0]);  // then that of the first speaks for both
  const ProcessResult kept = Gauntlet({"corpus", "add", dir, second, second, "--to", scratch / "corpus"});
  ASSERT_EQ(kept.exit_code, 0) << kept.err;
  const nlohmann::json file = nlohmann::json::parse(ReadFile(scratch / ("corpus/run-" + second + ".json")));
  EXPECT_EQ(file["case"]["obstacles"].size(), one["minimised"]["obstacles"]);
}

// Walls 2, 5 and 7 are a trap together: without any of them the flock passes. The others are out of the way.
TEST(MinimiseTest, FindsAPlantedTrap) {
  const TemporaryDirectory scratch;
  MakeCampaignToMinimise(scratch / "c", 2);
  const nlohmann::json found =
      FoundMinimal(Minimise(scratch / "c", {GAUNTLET_SOURCE_DIR "/tests/integration/cases/trap.json"}, 2));
  const nlohmann::json& one = found["cases"][0];
  std::vector<int> kept = one["minimised"]["case"]["lineage"]["steps"].back()["obstacles"];
  EXPECT_EQ(kept, (std::vector<int>{2, 5, 7})) << one;
}

TEST(MinimiseTest, RefusesWhatDoesNotFailAndWhatFailsWithoutObstacles) {
  const TemporaryDirectory scratch;
  MakeCampaignToMinimise(scratch / "c", 2);
  const std::string harmless =
      Write(scratch / "harmless.json",
            {{"obstacles", {{{"x", 2.5}, {"y", -2.5}, {"length", 0.5}, {"width", 0.2}}}}});
  const ProcessResult passes = Gauntlet({"minimise", scratch / "c", harmless, "--quiet"});
  EXPECT_EQ(passes.exit_code, 2);
  EXPECT_EQ(passes.out,
            "  case           failed  obstacles  left  which  fails  probability (95 %)  runs\n"
            "  harmless.json  0 of 6          1     -             -                         6  not "
            "minimised: it does not fail often enough\n");

  // Birds that stand still lose the prey anywhere.
  ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "3", "--set", "controller_parameters.bird_speed=0.005",
                      "--dir", scratch / "slow", "--quiet"})
                .exit_code,
            0);
  const ProcessResult empty = Gauntlet({"minimise", scratch / "slow", "1", "--quiet"});
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_EQ(empty.out,
            "  case   failed  obstacles  left  which  fails  probability (95 %)  runs\n"
            "  run 1  5 of 5          8     -             -                         9  not minimised: the "
            "EMPTY ARENA FAILS TOO, in 4 of 4 runs\n");
}

}  // namespace
}  // namespace gauntlet::testing_support
