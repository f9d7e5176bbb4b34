// A database whose rows were changed or deleted is not shown as if it were whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/integration/campaign_database.h"
#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

class AlteredStoreTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryDirectory;
    SmallCampaign campaign;
    campaign.generations = 2;
    ASSERT_EQ(Gauntlet(EvolveArguments(campaign, *scratch_ / "whole", 2)).exit_code, 0);
  }
  static void TearDownTestSuite() { delete scratch_; }

  void ExpectDamage(const std::string& sql, const std::string& said, bool in_run_3 = false) {
    const std::string dir = *scratch_ / "altered";
    std::filesystem::remove_all(dir);
    std::filesystem::copy(*scratch_ / "whole", dir, std::filesystem::copy_options::recursive);
    ASSERT_GT(AlterDatabase(dir, sql), 0) << sql;
    std::vector<std::vector<std::string>> commands = {{"show", dir}, {"resume", dir, "--workers", "1"}};
    if (in_run_3) commands.push_back({"replay", dir, "3"});
    for (const auto& command : commands) {
      const ProcessResult result = Gauntlet(command);
      EXPECT_EQ(result.exit_code, 2) << command[0] << " after " << sql << "\n" << result.err;
      EXPECT_THAT(result.err, HasSubstr(said)) << command[0];
      EXPECT_EQ(result.out, "");
    }
  }

  static TemporaryDirectory* scratch_;
};
TemporaryDirectory* AlteredStoreTest::scratch_ = nullptr;

TEST_F(AlteredStoreTest, DeletedRowsAreMissed) {
  ExpectDamage("DELETE FROM states", "the search has finished, but its states are missing");
  ExpectDamage("DELETE FROM states WHERE generation = (SELECT max(generation) FROM states)",
               "the newest state has seen only the runs up to 8");
  ExpectDamage("DELETE FROM runs WHERE id = 5", "run 5 is missing");
  ExpectDamage("DELETE FROM runs WHERE id = 16", "run 16 is missing");
}

TEST_F(AlteredStoreTest, ChangedColumnsAreNamed) {
  ExpectDamage("UPDATE runs SET fitness_bits = fitness_bits + 1 WHERE id = 3", "run 3 has fitness", true);
  ExpectDamage("UPDATE runs SET verdict = 2 WHERE id = 3", "run 3 has verdict 2 in its row, 'completed'",
               true);
  ExpectDamage("UPDATE runs SET individual = individual + 1 WHERE id = 3", "run 3 has seed", true);
  ExpectDamage(
      "UPDATE individuals SET test_case = (SELECT test_case FROM individuals WHERE id = 2) WHERE id = 1",
      "the stored test case of individual 1 is not the one that run");
}

TEST_F(AlteredStoreTest, ReplayOfADatabaseThatDoesNotOpenExitsTwo) {
  const std::string dir = *scratch_ / "none";
  std::filesystem::copy(*scratch_ / "whole", dir, std::filesystem::copy_options::recursive);
  std::filesystem::resize_file(dir + "/campaign.db", 0);
  EXPECT_EQ(Gauntlet({"replay", dir, "3"}).exit_code, 2) << "nothing was compared";
}

}  // namespace
}  // namespace gauntlet::testing_support
