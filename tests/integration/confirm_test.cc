// gauntlet confirm with real processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/question_drill.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

nlohmann::json Json(const std::vector<std::string>& arguments) {
  const ProcessResult result = Gauntlet(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

std::vector<std::string> ConfirmAll(const std::string& dir, int workers) {
  return {"confirm", dir, "--all-failing", "--workers", std::to_string(workers), "--json", "--quiet"};
}

// Some of its cases fail.
void MakeCampaignToConfirm(const std::string& dir) {
  ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "60", "--dir", dir, "--quiet"}).exit_code, 0);
}

TEST(ConfirmTest, TheSameForAnyNumberOfWorkersAndTheCampaignStaysAsItWas) {
  const TemporaryDirectory scratch;
  MakeCampaignToConfirm(scratch / "a");
  std::filesystem::copy(scratch / "a", scratch / "b", std::filesystem::copy_options::recursive);
  const nlohmann::json before = Json({"show", scratch / "a", "--json"});
  EXPECT_TRUE(before["confirmed"].empty());
  const nlohmann::json one = Json(ConfirmAll(scratch / "a", 1));
  EXPECT_EQ(one, Json(ConfirmAll(scratch / "b", 3)));
  ASSERT_FALSE(one["cases"].empty());
  for (const nlohmann::json& each : one["cases"]) {
    const int k = each["k"];
    const int n = each["n"];
    EXPECT_EQ(each["verdict"], 2 * k >= n ? "fail" : k > 0 ? "flaky" : "pass");
    EXPECT_TRUE(k == 5 || n - k == 6) << each;
    EXPECT_LE(each["interval"][0].get<double>() * n, k);
    EXPECT_GE(each["interval"][1].get<double>() * n, k);
  }
  const nlohmann::json after = Json({"show", scratch / "a", "--json"});
  EXPECT_EQ(after["state_hash"], before["state_hash"]);
  EXPECT_EQ(after["runs_done"], before["runs_done"]);
  EXPECT_EQ(after["confirmed"], one["cases"]);

  std::size_t failed_again = 0;
  for (const nlohmann::json& each : one["cases"]) failed_again += each["k"] > 0 ? 1 : 0;
  std::set<std::string> grouped;
  double toughest = 1.0;
  for (const nlohmann::json& failure : after["distinct_failures"]) {
    for (const nlohmann::json& name : failure["cases"]) grouped.insert(name);
    const double share = failure["k"].get<double>() / failure["n"].get<double>();
    EXPECT_LE(share, toughest) << "toughest first";
    toughest = share;
    EXPECT_THAT(failure["what"].get<std::string>(), HasSubstr("near ("));
    const nlohmann::json replay =
        Json({"replay", failure["example"]["campaign"], failure["example"]["run"].dump(), "--json"});
    EXPECT_EQ(replay["total_failure"], true);
  }
  EXPECT_EQ(grouped.size(), failed_again) << "each case that failed again is of one group";
  EXPECT_THAT(Gauntlet({"show", scratch / "a"}).out,
              HasSubstr(std::to_string(after["distinct_failures"].size()) + " distinct failure"));
}

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

TEST(ConfirmTest, WhatIsKnownIsNotSimulatedAgain) {
  const TemporaryDirectory scratch;
  MakeCampaignToConfirm(scratch / "c");
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

TEST(ConfirmTest, EndsAsUndisturbedWhenItIsKilled) {
  const TemporaryDirectory scratch;
  MakeCampaignToConfirm(scratch / "whole");
  std::filesystem::copy(scratch / "whole", scratch / "killed", std::filesystem::copy_options::recursive);
  const nlohmann::json whole = Json(ConfirmAll(scratch / "whole", 2));
  const ProcessResult killed =
      AskThroughKills(ConfirmAll(scratch / "killed", 2), scratch / "killed/confirm", 3);
  ASSERT_EQ(killed.exit_code, 0) << killed.err;
  EXPECT_EQ(nlohmann::json::parse(killed.out), whole) << killed.err;
  EXPECT_EQ(StateHashesIn(scratch / "killed/confirm"), StateHashesIn(scratch / "whole/confirm"));
}

}  // namespace
}  // namespace gauntlet::testing_support
