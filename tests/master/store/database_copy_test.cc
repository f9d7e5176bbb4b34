// A database is copied while it is written: whole, or not at all.
#include "master/store/database_copy.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

class DatabaseCopyTest : public testing::Test {
 protected:
  void SetUp() override {
    CreateStoreWithSearch(path_);
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(path_, {});
    ASSERT_TRUE(store.ok());
    store_ = *std::move(store);
  }
  void Store(RunId first, RunId last) {
    for (RunId id = first; id <= last; ++id) store_->AddRun(MakeRun(id));
    ASSERT_TRUE(store_->Flush().ok());
  }
  std::size_t RunsIn(const std::string& path) {
    const Result<std::unique_ptr<SqliteStore>> copy = SqliteStore::OpenReadOnly(path);
    EXPECT_TRUE(copy.ok()) << copy.error().message;
    return copy.ok() ? RunsOf(**copy).size() : 0;
  }

  ScratchDirectory scratch_;
  std::string path_ = scratch_ / "campaign.db";
  std::string to_ = scratch_ / "it's a copy.db";
  std::unique_ptr<SqliteStore> store_;
};

TEST_F(DatabaseCopyTest, HoldsWhatWasCommitted) {
  DatabaseCopy copy;
  Store(1, 30);
  ASSERT_TRUE(copy.Make(path_, to_).ok());
  Store(31, 50);
  EXPECT_EQ(RunsIn(to_), 30U);
  ASSERT_TRUE(copy.Make(path_, to_).ok());
  EXPECT_EQ(RunsIn(to_), 50U);
}

TEST_F(DatabaseCopyTest, NeitherWaitsForTheOther) {
  std::thread copies([this] {
    DatabaseCopy copy;
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(copy.Make(path_, to_).ok());
  });
  Store(1, 2000);
  copies.join();
  EXPECT_LE(RunsIn(to_), 2000U);
}

TEST_F(DatabaseCopyTest, WhatCannotBeMadeLeavesTheFormerOneAndNoDraft) {
  DatabaseCopy copy;
  Store(1, 10);
  ASSERT_TRUE(copy.Make(path_, to_).ok());
  std::filesystem::create_directory(to_ + ".new");
  EXPECT_FALSE(copy.Make(path_, to_).ok());
  std::filesystem::remove(to_ + ".new");
  EXPECT_FALSE(copy.Make(scratch_ / "none.db", to_).ok());
  copy.Cancel();
  EXPECT_FALSE(copy.Make(path_, to_).ok());
  EXPECT_EQ(RunsIn(to_), 10U);
  EXPECT_FALSE(std::filesystem::exists(to_ + ".new"));
}

}  // namespace
}  // namespace gauntlet
