// gauntlet blame with real processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include <nlohmann/json.hpp>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/question_drill.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::ElementsAre;

// Walls 2, 5 and 7 are a trap together: without any of them the flock passes. The others are out of the way.
constexpr const char* kTrap = GAUNTLET_SOURCE_DIR "/tests/integration/cases/trap.json";

void MakeCampaign(const std::string& dir) {
  ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "2", "--dir", dir, "--quiet"}).exit_code, 0);
}

std::vector<std::string> BlameTrap(const std::string& dir, int workers, int replicates = 30) {
  return {"blame",
          dir,
          kTrap,
          "--workers",
          std::to_string(workers),
          "--replicates",
          std::to_string(replicates),
          "--json",
          "--quiet"};
}

nlohmann::json Found(const std::vector<std::string>& arguments) {
  const ProcessResult result = Gauntlet(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  nlohmann::json found = nlohmann::json::parse(result.out);
  found.erase("picture");
  return found;
}

TEST(BlameTest, NamesTheWallsOfAPlantedTrap) {
  const TemporaryDirectory scratch;
  MakeCampaign(scratch / "c");
  const ProcessResult result = Gauntlet(BlameTrap(scratch / "c", 2));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json blame = nlohmann::json::parse(result.out);
  std::vector<int> guilty;
  for (const nlohmann::json& obstacle : blame["obstacles"]) {
    const double effect = obstacle["effect"];
    EXPECT_LE(obstacle["interval"][0].get<double>(), effect);
    EXPECT_GE(obstacle["interval"][1].get<double>(), effect);
    if (obstacle["to_blame"].get<bool>()) guilty.push_back(obstacle["number"]);
  }
  EXPECT_THAT(guilty, ElementsAre(2, 5, 7));
  EXPECT_EQ(blame["sentence"].get<std::string>(),
            "trap.json fails in 30 of 30 runs. Obstacles 2, 5 and 7 do it: without 2 it fails in 4 of 30, "
            "without 5 it fails in 0 of 30, without 7 it fails in 0 of 30.");
  EXPECT_EQ(blame["simulations"], 9 * 30);
  EXPECT_GT(blame["obstacles"][1]["touched"][0], 0);  // the first wall; the first box is in nobody's way
  EXPECT_EQ(blame["obstacles"][0]["touched"][0], 0);
  EXPECT_TRUE(std::filesystem::exists(blame["picture"].get<std::string>()));
}

TEST(BlameTest, TheSameForAnyNumberOfWorkersAndAfterAKill) {
  const TemporaryDirectory scratch;
  MakeCampaign(scratch / "one");
  std::filesystem::copy(scratch / "one", scratch / "killed", std::filesystem::copy_options::recursive);
  const nlohmann::json one = Found(BlameTrap(scratch / "one", 1, 8));
  AskThroughKills(BlameTrap(scratch / "killed", 2, 8), scratch / "killed/blame", 3);
  EXPECT_EQ(Found(BlameTrap(scratch / "killed", 3, 8)), one);
  EXPECT_EQ(StateHashesIn(scratch / "killed/blame"), StateHashesIn(scratch / "one/blame"));
}

}  // namespace
}  // namespace gauntlet::testing_support
