#include "master/directory/campaign_origin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CampaignOriginTest : public testing::Test {
 protected:
  void SetUp() override {
    Put(first_ + "/campaign.db", "a database");
    Put(first_ + "/master.key", "secret");
    Put(first_ + "/access.json", "secret");
    EXPECT_EQ(Confirm(first_).campaign_id, "born");
  }
  static void Put(const std::string& path, const std::string& text) {
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path) << text;
  }
  static CampaignOrigin Confirm(const std::string& dir) {
    const Result<CampaignDirectory> directory = CampaignDirectory::Open(dir);
    EXPECT_TRUE(directory.ok());
    const Result<CampaignOrigin> origin = ConfirmOrigin(*directory, "born");
    EXPECT_TRUE(origin.ok()) << (origin.ok() ? "" : origin.error().message);
    return origin.ok() ? *origin : CampaignOrigin{};
  }

  ScratchDirectory scratch_;
  std::string first_ = scratch_ / "first";
  std::string second_ = scratch_ / "second";
};

TEST_F(CampaignOriginTest, TheSameDirectoryIsTheSameCampaign) {
  const CampaignOrigin again = Confirm(first_);
  EXPECT_EQ(again.campaign_id, "born");
  EXPECT_EQ(again.copied_from, "");
  EXPECT_TRUE(fs::exists(first_ + "/master.key"));
}

TEST_F(CampaignOriginTest, AMovedDirectoryIsTheSameCampaign) {
  fs::rename(first_, second_);
  EXPECT_EQ(Confirm(second_).campaign_id, "born");
  EXPECT_TRUE(fs::exists(second_ + "/master.key"));
}

TEST_F(CampaignOriginTest, ACopyIsAnotherCampaignWithoutTheOldKeys) {
  fs::copy(first_, second_, fs::copy_options::recursive);
  const CampaignOrigin copy = Confirm(second_);
  EXPECT_EQ(copy.copied_from, "born");
  EXPECT_EQ(copy.campaign_id.size(), 32U);
  EXPECT_FALSE(fs::exists(second_ + "/master.key"));
  EXPECT_FALSE(fs::exists(second_ + "/access.json"));
  // From then on it is itself; a copy of the copy is a third.
  const CampaignOrigin again = Confirm(second_);
  EXPECT_EQ(again.campaign_id, copy.campaign_id);
  EXPECT_EQ(again.copied_from, "");
  fs::copy(second_, scratch_ / "third", fs::copy_options::recursive);
  EXPECT_EQ(Confirm(scratch_ / "third").copied_from, copy.campaign_id);
  // The original has not noticed.
  EXPECT_EQ(Confirm(first_).campaign_id, "born");
  EXPECT_TRUE(fs::exists(first_ + "/master.key"));
}

TEST_F(CampaignOriginTest, ACopyIsToldFromItsOriginalWithoutChangingIt) {
  const auto is_copy = [](const std::string& dir) { return IsUntakenCopy(*CampaignDirectory::Open(dir)); };
  EXPECT_FALSE(is_copy(first_));
  fs::copy(first_, second_, fs::copy_options::recursive);
  EXPECT_TRUE(is_copy(second_));
  EXPECT_TRUE(fs::exists(second_ + "/master.key"));
  EXPECT_TRUE(is_copy(second_));
  Confirm(second_);
  EXPECT_FALSE(is_copy(second_));
  for (const std::string text : {"", "{}"}) {
    Put(second_ + "/origin.json", text);
    EXPECT_FALSE(is_copy(second_)) << "nothing is known";
  }
  fs::remove(second_ + "/origin.json");
  EXPECT_FALSE(is_copy(second_)) << "nothing is known";
}

// File systems that spread their numbers over 64 bits.
TEST_F(CampaignOriginTest, TheLargestInodeReadsBack) {
  Put(first_ + "/origin.json",
      R"({"campaign": "x", "directory_inode": "18446744073709551615", "database_inode": "2"})");
  EXPECT_TRUE(IsUntakenCopy(*CampaignDirectory::Open(first_)));
}

TEST_F(CampaignOriginTest, AFileThatDoesNotReadBackIsReported) {
  for (const std::string text : {"", "{}", "[1]", R"({"campaign": "x", "directory_inode": "y"})",
                                 R"({"campaign": "x", "directory_inode": "1", "database_inode": "-1"})",
                                 R"({"campaign": "x", "directory_inode": "1 ", "database_inode": "2"})",
                                 R"({"campaign": "x", "directory_inode": "18446744073709551616",
                                     "database_inode": "2"})"}) {
    Put(first_ + "/origin.json", text);
    const Result<CampaignOrigin> origin = ConfirmOrigin(*CampaignDirectory::Open(first_), "born");
    ASSERT_FALSE(origin.ok()) << text;
    EXPECT_EQ(origin.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(origin.error().message, HasSubstr("origin.json"));
  }
}

}  // namespace
}  // namespace gauntlet
