#include "master/directory/campaign_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/master/store/store_records.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class CampaignLockTest : public testing::Test {
 protected:
  LockOptions Options(int patience_ms = 0) {
    LockOptions options;
    options.unix_time = [this] { return now_; };
    options.heartbeat_every = std::chrono::milliseconds(0);
    options.patience = std::chrono::milliseconds(patience_ms);
    return options;
  }
  Result<std::unique_ptr<CampaignLock>> Acquire() { return CampaignLock::Acquire(path_, "camp", Options()); }
  Result<std::unique_ptr<CampaignLock>> Read() {
    return CampaignLock::AcquireForReading(path_, "camp", Options());
  }

  // What a former owner has left: this process, changed by `changes`.
  void LeaveOwner(const json& changes, std::int64_t heartbeat) {
    WriteFile(path_, Owner(changes, heartbeat));
  }
  std::string Owner(const json& changes, std::int64_t heartbeat) {
    const ProcessIdentity self = IdentifyThisProcess();
    json owner = {{"format", 1},
                  {"host", self.host},
                  {"boot_id", self.boot_id},
                  {"pid_namespace", self.pid_namespace},
                  {"pid", self.pid},
                  {"start_time", self.start_time},
                  {"heartbeat", heartbeat}};
    owner.update(changes);
    return owner.dump();
  }

  // What the lock file says.
  json OwnerNow() const { return json::parse(ReadFile(path_), nullptr, /*allow_exceptions=*/false); }

  ScratchDirectory scratch_;
  std::string path_ = scratch_ / "lock";
  std::int64_t now_ = 1000000;
};

const json kElsewhere = {{"host", "node17"}, {"pid", 4711}, {"boot_id", "another"}};

TEST_F(CampaignLockTest, NamesItsOwner) {
  Result<std::unique_ptr<CampaignLock>> lock = Acquire();
  ASSERT_TRUE(lock.ok()) << lock.error().message;
  EXPECT_EQ(OwnerNow(), json::parse(Owner(json::object(), now_)));
  EXPECT_EQ(OwnerNow()["pid"], getpid());
}

TEST_F(CampaignLockTest, ALivingOwnerIsNamedWithHostAndPid) {
  Result<std::unique_ptr<CampaignLock>> lock = Acquire();
  ASSERT_TRUE(lock.ok());
  for (const bool reading : {false, true}) {
    Result<std::unique_ptr<CampaignLock>> second = reading ? Read() : Acquire();
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().kind, ErrorKind::kInUse);
    EXPECT_EQ(
        second.error().message,
        fmt::format(
            "campaign camp is in use by a living master (host {0}, pid {1}): `gauntlet status camp` says "
            "how it goes, `gauntlet stop camp` ends it",
            IdentifyThisProcess().host, getpid()));
  }
  EXPECT_EQ(OwnerNow(), json::parse(Owner(json::object(), now_))) << "a refused one changed the lock";
}

TEST_F(CampaignLockTest, ALivingOwnerIsNeverStale) {
  Result<std::unique_ptr<CampaignLock>> lock = Acquire();
  now_ += 1000000;  // frozen, or busy, for days
  EXPECT_FALSE(Acquire().ok());
}

TEST_F(CampaignLockTest, IsFreeAfterItsRelease) {
  ASSERT_TRUE(Acquire().ok());
  EXPECT_EQ(ReadFile(path_), "");
  EXPECT_TRUE(std::filesystem::exists(path_));
  EXPECT_TRUE(Acquire().ok());
}

TEST_F(CampaignLockTest, IsTakenFromAProcessThatIsGone) {
  // A pid that is in use, by another process than the one that took the lock.
  LeaveOwner({{"start_time", 1}}, now_);
  EXPECT_TRUE(Acquire().ok());
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  LeaveOwner({{"pid", child}}, now_);
  EXPECT_TRUE(Read().ok());
  EXPECT_TRUE(Acquire().ok());
}

// On a file system where flock does not reach, the name alone must keep others away.
TEST_F(CampaignLockTest, TheNameOfALivingProcessIsEnough) {
  LeaveOwner(json::object(), now_);
  EXPECT_FALSE(Acquire().ok());
  EXPECT_FALSE(Read().ok());
}

// A campaign that was copied while its master lived: nobody holds the copy, whatever its lock file says.
TEST_F(CampaignLockTest, TheOwnerOfTheOriginalDoesNotKeepACopyFromBeingTaken) {
  LockOptions options = Options();
  options.is_copy = [] { return true; };
  LeaveOwner(json::object(), now_);
  EXPECT_TRUE(CampaignLock::AcquireForReading(path_, "camp", options).ok());
  const Result<std::unique_ptr<CampaignLock>> first = CampaignLock::Acquire(path_, "camp", options);
  EXPECT_TRUE(first.ok());
  // Whoever has taken the copy holds it, also as long as it still looks like one.
  EXPECT_EQ(CampaignLock::Acquire(path_, "camp", options).error().kind, ErrorKind::kInUse);
  EXPECT_EQ(CampaignLock::AcquireForReading(path_, "camp", options).error().kind, ErrorKind::kInUse);
}

// Locks of another host may not be seen here: its master is believed, wherever the file came from.
TEST_F(CampaignLockTest, AnOwnerElsewhereKeepsACopyUntilItIsStale) {
  LockOptions options = Options();
  options.is_copy = [] { return true; };
  LeaveOwner(kElsewhere, now_ - 59);
  EXPECT_FALSE(CampaignLock::Acquire(path_, "camp", options).ok());
  ++now_;
  EXPECT_TRUE(CampaignLock::Acquire(path_, "camp", options).ok());
}

TEST_F(CampaignLockTest, AnOwnerElsewhereCountsAsDeadAfterAMinute) {
  LeaveOwner(kElsewhere, now_ - 59);
  for (const bool reading : {false, true}) {
    Result<std::unique_ptr<CampaignLock>> lock = reading ? Read() : Acquire();
    ASSERT_FALSE(lock.ok());
    EXPECT_EQ(lock.error().kind, ErrorKind::kInUse);
    EXPECT_EQ(lock.error().message,
              "campaign camp is in use by a master elsewhere (host node17, pid 4711, last sign of life 59 s "
              "ago; it counts as dead after 60 s without one); stop it there with Ctrl-C or `kill 4711`");
    EXPECT_THAT(lock.error().message, HasSubstr("60 s"));
  }
  ++now_;
  EXPECT_TRUE(Read().ok());
  EXPECT_TRUE(Acquire().ok());
}

TEST_F(CampaignLockTest, AnOwnerElsewhereWhoseClockWasAheadCountsAsDeadWhenItBeatsNoMore) {
  LockOptions options = Options();
  options.beat_patience = std::chrono::milliseconds(1);
  LeaveOwner(kElsewhere, now_ + 59);
  EXPECT_FALSE(CampaignLock::Acquire(path_, "camp", options).ok()) << "clocks differ a little everywhere";
  LeaveOwner(kElsewhere, now_ + 3600);
  EXPECT_FALSE(Read().ok()) << "whoever reads does not wait that long";
  EXPECT_TRUE(CampaignLock::Acquire(path_, "camp", options).ok());
}

TEST_F(CampaignLockTest, AnOwnerElsewhereWhoseClockIsAheadKeepsTheLockWhileItBeats) {
  LockOptions options = Options();
  options.beat_patience = testing_support::kPatience;
  LeaveOwner(kElsewhere, now_ + 3600);
  std::jthread beating([this](const std::stop_token& stop) {
    const int fd = open(path_.c_str(), O_WRONLY);
    for (int beat = 1; !stop.stop_requested(); ++beat) {
      const std::string content = Owner(kElsewhere, now_ + 3600 + beat);  // always of one length
      EXPECT_EQ(pwrite(fd, content.data(), content.size(), 0), static_cast<ssize_t>(content.size()));
    }
    close(fd);
  });
  EXPECT_FALSE(CampaignLock::Acquire(path_, "camp", options).ok());
}

TEST_F(CampaignLockTest, AFrozenOwnerHereIsNoneWhoseClockWasAhead) {
  LockOptions options = Options();
  options.beat_patience = std::chrono::milliseconds(1);
  LeaveOwner(json::object(), now_ + 3600);
  EXPECT_FALSE(CampaignLock::Acquire(path_, "camp", options).ok()) << "the process lives";
}

TEST_F(CampaignLockTest, AnotherPidNamespaceIsElsewhere) {
  LeaveOwner({{"pid_namespace", "pid:[1]"}, {"pid", 4194304}}, now_);
  EXPECT_FALSE(Acquire().ok()) << "its pid says nothing here";
  now_ += 60;
  EXPECT_TRUE(Acquire().ok());
}

TEST_F(CampaignLockTest, GarbageNamesNobody) {
  for (const std::string content :
       {"", "{", "[]", "{}", R"({"pid": "x", "host": 5})", R"({"pid": -1, "host": "h"})"}) {
    WriteFile(path_, content);
    Result<std::unique_ptr<CampaignLock>> lock = Acquire();
    EXPECT_TRUE(lock.ok()) << content;
  }
}

TEST_F(CampaignLockTest, HeartbeatsRenewTheSignOfLife) {
  Result<std::unique_ptr<CampaignLock>> lock = Acquire();
  ASSERT_TRUE(lock.ok());
  now_ += 7;
  ASSERT_TRUE((*lock)->Heartbeat().ok());
  EXPECT_EQ(OwnerNow(), json::parse(Owner(json::object(), now_)));
}

TEST_F(CampaignLockTest, BeatsByItself) {
  std::atomic<std::int64_t> calls = 0;
  LockOptions options;
  options.unix_time = [&calls] { return ++calls; };
  options.heartbeat_every = std::chrono::milliseconds(1);
  Result<std::unique_ptr<CampaignLock>> lock = CampaignLock::Acquire(path_, "camp", options);
  ASSERT_TRUE(lock.ok());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (OwnerNow()["heartbeat"] < 5 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_GE(OwnerNow()["heartbeat"], 5);
}

TEST_F(CampaignLockTest, AMasterThatWasTakenForDeadLearnsIt) {
  Result<std::unique_ptr<CampaignLock>> lock = Acquire();
  ASSERT_TRUE(lock.ok());
  EXPECT_TRUE((*lock)->Check().ok());
  LeaveOwner(kElsewhere, now_);
  EXPECT_TRUE((*lock)->Check().ok()) << "checking costs no look at the file";
  Status beaten = (*lock)->Heartbeat();
  ASSERT_FALSE(beaten.ok());
  EXPECT_EQ(beaten.error().kind, ErrorKind::kInUse);
  EXPECT_EQ(beaten.error().message,
            "campaign camp was taken over by another master (host node17, pid 4711) while this one gave no "
            "sign of life; this one stops");
  EXPECT_FALSE((*lock)->Check().ok());
  lock->reset();
  EXPECT_EQ(OwnerNow()["host"], "node17") << "the loser released the winner's lock";
}

TEST_F(CampaignLockTest, AMasterWhoseSuccessorHasEndedLearnsItToo) {
  Result<std::unique_ptr<CampaignLock>> lock = Acquire();
  ASSERT_TRUE(lock.ok());
  WriteFile(path_, "");
  EXPECT_FALSE((*lock)->Heartbeat().ok());
  EXPECT_EQ(ReadFile(path_), "");
}

TEST_F(CampaignLockTest, ReadersShareItAndChangeNothing) {
  ASSERT_TRUE(Acquire().ok());
  LeaveOwner({{"start_time", 1}}, now_);
  const std::string before = ReadFile(path_);
  {
    Result<std::unique_ptr<CampaignLock>> first = Read();
    Result<std::unique_ptr<CampaignLock>> second = Read();
    ASSERT_TRUE(first.ok());
    ASSERT_TRUE(second.ok());
    Result<std::unique_ptr<CampaignLock>> master = Acquire();
    ASSERT_FALSE(master.ok());
    EXPECT_EQ(master.error().kind, ErrorKind::kInUse);
    EXPECT_THAT(master.error().message, HasSubstr("which reads it"));
  }
  EXPECT_EQ(ReadFile(path_), before);
  EXPECT_TRUE(Acquire().ok());
}

TEST_F(CampaignLockTest, AMasterWaitsForReaders) {
  ASSERT_TRUE(Acquire().ok());
  Result<std::unique_ptr<CampaignLock>> reader = Read();
  ASSERT_TRUE(reader.ok());
  std::thread leaving([&reader] { reader->reset(); });
  Result<std::unique_ptr<CampaignLock>> master = CampaignLock::Acquire(path_, "camp", Options(20000));
  EXPECT_TRUE(master.ok());
  leaving.join();
}

TEST_F(CampaignLockTest, AMasterThatIsToldToStopWaitsForNobody) {
  ASSERT_TRUE(Acquire().ok());
  const Result<std::unique_ptr<CampaignLock>> reader = Read();
  ASSERT_TRUE(reader.ok());
  LockOptions options = Options(1000 * static_cast<int>(testing_support::kPatience.count()));
  int asked = 0;
  options.give_up = [&asked] { return ++asked == 3; };
  const Result<std::unique_ptr<CampaignLock>> master = CampaignLock::Acquire(path_, "camp", options);
  ASSERT_FALSE(master.ok());
  EXPECT_EQ(master.error().kind, ErrorKind::kInUse);
  EXPECT_EQ(master.error().message,
            "campaign camp is held by another process, and this one was told to stop while it waited for it; "
            "nothing was changed");
  EXPECT_EQ(asked, 3);
}

TEST_F(CampaignLockTest, ReadingNeedsNoLockFile) {
  EXPECT_TRUE(Read().ok());
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(CampaignLockTest, AMissingDirectoryIsAnErrorWithItsPath) {
  Result<std::unique_ptr<CampaignLock>> lock = CampaignLock::Acquire("/nonexistent/lock", "camp", Options());
  ASSERT_FALSE(lock.ok());
  EXPECT_EQ(lock.error().message, "cannot open /nonexistent/lock: No such file or directory");
}

}  // namespace
}  // namespace gauntlet
