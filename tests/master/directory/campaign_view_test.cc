// Looking at a campaign beside its master: on the same machine, from another one, with fewer rights, and
// killed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "master/directory/campaign_ownership.h"
#include "master/store/database_copy.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

// A process that is forked at once, before anybody has a connection that it would share, and does its work
// when it is told to.
class Reader {
 public:
  explicit Reader(const std::function<int()>& work) {
    EXPECT_EQ(pipe(go_.data()), 0);
    child_ = fork();
    if (child_ == 0) {
      char byte = 0;
      close(go_[1]);
      _exit(read(go_[0], &byte, 1) == 1 ? work() : 0);
    }
    close(go_[0]);
  }
  ~Reader() {
    if (child_ > 0) (void)Work();
  }
  // What `work` has answered with, or kKilled.
  int Work() {
    EXPECT_EQ(write(go_[1], "x", 1), 1);
    close(go_[1]);
    int status = 0;
    EXPECT_EQ(waitpid(std::exchange(child_, -1), &status, 0) > 0, true);
    return WIFSIGNALED(status) ? kKilled : WEXITSTATUS(status);
  }
  static constexpr int kKilled = 99;

 private:
  std::array<int, 2> go_{};
  pid_t child_ = -1;
};

class CampaignViewTest : public testing::Test {
 protected:
  // A master that has stored 20 runs.
  void Serve() {
    chmod(scratch_.path().c_str(), 0755);
    Result<CampaignOwnership> made = CreateCampaign(dir_, {"seed = 1\n"}, {"", "0.1.0", "cafe", 0});
    ASSERT_TRUE(made.ok()) << made.error().message;
    owner_.emplace(*std::move(made));
    owner_->store->AddSearch(MakeSearch(1));
    Store(1, 20);
  }
  void Store(RunId first, RunId last) {
    for (RunId id = first; id <= last; ++id) owner_->store->AddRun(MakeRun(id));
    const Status flushed = owner_->store->Flush();
    ASSERT_TRUE(flushed.ok()) << flushed.error().message;
  }
  // 0: so many runs are seen; otherwise what went wrong stands on stderr.
  int Look(std::size_t runs) const {
    const Result<CampaignView> view = ViewCampaign(dir_);
    if (!view) {
      fmt::print(stderr, "{}\n", view.error().message);
      return 1;
    }
    return RunsOf(*view->store).size() == runs ? 0 : 2;
  }
  // As if the master were one of another machine.
  void NameForeignOwner() const {
    WriteFile(dir_ + "/lock",
              fmt::format(R"({{"format":1,"host":"node7","boot_id":"x","pid_namespace":"y","pid":4711,)"
                          R"("start_time":1,"heartbeat":{}}})",
                          std::time(nullptr)));
  }

  ScratchDirectory scratch_;
  std::string dir_ = scratch_ / "campaign";
  std::optional<CampaignOwnership> owner_;
};

TEST_F(CampaignViewTest, BesideAMasterItShowsWhatWasCommittedWhenItWasOpened) {
  Serve();
  Result<CampaignView> view = ViewCampaign(dir_);
  ASSERT_TRUE(view.ok()) << view.error().message;
  EXPECT_EQ(view->as_of, "");
  EXPECT_EQ(RunsOf(*view->store).size(), 20U);
  Store(21, 40);  // nobody waits for anybody
  EXPECT_EQ(RunsOf(*view->store).size(), 20U);
  const Result<CampaignView> later = ViewCampaign(dir_);
  ASSERT_TRUE(later.ok()) << later.error().message;
  EXPECT_EQ(RunsOf(*later->store).size(), 40U);
}

TEST_F(CampaignViewTest, FromAnotherProcessToo) {
  Reader first([this] { return Look(20); });
  Reader second([this] { return Look(40); });
  Serve();
  EXPECT_EQ(first.Work(), 0);
  Store(21, 40);
  EXPECT_EQ(second.Work(), 0);
}

TEST_F(CampaignViewTest, AKilledReaderLeavesNothingThatHurts) {
  Reader reader([this] {
    const Result<CampaignView> view = ViewCampaign(dir_);
    if (!view) return 1;
    kill(getpid(), SIGKILL);
    return 2;
  });
  Serve();
  EXPECT_EQ(reader.Work(), Reader::kKilled);
  Store(21, 40);
  owner_.reset();
  EXPECT_FALSE(std::filesystem::exists(dir_ + "/campaign.db-wal"))
      << "the log was not moved into the database";
  EXPECT_EQ(Look(40), 0);
}

TEST_F(CampaignViewTest, WhoMayOnlyReadSeesAsMuch) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  constexpr uid_t kNobody = 65534;
  const auto look = [this](std::size_t runs) {
    return [this, runs] { return setgid(kNobody) == 0 && setuid(kNobody) == 0 ? Look(runs) : 3; };
  };
  Reader beside(look(20));
  Reader beside_more(look(40));
  Reader afterwards(look(40));
  Serve();
  EXPECT_EQ(beside.Work(), 0);
  Store(21, 40);
  EXPECT_EQ(beside_more.Work(), 0);
  owner_.reset();
  EXPECT_EQ(afterwards.Work(), 0);
}

TEST_F(CampaignViewTest, TheShellOfSqliteReadsBesideTheMaster) {
  Reader shell([this] {
    sqlite3* db = nullptr;
    if (sqlite3_open((dir_ + "/campaign.db").c_str(), &db) != SQLITE_OK) return 1;
    int rows = 0;
    const auto take = [](void* into, int, char** row, char**) {
      *static_cast<int*>(into) = std::atoi(row[0]);
      return 0;
    };
    if (sqlite3_exec(db, "SELECT count(*) FROM runs", take, &rows, nullptr) != SQLITE_OK) return 2;
    sqlite3_close(db);
    return rows == 20 ? 0 : 3;
  });
  Serve();
  EXPECT_EQ(shell.Work(), 0);
  Store(21, 22);
}

TEST_F(CampaignViewTest, FromAnotherMachineItShowsTheSnapshot) {
  Serve();
  DatabaseCopy copy;
  const Status copied = copy.Make(owner_->directory.database_path(), owner_->directory.snapshot_path());
  ASSERT_TRUE(copied.ok()) << copied.error().message;
  Store(21, 40);
  owner_.reset();
  NameForeignOwner();
  const std::string before = ContentOf(dir_);
  {
    const Result<CampaignView> view = ViewCampaign(dir_);
    ASSERT_TRUE(view.ok()) << view.error().message;
    EXPECT_EQ(RunsOf(*view->store).size(), 20U) << "the database itself is not to be touched";
    EXPECT_THAT(view->as_of, testing::MatchesRegex("as of [0-9][0-9]:[0-9][0-9], on node7"));
  }
  EXPECT_TRUE(ContentOf(dir_) == before) << "looking changed the campaign";
}

TEST_F(CampaignViewTest, WithoutASnapshotItSaysWhoIsMasterAndWhatToDo) {
  Serve();
  owner_.reset();
  NameForeignOwner();
  const Result<CampaignView> view = ViewCampaign(dir_);
  ASSERT_FALSE(view.ok());
  EXPECT_EQ(view.error().kind, ErrorKind::kInUse);
  EXPECT_THAT(view.error().message, HasSubstr("host node7, pid 4711"));
  EXPECT_THAT(view.error().message, HasSubstr("try again in a moment"));
}

TEST_F(CampaignViewTest, TheNextMasterRemovesASnapshotThatIsLeft) {
  Serve();
  const std::string snapshot = owner_->directory.snapshot_path();
  owner_.reset();
  WriteFile(snapshot, "of a master that was killed");
  ASSERT_TRUE(TakeCampaign(dir_).ok());
  EXPECT_FALSE(std::filesystem::exists(snapshot));
}

}  // namespace
}  // namespace gauntlet
