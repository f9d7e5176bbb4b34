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
  ExpectDamage("DELETE FROM states", "the table states holds 0 rows instead of the 2 that were stored");
  ExpectDamage("DELETE FROM states WHERE generation = (SELECT max(generation) FROM states)",
               "the table states holds 1 rows");
  ExpectDamage("DELETE FROM runs WHERE id = 5", "the table runs holds 15 rows instead of the 16");
  ExpectDamage("DELETE FROM runs WHERE id = 16", "the table runs holds 15 rows");
  ExpectDamage("DELETE FROM individuals WHERE id = 1", "the table individuals holds");
  ExpectDamage("DELETE FROM events", "the table events holds 0 rows");
}

// What a page takes with it that is lost or replaced by an empty one: the search had not finished, it seemed.
TEST_F(AlteredStoreTest, TheEndOfASearchIsMissedByStatusToo) {
  ExpectDamage("DELETE FROM finished", "the table finished holds 0 rows instead of the 1 that were stored");
  ExpectDamage("DELETE FROM searches", "the table searches holds 0 rows");
  ExpectDamage("DELETE FROM totals", "the table searches holds 1 rows instead of the 0");
  for (const char* sql : {"DELETE FROM finished", "DELETE FROM totals"}) {
    const std::string dir = *scratch_ / "unfinished";
    std::filesystem::remove_all(dir);
    std::filesystem::copy(*scratch_ / "whole", dir, std::filesystem::copy_options::recursive);
    ASSERT_GT(AlterDatabase(dir, sql), 0);
    const ProcessResult status = Gauntlet({"status", dir});
    EXPECT_EQ(status.exit_code, 2) << status.out;
    EXPECT_THAT(status.err, HasSubstr("was changed or is damaged: the table"));
  }
}

TEST_F(AlteredStoreTest, ChangedRowsAreNamed) {
  const std::string changed = "the row of run 3 was changed: its checksum differs";
  ExpectDamage("UPDATE runs SET fitness_bits = fitness_bits + 1 WHERE id = 3", changed, true);
  ExpectDamage("UPDATE runs SET verdict = 2 WHERE id = 3", changed, true);
  ExpectDamage("UPDATE runs SET individual = individual + 1 WHERE id = 3", changed, true);
  ExpectDamage(
      "UPDATE individuals SET test_case = (SELECT test_case FROM individuals WHERE id = 2) WHERE id = 1",
      "individual 1 of search 1 was changed: its checksum differs");
}

// Specs and results are looked at by those who read them.
TEST_F(AlteredStoreTest, ChangedRecordsAreNamedByWhoeverReadsThem) {
  for (const char* sql :
       {"UPDATE records SET result = (SELECT result FROM records WHERE run = 4) WHERE run = 3",
        "UPDATE records SET spec = x'7a00' WHERE run = 3", "DELETE FROM records WHERE run = 3"}) {
    const std::string dir = *scratch_ / "records";
    std::filesystem::remove_all(dir);
    std::filesystem::copy(*scratch_ / "whole", dir, std::filesystem::copy_options::recursive);
    ASSERT_GT(AlterDatabase(dir, sql), 0) << sql;
    const ProcessResult replay = Gauntlet({"replay", dir, "3"});
    EXPECT_EQ(replay.exit_code, 2) << sql;
    EXPECT_THAT(replay.err, HasSubstr("the spec or the result of run 3 was changed"));
    const ProcessResult resume = Gauntlet({"resume", dir, "--workers", "1"});
    EXPECT_EQ(resume.exit_code, 2) << sql;
    EXPECT_THAT(resume.err, HasSubstr("was changed or is damaged"));
  }
}

TEST_F(AlteredStoreTest, ReplayOfADatabaseThatDoesNotOpenExitsTwo) {
  const std::string dir = *scratch_ / "none";
  std::filesystem::copy(*scratch_ / "whole", dir, std::filesystem::copy_options::recursive);
  std::filesystem::resize_file(dir + "/campaign.db", 0);
  EXPECT_EQ(Gauntlet({"replay", dir, "3"}).exit_code, 2) << "nothing was compared";
}

}  // namespace
}  // namespace gauntlet::testing_support
