// Groups, acknowledgement, back-pressure and the guard.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "master/store/sqlite_store.h"
#include "tests/master/store/fault_vfs.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

// A guard that holds up commits until it is opened, and knows how many stand or stood before it.
class Gate {
 public:
  Status Pass() {
    std::unique_lock lock(mutex_);
    ++arrived_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return open_; });
    return Ok{};
  }
  void WaitForArrival() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return arrived_ > 0; });
  }
  void Open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int arrived_ = 0;
  bool open_ = false;
};

class StoreCommitTest : public testing::Test {
 protected:
  void SetUp() override { CreateStoreWithSearch(path_); }
  void Open(std::function<Status()> guard = nullptr) {
    SqliteStore::Options options;
    options.guard = std::move(guard);
    options.vfs = vfs_.name();
    Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(path_, std::move(options));
    ASSERT_TRUE(store.ok()) << store.error().message;
    store_ = *std::move(store);
  }
  bool Notified(std::chrono::milliseconds timeout) {
    pollfd waiting{store_->CommitNotifier(), POLLIN, 0};
    return poll(&waiting, 1, static_cast<int>(timeout.count())) == 1;
  }

  ScratchDirectory scratch_;
  std::string path_ = scratch_ / "campaign.db";
  FaultVfs vfs_;
  Gate gate_;  // before the store, whose end commits once more
  std::unique_ptr<SqliteStore> store_;
};

TEST_F(StoreCommitTest, CommitsAreReportedOnceInTheOrderOfTheirArrival) {
  Open();
  std::vector<RunId> expected;
  for (const RunId id : {5, 3, 4, 1, 2}) {
    store_->AddRun(MakeRun(id));
    expected.push_back(id);
  }
  ASSERT_TRUE(store_->Flush().ok());
  Result<std::vector<RunId>> committed = store_->Committed();
  ASSERT_TRUE(committed.ok());
  EXPECT_EQ(*committed, expected);
  committed = store_->Committed();
  ASSERT_TRUE(committed.ok());
  EXPECT_THAT(*committed, testing::IsEmpty());
}

TEST_F(StoreCommitTest, TheNotifierSaysWhenARunIsDurableWithoutAFlush) {
  Open();
  EXPECT_FALSE(Notified(std::chrono::milliseconds(0)));
  store_->AddRun(MakeRun(1));
  ASSERT_TRUE(Notified(std::chrono::seconds(20)));
  Result<std::vector<RunId>> committed = store_->Committed();
  ASSERT_TRUE(committed.ok());
  EXPECT_THAT(*committed, testing::ElementsAre(1));
  EXPECT_FALSE(Notified(std::chrono::milliseconds(0)));
}

TEST_F(StoreCommitTest, OneCommitIsOneSync) {
  Open();
  const std::int64_t before = vfs_.syncs("campaign.db-wal");
  const std::uint64_t commits_before = store_->Commits();
  constexpr int kGroups = 25;
  for (RunId id = 1; id <= kGroups; ++id) {
    store_->AddRun(MakeRun(id));
    ASSERT_TRUE(store_->Flush().ok());
  }
  EXPECT_EQ(store_->Commits() - commits_before, std::uint64_t{kGroups});
  // One more for the header of a new log.
  EXPECT_EQ(vfs_.syncs("campaign.db-wal") - before, kGroups + 1);
  EXPECT_EQ(vfs_.syncs("campaign.db"), 0) << "no checkpoint was due";
}

TEST_F(StoreCommitTest, WhatArrivesDuringACommitSharesTheNextUpTo512Runs) {
  Open([this] { return gate_.Pass(); });
  store_->AddRun(MakeRun(1));
  gate_.WaitForArrival();
  for (RunId id = 2; id <= 1501; ++id) store_->AddRun(MakeRun(id));
  gate_.Open();
  ASSERT_TRUE(store_->Flush().ok());
  EXPECT_EQ(store_->Commits(), 1u + 3u) << "1 run, then 512 + 512 + 476";
  Result<std::vector<RunId>> committed = store_->Committed();
  ASSERT_TRUE(committed.ok());
  EXPECT_EQ(committed->size(), 1501u);
}

TEST_F(StoreCommitTest, AGroupIsWaitedForUnlessSomebodyIsInAHurry) {
  SqliteStore::Options options;
  options.longest_wait = std::chrono::hours(1);
  Result<std::unique_ptr<SqliteStore>> store = SqliteStore::Open(path_, std::move(options));
  ASSERT_TRUE(store.ok()) << store.error().message;
  store_ = *std::move(store);
  for (RunId id = 1; id <= 3; ++id) store_->AddRun(MakeRun(id));
  EXPECT_FALSE(Notified(std::chrono::milliseconds(50)));
  store_->CommitWithin(std::chrono::milliseconds(0));
  ASSERT_TRUE(Notified(std::chrono::seconds(20)));
  EXPECT_EQ(store_->Commits(), 1u);
  for (RunId id = 4; id <= 3 + SqliteStore::kLargestGroup; ++id) store_->AddRun(MakeRun(id, 10));
  ASSERT_TRUE(store_->Committed().ok());
  ASSERT_TRUE(Notified(std::chrono::seconds(20))) << "a full group does not wait";
  EXPECT_EQ(store_->Commits(), 2u);
}

TEST_F(StoreCommitTest, NothingIsAcknowledgedBeforeItsCommit) {
  Open([this] { return gate_.Pass(); });
  store_->AddRun(MakeRun(1));
  gate_.WaitForArrival();
  Result<std::vector<RunId>> committed = store_->Committed();
  ASSERT_TRUE(committed.ok());
  EXPECT_THAT(*committed, testing::IsEmpty());
  gate_.Open();
  ASSERT_TRUE(store_->Flush().ok());
  committed = store_->Committed();
  ASSERT_TRUE(committed.ok());
  EXPECT_THAT(*committed, testing::ElementsAre(1));
}

TEST_F(StoreCommitTest, AFullQueueHoldsUpWhoeverFillsIt) {
  Open([this] { return gate_.Pass(); });
  store_->AddRun(MakeRun(1));
  gate_.WaitForArrival();
  constexpr RunId kMore = SqliteStore::kLargestQueue + 100;
  std::atomic<std::size_t> added = 0;
  std::thread adding([this, &added] {
    for (RunId id = 2; id < 2 + kMore; ++id) {
      store_->AddRun(MakeRun(id, 10));
      ++added;
    }
  });
  while (added < SqliteStore::kLargestQueue) std::this_thread::yield();
  EXPECT_FALSE(Notified(std::chrono::milliseconds(50))) << "nothing can be committed behind a closed gate";
  EXPECT_EQ(added, SqliteStore::kLargestQueue);
  gate_.Open();
  adding.join();
  ASSERT_TRUE(store_->Flush().ok());
  Result<std::vector<RunId>> committed = store_->Committed();
  ASSERT_TRUE(committed.ok());
  EXPECT_EQ(committed->size(), kMore + 1);
}

TEST_F(StoreCommitTest, ClosingCommitsWhatStillWaits) {
  Open();
  for (RunId id = 1; id <= 2000; ++id) store_->AddRun(MakeRun(id, 10));
  store_.reset();
  Open();
  EXPECT_EQ(RunsOf(*store_).size(), 2000u);
}

TEST_F(StoreCommitTest, AGuardThatRefusesStopsTheStoreForGood) {
  std::atomic<bool> taken_over = false;
  Open([&taken_over]() -> Status {
    if (taken_over) return Error{ErrorKind::kInUse, "a newer master has taken over"};
    return Ok{};
  });
  store_->AddRun(MakeRun(1));
  ASSERT_TRUE(store_->Flush().ok());
  taken_over = true;
  const std::size_t position = vfs_.position();
  store_->AddRun(MakeRun(2));
  Status flushed = store_->Flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_EQ(flushed.error().kind, ErrorKind::kInUse);
  EXPECT_EQ(flushed.error().message, "a newer master has taken over");

  taken_over = false;  // too late
  store_->AddRun(MakeRun(3));
  flushed = store_->Flush();
  ASSERT_FALSE(flushed.ok());
  Result<std::vector<RunId>> committed = store_->Committed();
  ASSERT_TRUE(committed.ok()) << "what was durable before the failure is still reported";
  EXPECT_THAT(*committed, testing::ElementsAre(1));
  EXPECT_TRUE(Notified(std::chrono::milliseconds(0))) << "there is an error to fetch";
  for (int time = 0; time < 2; ++time) {
    committed = store_->Committed();
    ASSERT_FALSE(committed.ok());
    EXPECT_EQ(committed.error().kind, ErrorKind::kInUse);
  }
  EXPECT_EQ(RunsOf(*store_).size(), 1u) << "what is durable stays readable";
  store_.reset();
  EXPECT_EQ(vfs_.position(), position) << "a store that lost its campaign wrote to it";
}

// A frozen master that wakes up only to end must not move its log into a database that is no longer its own.
TEST_F(StoreCommitTest, ClosingAsksTheGuardToo) {
  std::atomic<bool> taken_over = false;
  Open([&taken_over]() -> Status {
    if (taken_over) return Error{ErrorKind::kInUse, "a newer master has taken over"};
    return Ok{};
  });
  store_->AddRun(MakeRun(1));
  ASSERT_TRUE(store_->Flush().ok());
  taken_over = true;
  const std::string before = ContentOf(scratch_.path());
  store_.reset();
  EXPECT_TRUE(ContentOf(scratch_.path()) == before);
}

}  // namespace
}  // namespace gauntlet
