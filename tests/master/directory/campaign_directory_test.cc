#include "master/directory/campaign_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(CampaignDirectoryTest, MakesTheDirectoriesAbove) {
  const ScratchDirectory scratch;
  Result<CampaignDirectory> made = CampaignDirectory::Create(scratch / "a/b/c/");
  ASSERT_TRUE(made.ok()) << made.error().message;
  EXPECT_EQ(made->path(), scratch / "a/b/c");
  EXPECT_TRUE(fs::is_directory(scratch / "a/b/c"));
  EXPECT_EQ(made->database_path(), scratch / "a/b/c/campaign.db");
}

TEST(CampaignDirectoryTest, ACampaignIsNotMadeTwiceAndResumeIsNamed) {
  const ScratchDirectory scratch;
  WriteFile(scratch / "campaign.db", "x");
  Result<CampaignDirectory> made = CampaignDirectory::Create(scratch.path());
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(made.error().message, HasSubstr("gauntlet resume " + scratch.path()));
}

TEST(CampaignDirectoryTest, AFileOrALinkToNothingIsToldByWhatItIs) {
  const ScratchDirectory scratch;
  WriteFile(scratch / "file", "x");
  fs::create_symlink("nothing", scratch / "link");
  EXPECT_EQ(CampaignDirectory::Open(scratch / "file").error().message,
            scratch.path() + "/file is a file; a campaign is a directory");
  EXPECT_EQ(CampaignDirectory::CheckCreatable(scratch / "file").error().message,
            scratch.path() + "/file is a file; a campaign needs a directory");
  EXPECT_EQ(CampaignDirectory::CheckCreatable(scratch / "link").error().message,
            scratch.path() + "/link is a link that leads nowhere; a campaign needs a directory");
}

TEST(CampaignDirectoryTest, AnUnfinishedBeginningSaysHowToStartAnew) {
  const ScratchDirectory scratch;
  WriteFile(scratch / "lock", "");
  WriteFile(scratch / "campaign.db.new", "x");
  Result<CampaignDirectory> opened = CampaignDirectory::Open(scratch.path());
  ASSERT_FALSE(opened.ok());
  EXPECT_THAT(opened.error().message, HasSubstr("--dir " + scratch.path() + " starts anew"));
}

TEST(CampaignDirectoryTest, ADirectoryWithOtherFilesIsRefused) {
  for (const std::string name : {"notes.txt", "experiment.toml", "lock.txt"}) {
    const ScratchDirectory scratch;
    WriteFile(scratch / name, "mine");
    Result<CampaignDirectory> made = CampaignDirectory::Create(scratch.path());
    ASSERT_FALSE(made.ok()) << name;
    EXPECT_EQ(made.error().kind, ErrorKind::kInvalidInput);
    EXPECT_THAT(made.error().message, HasSubstr("gauntlet resume " + scratch.path()));
    EXPECT_EQ(ReadFile(scratch / name), "mine");
  }
}

TEST(CampaignDirectoryTest, ACreationThatWasKilledIsNoObstacle) {
  const ScratchDirectory scratch;
  for (const std::string name :
       {"lock", "experiment.toml", "epoch", "epoch.Xa81bc", "campaign.db.new", "campaign.db.new-wal"}) {
    WriteFile(scratch / name, "half");
  }
  fs::create_directory(scratch / "log");
  EXPECT_TRUE(CampaignDirectory::Create(scratch.path()).ok());
  WriteFile(scratch / "thesis.pdf", "mine");
  EXPECT_FALSE(CampaignDirectory::Create(scratch.path()).ok());
}

TEST(CampaignDirectoryTest, AFileIsNoDirectory) {
  const ScratchDirectory scratch;
  WriteFile(scratch / "file", "x");
  for (const std::string& path : {scratch / "file", scratch / "file/below"}) {
    Result<CampaignDirectory> made = CampaignDirectory::Create(path);
    ASSERT_FALSE(made.ok());
    EXPECT_THAT(made.error().message, HasSubstr(path));
  }
}

TEST(CampaignDirectoryTest, OpeningSaysWhatIsMissing) {
  const ScratchDirectory scratch;
  Result<CampaignDirectory> opened = CampaignDirectory::Open(scratch / "none");
  ASSERT_FALSE(opened.ok());
  EXPECT_EQ(opened.error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(opened.error().message, "there is no directory " + scratch / "none");
  opened = CampaignDirectory::Open(scratch.path());
  ASSERT_FALSE(opened.ok());
  EXPECT_EQ(opened.error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(opened.error().message, scratch.path() + " is not a campaign: it holds no campaign.db");
}

class EpochTest : public testing::Test {
 protected:
  ScratchDirectory scratch_;
  CampaignDirectory directory_ = *CampaignDirectory::Create(scratch_.path());
};

TEST_F(EpochTest, EveryStartHasTheNextNumber) {
  for (std::uint64_t expected = 1; expected <= 12; ++expected) {
    Result<std::uint64_t> epoch = directory_.StartEpoch();
    ASSERT_TRUE(epoch.ok()) << epoch.error().message;
    EXPECT_EQ(*epoch, expected);
    EXPECT_TRUE(directory_.CheckEpoch(expected).ok());
  }
  EXPECT_EQ(ReadFile(directory_.epoch_path()), "12\n");
}

TEST_F(EpochTest, AnOlderMasterLearnsOfTheNewer) {
  ASSERT_TRUE(directory_.StartEpoch().ok());
  ASSERT_TRUE(directory_.StartEpoch().ok());
  const Status checked = directory_.CheckEpoch(1);
  ASSERT_FALSE(checked.ok());
  EXPECT_EQ(checked.error().kind, ErrorKind::kInUse);
  EXPECT_THAT(checked.error().message, HasSubstr("newer master (start number 2; this one is number 1)"));
}

// Strangers may use up a master's descriptors; that a newer one has begun is noticed all the same.
TEST_F(EpochTest, ItIsCheckedWithoutADescriptorToo) {
  ASSERT_TRUE(directory_.StartEpoch().ok());
  CampaignDirectory newer = directory_;
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
  const rlimit none{0, limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const Status same = directory_.CheckEpoch(1);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
  EXPECT_TRUE(same.ok()) << same.error().message;

  ASSERT_TRUE(newer.StartEpoch().ok());
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  const Status outdated = directory_.CheckEpoch(1);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
  EXPECT_FALSE(outdated.ok());
}

TEST_F(EpochTest, AFileThatIsGoneIsToldAndOneThatIsDamagedStopsTheMaster) {
  EXPECT_EQ(directory_.CheckEpoch(1).error().kind, ErrorKind::kNotFound);
  ASSERT_TRUE(directory_.RestoreEpoch(1).ok());
  EXPECT_TRUE(directory_.CheckEpoch(1).ok());
  for (const std::string text : {"", "x", "-1\n", "0\n", "1 2\n", "99999999999999999999999\n"}) {
    WriteFile(directory_.epoch_path(), text);
    EXPECT_EQ(directory_.CheckEpoch(1).error().kind, ErrorKind::kCorrupt) << text;
    const Result<std::uint64_t> started = directory_.StartEpoch();
    ASSERT_FALSE(started.ok()) << text;
    EXPECT_THAT(started.error().message, HasSubstr(directory_.epoch_path()));
  }
}

// The number begins those of the leases, in 32 bits.
TEST_F(EpochTest, ANumberThatCannotBeCountedOnIsDamage) {
  for (const std::string number : {"4294967295", "4294967296", "18446744073709551615"}) {
    WriteFile(directory_.epoch_path(), number + "\n");
    const Result<std::uint64_t> started = directory_.StartEpoch();
    ASSERT_FALSE(started.ok()) << number;
    EXPECT_EQ(started.error().kind, ErrorKind::kCorrupt);
    EXPECT_THAT(started.error().message, HasSubstr("holds '" + number + "'"));
    EXPECT_THAT(started.error().message, HasSubstr("1 to 4294967294"));
  }
  WriteFile(directory_.epoch_path(), "4294967294\n");
  EXPECT_EQ(*directory_.StartEpoch(), 4294967295U);
  EXPECT_TRUE(directory_.CheckEpoch(4294967295U).ok());
}

TEST(CampaignDirectoryTest, IsMadeForItsOwnerToWriteAloneAndNotMadeWhereOthersWrite) {
  const ScratchDirectory scratch;
  const mode_t before = umask(0);
  ASSERT_TRUE(CampaignDirectory::Create(scratch / "a/b").ok());
  umask(before);
  for (const std::string made : {"a", "a/b"}) {
    EXPECT_EQ(fs::status(scratch / made).permissions() & (fs::perms::group_write | fs::perms::others_write),
              fs::perms::none)
        << made;
  }
  fs::permissions(scratch / "a/b", fs::perms::all);
  const Result<CampaignDirectory> again = CampaignDirectory::Create(scratch / "a/b");
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(again.error().message,
            scratch.path() +
                "/a/b has mode 777: other users may write it, who so would decide what this command does in "
                "your name. If it holds what you left there: `chmod go-w " +
                scratch.path() + "/a/b`");
}

TEST(CampaignIdTest, IsNewEveryTime) {
  const std::string first = NewCampaignId();
  const std::string second = NewCampaignId();
  EXPECT_THAT(first, testing::MatchesRegex("[0-9a-f]+"));
  EXPECT_EQ(first.size(), 32u);
  EXPECT_NE(first, second);
}

}  // namespace
}  // namespace gauntlet
