#include "master/directory/campaign_ownership.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

class CampaignOwnershipTest : public testing::Test {
 protected:
  Result<CampaignOwnership> Create() {
    return CreateCampaign(dir_, {"seed = 1\n"}, {"", "0.1.0", "cafe", 0});
  }
  // A child that does `work` and is killed once it has written a byte.
  template <typename Work>
  void Kill(const Work& work) {
    std::array<int, 2> ready{};
    ASSERT_EQ(pipe(ready.data()), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      work();
      (void)!write(ready[1], "x", 1);
      pause();
      _exit(0);
    }
    char byte = 0;
    close(ready[1]);
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }

  ScratchDirectory scratch_;
  std::string dir_ = scratch_ / "campaign";
};

// What a campaign begins with, such as the cases of `evaluate`, is there when the campaign is, or neither is.
TEST_F(CampaignOwnershipTest, AMasterKilledWhileItFillsTheStoreLeavesNoCampaign) {
  const auto fill = [](ResultStore& store) -> Status {
    store.AddEvent({1, "start", "filled"});
    return Ok{};
  };
  const auto create = [&](const std::function<Status(ResultStore&)>& with) {
    return CreateCampaign(dir_, {"seed = 1\n"}, {"", "0.1.0", "cafe", 0}, with);
  };
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    (void)create([&](ResultStore& store) -> Status {
      if (fill(store) && store.Flush()) kill(getpid(), SIGKILL);
      return Ok{};
    });
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(std::filesystem::exists(dir_ + "/campaign.db"));
  EXPECT_FALSE(TakeCampaign(dir_).ok());
  {
    const Result<CampaignOwnership> made = create(fill);
    ASSERT_TRUE(made.ok()) << made.error().message;
  }
  const Result<CampaignView> view = ViewCampaign(dir_);
  ASSERT_TRUE(view.ok()) << view.error().message;
  const auto events = view->store->LoadEvents();
  ASSERT_TRUE(events.ok());
  ASSERT_EQ(events->size(), 1U);
  EXPECT_EQ(events->front().text, "filled");
}

TEST_F(CampaignOwnershipTest, ACampaignIsMadeTakenAndViewed) {
  std::string id;
  {
    Result<CampaignOwnership> made = Create();
    ASSERT_TRUE(made.ok()) << made.error().message;
    EXPECT_EQ(made->epoch, 1u);
    EXPECT_EQ(ReadFile(made->directory.experiment_path()), "seed = 1\n");
    id = made->store->meta().campaign_id;
    EXPECT_EQ(id.size(), 32u);
    EXPECT_EQ(made->store->meta().golden_hashes, "cafe");
    EXPECT_GT(made->store->meta().created_unix_ms, 1700000000000);
    made->store->AddSearch(MakeSearch(1));
    made->store->AddRun(MakeRun(1));
  }
  {
    Result<CampaignOwnership> taken = TakeCampaign(dir_);
    ASSERT_TRUE(taken.ok()) << taken.error().message;
    EXPECT_EQ(taken->epoch, 2u);
    EXPECT_EQ(taken->store->meta().campaign_id, id);
    EXPECT_EQ(RunsOf(*taken->store).size(), 1u);
  }
  Result<CampaignView> view = ViewCampaign(dir_);
  ASSERT_TRUE(view.ok()) << view.error().message;
  EXPECT_EQ(RunsOf(*view->store).size(), 1u);
}

TEST_F(CampaignOwnershipTest, OneMasterAtATime) {
  Result<CampaignOwnership> owner = Create();
  ASSERT_TRUE(owner.ok());
  const Result<CampaignOwnership> taken = TakeCampaign(dir_);
  ASSERT_FALSE(taken.ok());
  EXPECT_EQ(taken.error().kind, ErrorKind::kInUse);
  EXPECT_THAT(taken.error().message, HasSubstr(fmt::format("pid {}", getpid())));
  EXPECT_THAT(taken.error().message, HasSubstr(dir_));
  EXPECT_TRUE(owner->directory.CheckEpoch(1).ok()) << "a refused master counted an epoch";
}

// `stop` of a user who saw the former master is not for the next; one that comes while the next checks what
// is stored is.
TEST_F(CampaignOwnershipTest, WhatTheFormerMasterLeftIsGoneOnceTheNextHasTheCampaign) {
  std::string stop;
  std::string status;
  {
    const Result<CampaignOwnership> former = Create();
    ASSERT_TRUE(former.ok());
    stop = former->directory.stop_path();
    status = former->directory.status_path();
  }
  for (const std::string& path : {stop, status}) std::ofstream(path) << "{}";
  const Result<CampaignOwnership> next = TakeCampaign(dir_);
  ASSERT_TRUE(next.ok());
  EXPECT_FALSE(std::filesystem::exists(stop));
  EXPECT_FALSE(std::filesystem::exists(status));
}

TEST_F(CampaignOwnershipTest, AnExistingCampaignIsNotMadeAnew) {
  ASSERT_TRUE(Create().ok());
  Result<CampaignOwnership> again = Create();
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(again.error().message, HasSubstr("gauntlet resume " + dir_));
}

TEST_F(CampaignOwnershipTest, AfterAKillTheNextMasterGoesOn) {
  Kill([this] {
    Result<CampaignOwnership> owner = Create();
    owner->store->AddSearch(MakeSearch(1));
    for (RunId id = 1; id <= 20; ++id) owner->store->AddRun(MakeRun(id));
    if (!owner->store->Flush()) _exit(1);
    new CampaignOwnership(*std::move(owner));  // killed, not closed
  });
  ASSERT_TRUE(std::filesystem::file_size(dir_ + "/campaign.db-wal") > 0) << "the log was to be left behind";
  const std::string before = ContentOf(dir_);
  {
    Result<CampaignView> view = ViewCampaign(dir_);
    ASSERT_TRUE(view.ok()) << view.error().message;
    EXPECT_EQ(RunsOf(*view->store).size(), 20u);
  }
  EXPECT_TRUE(ContentOf(dir_) == before) << "looking changed the campaign";
  Result<CampaignOwnership> owner = TakeCampaign(dir_);
  ASSERT_TRUE(owner.ok()) << owner.error().message;
  EXPECT_EQ(owner->epoch, 2u);
  EXPECT_EQ(RunsOf(*owner->store).size(), 20u);
}

TEST_F(CampaignOwnershipTest, AMasterKilledWhileItMakesTheCampaignIsNoObstacle) {
  Kill([this] {
    Result<CampaignOwnership> owner = Create();
    new CampaignOwnership(*std::move(owner));
  });
  // As if it had been killed a moment before the database got its name; origin.json comes after it.
  std::filesystem::rename(dir_ + "/campaign.db", dir_ + "/campaign.db.new");
  for (const char* name : {"/campaign.db-wal", "/campaign.db-shm", "/origin.json"})
    std::filesystem::remove(dir_ + name);
  Result<CampaignOwnership> owner = Create();
  ASSERT_TRUE(owner.ok()) << owner.error().message;
}

TEST_F(CampaignOwnershipTest, ANewerEpochStopsTheOlderMaster) {
  Result<CampaignOwnership> owner = Create();
  ASSERT_TRUE(owner.ok());
  owner->store->AddSearch(MakeSearch(1));
  ASSERT_TRUE(owner->store->Flush().ok());
  // What a master does that takes this one for dead.
  ASSERT_TRUE(owner->directory.StartEpoch().ok());
  const std::string before = ContentOf(dir_);
  owner->store->AddRun(MakeRun(1));
  const Status flushed = owner->store->Flush();
  ASSERT_FALSE(flushed.ok());
  EXPECT_EQ(flushed.error().kind, ErrorKind::kInUse);
  EXPECT_THAT(flushed.error().message, HasSubstr("newer master"));
  owner->store.reset();
  EXPECT_TRUE(ContentOf(dir_) == before) << "the older master still wrote";
}

TEST_F(CampaignOwnershipTest, ANewerFormatIsLeftAsItIs) {
  ASSERT_TRUE(Create().ok());
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open((dir_ + "/campaign.db").c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, "PRAGMA user_version = 4", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(db);
  const std::string before = ReadFile(dir_ + "/campaign.db");
  const Result<CampaignOwnership> taken = TakeCampaign(dir_);
  const Result<CampaignView> view = ViewCampaign(dir_);
  ASSERT_FALSE(taken.ok());
  ASSERT_FALSE(view.ok());
  EXPECT_EQ(taken.error().kind, ErrorKind::kVersion);
  EXPECT_EQ(view.error().kind, ErrorKind::kVersion);
  EXPECT_TRUE(ReadFile(dir_ + "/campaign.db") == before);
  EXPECT_FALSE(std::filesystem::exists(dir_ + "/campaign.db-wal"));
}

// What a master writes into a file that has no name any more is lost.
TEST_F(CampaignOwnershipTest, NothingIsReportedAsStoredOnceTheFilesAreGone) {
  struct Case {
    std::string name;  // in the directory; "" is the directory itself
    bool replaced;
    const char* words;
  };
  for (const Case& attack :
       {Case{"", false, "is gone, deleted or moved away"}, Case{"", true, "another one has its name"},
        Case{"campaign.db", false, "What was stored is lost, unless there is a copy"},
        Case{"campaign.db", true, "campaign.db is gone, and another one has its name"},
        Case{"campaign.db-wal", false, "The runs that were stored last are lost"},
        Case{"campaign.db-wal", true, "-wal is gone, and another one has its name"},
        Case{"lock", false, "Another master may have begun"},
        Case{"lock", true, "lock is gone, and another one has its name"}}) {
    dir_ = scratch_ / fmt::format("campaign{}", attack.name + (attack.replaced ? "-replaced" : "-gone"));
    Result<CampaignOwnership> owner = Create();
    ASSERT_TRUE(owner.ok()) << owner.error().message;
    owner->store->AddSearch(MakeSearch(1));
    owner->store->AddRun(MakeRun(1));
    ASSERT_TRUE(owner->store->Flush().ok());
    ASSERT_TRUE(owner->check().ok());
    const std::string path = attack.name.empty() ? dir_ : dir_ + "/" + attack.name;
    std::filesystem::rename(path, scratch_ / "taken");
    if (attack.replaced)
      std::filesystem::copy(scratch_ / "taken", path, std::filesystem::copy_options::recursive);
    owner->store->AddRun(MakeRun(2));
    const Status flushed = owner->store->Flush();
    ASSERT_FALSE(flushed.ok()) << path;
    EXPECT_EQ(flushed.error().kind, ErrorKind::kNotFound) << path;
    EXPECT_THAT(flushed.error().message, HasSubstr(path));
    EXPECT_THAT(flushed.error().message, HasSubstr(attack.words));
    EXPECT_FALSE(owner->check().ok());
    std::filesystem::remove_all(scratch_ / "taken");
  }
}

TEST_F(CampaignOwnershipTest, AnEpochThatWasDeletedIsWrittenAgain) {
  { ASSERT_TRUE(Create().ok()); }
  Result<CampaignOwnership> owner = TakeCampaign(dir_);
  ASSERT_TRUE(owner.ok());
  std::filesystem::remove(dir_ + "/epoch");
  EXPECT_TRUE(owner->check().ok());
  EXPECT_EQ(ReadFile(dir_ + "/epoch"), "2\n");
}

TEST_F(CampaignOwnershipTest, IsTakenOnlyFromWhereNobodyElseWrites) {
  { ASSERT_TRUE(Create().ok()); }
  for (const std::string name : {"", "/campaign.db", "/experiment.toml", "/epoch"}) {
    const std::string path = dir_ + name;
    const std::filesystem::perms before = std::filesystem::status(path).permissions();
    std::filesystem::permissions(path, std::filesystem::perms::others_write,
                                 std::filesystem::perm_options::add);
    const Result<CampaignOwnership> taken = TakeCampaign(dir_);
    ASSERT_FALSE(taken.ok()) << path;
    EXPECT_EQ(taken.error().kind, ErrorKind::kInvalidInput);
    EXPECT_THAT(taken.error().message, HasSubstr("chmod go-w " + path));
    EXPECT_TRUE(ViewCampaign(dir_).ok()) << "looking executes nothing";
    std::filesystem::permissions(path, before);
  }
  EXPECT_TRUE(TakeCampaign(dir_).ok());
}

TEST_F(CampaignOwnershipTest, ACampaignCanBeMoved) {
  ASSERT_TRUE(Create().ok());
  std::filesystem::rename(dir_, scratch_ / "moved");
  EXPECT_TRUE(TakeCampaign(scratch_ / "moved").ok());
}

}  // namespace
}  // namespace gauntlet
