// What a store refuses to open, and that it leaves alone what it refuses or only reads.
// Covers: master/store/sqlite_connection.cc, master/store/sqlite_schema.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <filesystem>

#include "master/store/sqlite_store.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

Result<std::unique_ptr<SqliteStore>> OpenAs(const std::string& path, bool read_only) {
  return read_only ? SqliteStore::OpenReadOnly(path) : SqliteStore::Open(path, {});
}

void Execute(const std::string& path, const std::string& sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  sqlite3_close(db);
}

// Read-only and for writing.
class StoreOpenTest : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    CreateStoreWithSearch(path_);
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(path_, {});
    ASSERT_TRUE(store.ok());
    for (RunId id = 1; id <= 50; ++id) (*store)->AddRun(MakeRun(id));
    ASSERT_TRUE((*store)->Flush().ok());
  }
  void ExpectRefusal(ErrorKind kind, const std::vector<std::string>& said) {
    const std::string before = ContentOf(scratch_.path());
    Result<std::unique_ptr<SqliteStore>> store = OpenAs(path_, GetParam());
    ASSERT_FALSE(store.ok());
    EXPECT_EQ(store.error().kind, kind) << store.error().message;
    EXPECT_THAT(store.error().message, HasSubstr(path_));
    for (const std::string& part : said) EXPECT_THAT(store.error().message, HasSubstr(part));
    EXPECT_TRUE(ContentOf(scratch_.path()) == before) << "a refused database was changed";
  }

  ScratchDirectory scratch_;
  std::string path_ = scratch_ / "campaign.db";
};

INSTANTIATE_TEST_SUITE_P(Both, StoreOpenTest, testing::Bool(), [](const testing::TestParamInfo<bool>& mode) {
  return mode.param ? "ReadOnly" : "ForWriting";
});

TEST_P(StoreOpenTest, ReadsWhatWasWritten) {
  Result<std::unique_ptr<SqliteStore>> store = OpenAs(path_, GetParam());
  ASSERT_TRUE(store.ok()) << store.error().message;
  EXPECT_EQ(RunsOf(**store).size(), 50u);
}

TEST_P(StoreOpenTest, AMissingFileIsNotFoundAndNotMade) {
  std::filesystem::remove(path_);
  Result<std::unique_ptr<SqliteStore>> store = OpenAs(path_, GetParam());
  ASSERT_FALSE(store.ok());
  EXPECT_EQ(store.error().kind, ErrorKind::kNotFound);
  EXPECT_TRUE(std::filesystem::is_empty(scratch_.path()));
}

TEST_P(StoreOpenTest, ANewerFormatIsRefusedNamingBothVersions) {
  Execute(path_, "PRAGMA user_version = 999");
  ExpectRefusal(ErrorKind::kVersion, {"format 999", "newer gauntlet", "reads format 3"});
}

TEST_P(StoreOpenTest, AnOlderFormatIsRefusedNamingBothVersions) {
  Execute(path_, "PRAGMA user_version = 2");
  ExpectRefusal(ErrorKind::kVersion, {"format 2", "older gauntlet", "reads format 3"});
}

TEST_P(StoreOpenTest, AnotherProgramsDatabaseIsRefused) {
  Execute(path_, "PRAGMA application_id = 1");
  ExpectRefusal(ErrorKind::kInvalidInput, {"not a campaign's"});
}

TEST_P(StoreOpenTest, TextIsNoDatabase) {
  WriteFile(
      path_,
      "this is not a database, but a text that is longer than a header of one hundred bytes, which is what "
      "a database begins with");
  ExpectRefusal(ErrorKind::kCorrupt, {"damaged", "does not begin like a database"});
}

TEST_P(StoreOpenTest, AnEmptyFileIsNoDatabase) {
  WriteFile(path_, "");
  ExpectRefusal(ErrorKind::kCorrupt, {"damaged"});
}

TEST_P(StoreOpenTest, OverwrittenPagesAreFound) {
  std::string bytes = ReadFile(path_);
  ASSERT_GT(bytes.size(), 40000u);
  bytes.replace(16384, 8192, std::string(8192, '\x5a'));
  WriteFile(path_, bytes);
  ExpectRefusal(ErrorKind::kCorrupt, {"damaged", "left as it is"});
}

TEST_P(StoreOpenTest, ATruncatedFileIsFound) {
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 8192);
  ExpectRefusal(ErrorKind::kCorrupt, {"damaged"});
}

TEST_P(StoreOpenTest, AMissingTableIsFound) {
  Execute(path_, "DROP TABLE states");
  Result<std::unique_ptr<SqliteStore>> store = OpenAs(path_, GetParam());
  ASSERT_FALSE(store.ok());
  EXPECT_EQ(store.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(store.error().message, HasSubstr("states"));
}

// Whatever bytes are overwritten: the store opens or refuses, and a refused file stays as it is.
RC_GTEST_PROP(DamagedStoreTest, NeverCrashesAndNeverRepairsInSilence, ()) {
  static const std::string whole = [] {
    const ScratchDirectory scratch;
    CreateStoreWithSearch(scratch / "campaign.db");
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(scratch / "campaign.db", {});
    for (RunId id = 1; id <= 20; ++id) (*store)->AddRun(MakeRun(id));
    store->reset();
    return ReadFile(scratch / "campaign.db");
  }();
  std::string bytes = whole;
  const auto hits = *rc::gen::inRange(1, 20);
  for (int hit = 0; hit < hits; ++hit) {
    const auto place = *rc::gen::inRange<std::size_t>(0, bytes.size());
    bytes[place] = *rc::gen::arbitrary<char>();
  }
  const ScratchDirectory scratch;
  WriteFile(scratch / "campaign.db", bytes);
  Result<std::unique_ptr<SqliteStore>> store = SqliteStore::OpenReadOnly(scratch / "campaign.db");
  if (store.ok()) {
    (void)(*store)->ForEachRun(1, 0, [](const StoredRun&) { return Ok{}; });
    (void)(*store)->LoadNewestState(1);
    (void)(*store)->LoadIndividuals(1);
  }
  RC_ASSERT(ReadFile(scratch / "campaign.db") == bytes);
  RC_ASSERT(!std::filesystem::exists(scratch / "campaign.db-wal"));
}

TEST(StoreCreateTest, AnExistingFileIsNeverReplaced) {
  const ScratchDirectory scratch;
  CreateStoreWithSearch(scratch / "campaign.db");
  const std::string before = ContentOf(scratch.path());
  const Status again = CreateDatabase(scratch / "campaign.db", MakeMeta());
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().kind, ErrorKind::kInUse);
  EXPECT_TRUE(ContentOf(scratch.path()) == before);
}

TEST(StoreCreateTest, ADraftOfAKilledMasterIsNoObstacle) {
  const ScratchDirectory scratch;
  WriteFile(scratch / "campaign.db.new", "half a database");
  WriteFile(scratch / "campaign.db.new-wal", "half a log");
  ASSERT_TRUE(CreateDatabase(scratch / "campaign.db", MakeMeta()).ok());
  EXPECT_TRUE(SqliteStore::Open(scratch / "campaign.db", {}).ok());
  EXPECT_FALSE(std::filesystem::exists(scratch / "campaign.db.new"));
}

TEST(StoreCreateTest, AMissingDirectoryIsAnErrorWithItsPath) {
  const Status created = CreateDatabase("/nonexistent/campaign.db", MakeMeta());
  ASSERT_FALSE(created.ok());
  EXPECT_EQ(created.error().message,
            "/nonexistent/campaign.db.new: unable to open database file (No such file or directory)");
}

TEST(StoreCreateTest, PathsMayHoldWhatUrisMayNot) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "100% of ?what# ü";
  std::filesystem::create_directory(path);
  ASSERT_TRUE(CreateDatabase(path + "/campaign.db", MakeMeta()).ok());
  EXPECT_TRUE(SqliteStore::Open(path + "/campaign.db", {}).ok());
  EXPECT_TRUE(SqliteStore::OpenReadOnly("/" + path + "/campaign.db").ok());
}

TEST(StoreCloseTest, ACleanEndLeavesOneFile) {
  const ScratchDirectory scratch;
  CreateStoreWithSearch(scratch / "campaign.db");
  EXPECT_FALSE(std::filesystem::exists(scratch / "campaign.db-wal"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "campaign.db-shm"));
}

TEST(ReadOnlyStoreTest, AddingIsABrokenInvariant) {
  const ScratchDirectory scratch;
  CreateStoreWithSearch(scratch / "campaign.db");
  Result<std::unique_ptr<SqliteStore>> store = SqliteStore::OpenReadOnly(scratch / "campaign.db");
  ASSERT_TRUE(store.ok());
  EXPECT_EQ((*store)->CommitNotifier(), -1);
  EXPECT_TRUE((*store)->Flush().ok());
  EXPECT_DEATH((*store)->AddRun(MakeRun(1)), "opened for reading");
}

}  // namespace
}  // namespace gauntlet
