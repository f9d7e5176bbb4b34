// Questions about cases with real processes: confirm, minimise, blame and check. What they say of one case is
// held by tests/cli/goldens and tests/study/questions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "tests/integration/campaign_database.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/question_drill.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

nlohmann::json Json(const std::vector<std::string>& arguments) {
  const ProcessResult result = Gauntlet(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

// Of the first 24 cases three fail: those of runs 4, 23 and 24.
void MakeCampaign(const std::string& dir, int cases) {
  ASSERT_EQ(
      Gauntlet({"random", "flocking", "--cases", std::to_string(cases), "--dir", dir, "--quiet"}).exit_code,
      0);
}

std::vector<std::string> ConfirmAll(const std::string& dir, int workers) {
  return {"confirm", dir, "--all-failing", "--workers", std::to_string(workers), "--json", "--quiet"};
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

struct QuestionKind {
  std::string name;   // of the command
  std::string place;  // what it asks about, and in it the folder of its calls
  std::string folder;
  std::vector<std::string> more;  // arguments
};

void PrintTo(const QuestionKind& kind, std::ostream* out) {
  *out << kind.name;
}

class QuestionTest : public testing::TestWithParam<QuestionKind> {
 protected:
  // In a copy of the campaign and its corpus.
  std::vector<std::string> Command(const std::string& copy, int workers) const {
    std::vector<std::string> command = {GetParam().name, scratch_ / (copy + GetParam().place)};
    command.insert(command.end(), GetParam().more.begin(), GetParam().more.end());
    command.insert(command.end(), {"--workers", std::to_string(workers), "--json", "--quiet"});
    return command;
  }
  // What it says there, whatever the copy is called.
  std::string Said(const std::string& copy, const ProcessResult& result) const {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::string text = result.out;
    const std::string path = scratch_ / copy;
    for (auto at = text.find(path); at != std::string::npos; at = text.find(path, at))
      text.replace(at, path.size(), "HERE");
    return text;
  }
  std::vector<std::string> Hashes(const std::string& copy) const {
    return StateHashesIn(scratch_ / (copy + GetParam().place + GetParam().folder));
  }

  const TemporaryDirectory scratch_;
};

TEST_P(QuestionTest, IsAnsweredAlikeByAnyNumberOfWorkersAndAfterAKillAndLeavesTheCampaignAsItWas) {
  MakeCampaign(scratch_ / "one/found", 24);
  if (GetParam().name == "check") {
    ASSERT_EQ(Gauntlet(ConfirmAll(scratch_ / "one/found", 2)).exit_code, 0);
    ASSERT_EQ(Gauntlet({"corpus", "add", scratch_ / "one/found", "23", "24", "--to", scratch_ / "one/corpus"})
                  .exit_code,
              0);
  }
  const std::string before = StateHash(scratch_ / "one/found");
  for (const char* copy : {"three", "killed"})
    std::filesystem::copy(scratch_ / "one", scratch_ / copy, std::filesystem::copy_options::recursive);
  const std::string one = Said("one", Gauntlet(Command("one", 1)));
  EXPECT_EQ(StateHash(scratch_ / "one/found"), before);
  EXPECT_EQ(Said("three", Gauntlet(Command("three", 3))), one);
  const std::string folder = scratch_ / ("killed" + GetParam().place + GetParam().folder);
  EXPECT_EQ(Said("killed", AskThroughKills(Command("killed", 2), folder, 3)), one);
  EXPECT_EQ(Hashes("three"), Hashes("one"));
  EXPECT_EQ(Hashes("killed"), Hashes("one"));
  EXPECT_EQ(Said("one", Gauntlet(Command("one", 2))), one) << "once it is known";
}

INSTANTIATE_TEST_SUITE_P(
    Questions, QuestionTest,
    testing::Values(QuestionKind{"confirm", "/found", "/confirm", {"--all-failing"}},
                    // Not run 4, of which no part fails: to find that takes three times as many runs.
                    QuestionKind{"minimise", "/found", "/minimise", {"23"}},
                    QuestionKind{
                        "blame",
                        "/found",
                        "/blame",
                        {GAUNTLET_SOURCE_DIR "/tests/integration/cases/trap.json", "--replicates", "8"}},
                    QuestionKind{"check", "/corpus", "/.check", {}}),
    [](const auto& instance) { return instance.param.name; });

TEST(ConfirmTest, TheElitesOfAnArchiveFailAgain) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "archive";
  const nlohmann::json found = Json({"evolve", "flocking", "--set", "search.algorithm=archive", "--set",
                                     "search.runs=200", "--dir", dir, "--json", "--quiet"});
  const nlohmann::json& elites = found["archive"]["elites"];
  ASSERT_GE(elites.size(), 3U);
  EXPECT_EQ(elites.size(), found["archive"]["filled"]);
  std::size_t confirmed = 0;
  const nlohmann::json cases = Json({"confirm", dir, "--elites", "--json", "--quiet"})["cases"];
  EXPECT_EQ(cases.size(), elites.size());
  for (const nlohmann::json& one : cases) confirmed += one["verdict"] == "fail" ? 1 : 0;
  EXPECT_GE(10 * confirmed, 7 * cases.size()) << "they were chosen for failing 3 of 3 or 4 of 5 times";
}

TEST(ConfirmTest, BudgetsAreComparedByWhatWasConfirmed) {
  const TemporaryDirectory scratch;
  const auto search = [&](const std::string& algorithm, const std::string& length) {
    const std::string dir = scratch / algorithm;
    const ProcessResult result =
        Gauntlet({"evolve", "flocking", "--set", "search.algorithm=" + algorithm, "--set", "search." + length,
                  "--seeds", "1..2", "--dir", dir, "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return dir;
  };
  const std::string archive = search("archive", "runs=100");
  const std::string random = search("random", "cases=100");
  const ProcessResult early = Gauntlet({"compare", "--budget", archive, random});
  EXPECT_EQ(early.exit_code, 2);
  EXPECT_EQ(early.err,
            "gauntlet: " + (scratch / "archive") +
                ": 10 of its 10 elites have not been simulated again with fresh seeds: `gauntlet confirm " +
                (scratch / "archive") + " --elites`\n");

  const std::size_t elites = Json({"confirm", archive, "--elites", "--json", "--quiet"})["cases"].size();
  const nlohmann::json failing = Json(ConfirmAll(random, 2))["cases"];
  const nlohmann::json table = Json({"compare", "--budget", archive, random, "--json"});
  EXPECT_EQ(table["runs"], 100);
  EXPECT_EQ(table["sets"][0]["cases"], elites);
  EXPECT_EQ(table["sets"][1]["cases"], failing.size());
  const auto confirmed =
      std::ranges::count(failing, "fail", [](const nlohmann::json& one) { return one["verdict"]; });
  EXPECT_EQ(table["sets"][1]["confirmed"], confirmed);
  EXPECT_EQ(table["sets"][0]["cells"]["values"].size(), 2U);
  EXPECT_GT(table["sets"][0]["cells_with_up_to_3"]["mean"], 0.0);
  EXPECT_EQ(table["sets"][1]["cells_with_up_to_3"]["mean"], 0.0) << "random cases have eight obstacles";
  EXPECT_LE(table["sets"][1]["cells_with_up_to_3"]["p"], 1.0);
}

// Of a call that was killed, and not repeated as it was.
TEST(ConfirmTest, WhatAStoppedCallHasDecidedIsNotSimulatedAgain) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  MakeCampaign(dir, 24);
  const auto calls = [&] {
    std::error_code none;
    std::vector<std::string> found;
    for (const auto& call : std::filesystem::directory_iterator(dir + "/confirm", none))
      found.push_back(call.path());
    return found;
  };
  const auto master = StartGauntlet(ConfirmAll(dir, 1), {"GAUNTLET_WORKER=" + WorkerPath() + "-slow",
                                                         "GAUNTLET_TEST_RUN_MILLISECONDS=100"});
  // Three cases with five runs each, of which the first case's come first.
  ASSERT_TRUE(Eventually(
      [&] {
        return calls().size() == 1 && std::filesystem::exists(calls()[0] + "/campaign.db") &&
               StoredRuns(calls()[0]).size() >= 5;
      },
      kPatience));
  master->Signal(SIGKILL);
  master->Wait();
  ASSERT_LT(StoredRuns(calls()[0]).size(), 15U);

  EXPECT_EQ(Json({"confirm", dir, "4", "--json", "--quiet"})["cases"][0]["n"], 5);
  EXPECT_EQ(calls().size(), 1U) << "nothing was simulated";
  EXPECT_EQ(Json(ConfirmAll(dir, 2))["cases"].size(), 3U);
  EXPECT_EQ(calls().size(), 1U) << "the same call is gone on with";
}

TEST(ConfirmTest, WhatIsKnownIsNotSimulatedAgain) {
  const TemporaryDirectory scratch;
  MakeCampaign(scratch / "c", 24);
  const nlohmann::json all = Json(ConfirmAll(scratch / "c", 2));
  const std::string run = all["cases"][0]["run"].dump();
  const ProcessResult again = Gauntlet({"confirm", scratch / "c", run, "--json"});
  EXPECT_EQ(nlohmann::json::parse(again.out)["cases"][0], all["cases"][0]);
  EXPECT_EQ(again.err, "");
  const nlohmann::json more =
      Json({"confirm", scratch / "c", run, "--replicates", "20", "--json", "--quiet"});
  EXPECT_EQ(more["cases"][0]["n"], 20);
  EXPECT_EQ(Json({"show", scratch / "c", "--json"})["confirmed"][0]["n"], 20);
}

TEST(ConfirmTest, AnotherEngineIsAskedApartAndStandsBeside) {
  const TemporaryDirectory scratch;
  MakeCampaign(scratch / "c", 24);
  const nlohmann::json own = Json(ConfirmAll(scratch / "c", 2));
  const std::string run = own["cases"][0]["run"].dump();
  const nlohmann::json there =
      Json({"confirm", scratch / "c", run, "--engine", "box2d", "--replicates", "3", "--json", "--quiet"});
  EXPECT_EQ(there["engine"], "box2d");
  EXPECT_EQ(there["cases"][0]["n"], 3);
  const nlohmann::json shown = Json({"show", scratch / "c", "--json"})["confirmed"];
  ASSERT_EQ(shown.size(), own["cases"].size()) << "no case stands there twice";
  EXPECT_EQ(shown[0]["k"], own["cases"][0]["k"]);
  EXPECT_EQ(shown[0]["box2d_k"], there["cases"][0]["k"]);
  EXPECT_EQ(shown[0]["box2d_n"], 3);
  const auto refused = [&](const std::string& engine) {
    return Gauntlet({"confirm", scratch / "c", run, "--engine", engine}).err;
  };
  EXPECT_THAT(refused("impulse"), HasSubstr("--engine impulse: the search itself ran under it"));
  EXPECT_THAT(refused("bullet"), HasSubstr("--engine bullet: the engines are box2d, impulse"));
  EXPECT_THAT(refused("argos"), HasSubstr("--engine NAME.toml"));
  EXPECT_THAT(refused("nowhere.toml"), HasSubstr("nowhere.toml"));
}

TEST(ConfirmTest, AnotherExperimentSimulatesTheCases) {
  const TemporaryDirectory scratch;
  MakeCampaign(scratch / "c", 24);
  const nlohmann::json own = Json(ConfirmAll(scratch / "c", 2))["cases"];
  std::ofstream(scratch / "hasty.toml")
      << "scenario = \"flocking\"\n[scenario_parameters]\ntime_limit = 1\n";  // nothing splits so soon
  const std::string run = own[0]["run"].dump();
  const nlohmann::json there = Json({"confirm", scratch / "c", run, "--engine", scratch / "hasty.toml",
                                     "--replicates", "3", "--json", "--quiet"});
  EXPECT_EQ(there["engine"], "hasty");
  EXPECT_EQ(there["cases"][0]["k"], 0);
  const nlohmann::json shown = Json({"show", scratch / "c", "--json"})["confirmed"];
  EXPECT_EQ(shown[0]["k"], own[0]["k"]);
  EXPECT_EQ(shown[0]["hasty_k"], 0);
  EXPECT_EQ(shown[0]["hasty_n"], 3);
}

TEST(MinimiseTest, WhatIsLeftFailsAndSaysWhereItComesFrom) {
  const TemporaryDirectory scratch;
  MakeCampaign(scratch / "c", 24);
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
  MakeCampaign(scratch / "c", 24);
  ASSERT_EQ(Gauntlet({"confirm", scratch / "c", "--all-failing", "--replicates", "20", "--quiet"}).exit_code,
            0);
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

}  // namespace
}  // namespace gauntlet::testing_support
