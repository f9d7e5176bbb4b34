// Directories that somebody else has filled or may write: what stands there is data, never followed, never
// waited for, and obeyed only when nobody else can have written it.
// Covers: master/directory/campaign_keys.cc, master/directory/owned_files.cc
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "base/system/unique_fd.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr uid_t kStranger = 54321;
// Nothing here has to wait for anything; a machine that is busy with other tests is slow.
constexpr std::chrono::seconds kSoon{20};

void WriteTo(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// Whether the process has a handler of its own for the signal.
bool Catches(pid_t pid, int signal) {
  const std::string status = ReadFile(fmt::format("/proc/{}/status", pid));
  const std::size_t at = status.find("SigCgt:");
  if (at == std::string::npos) return false;
  return (std::stoull(status.substr(at + 7), nullptr, 16) >> (signal - 1) & 1U) != 0;
}

// A copy for each test of one campaign that was stopped half way.
class HostileDirectoryTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    stopped_ = new TemporaryDirectory;
    SmallCampaign campaign;
    campaign.generations = 24;
    const std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(campaign, *stopped_ / "c", 2));
    ASSERT_TRUE(RunsDone(*stopped_ / "c", 4)) << master->Err();
    master->Signal(SIGTERM);
    ASSERT_EQ(master->Wait().exit_code, 3);
  }
  static void TearDownTestSuite() {
    delete stopped_;
    stopped_ = nullptr;
  }
  HostileDirectoryTest() {
    fs::copy(*stopped_ / "c", dir_, fs::copy_options::recursive);
    WriteTo(scratch_ / "precious", "precious");
    fs::create_directory(scratch_ / "folder");
  }
  // A fake sbatch that tells when it is called, first in PATH.
  std::vector<std::string> WithSbatch() const {
    fs::create_directories(scratch_ / "bin");
    for (const std::string name : {"sbatch", "squeue", "scancel"}) {
      WriteTo(scratch_ / "bin/" + name, "#!/bin/sh\necho called >> " + scratch_ / "called" + "\n");
      chmod((scratch_ / "bin/" + name).c_str(), 0755);
    }
    return {"PATH=" + scratch_ / "bin" + ":/usr/bin:/bin"};
  }
  void ExpectNothingTouched() const {
    EXPECT_EQ(ReadFile(scratch_ / "precious"), "precious");
    EXPECT_TRUE(fs::is_empty(scratch_ / "folder"));
  }

  static TemporaryDirectory* stopped_;
  TemporaryDirectory scratch_;
  const std::string dir_ = scratch_ / "c";
};
TemporaryDirectory* HostileDirectoryTest::stopped_ = nullptr;

struct Disguise {
  std::string file;
  std::vector<std::string> refused_by;  // with its path; other commands do without it or replace it
};

std::vector<Disguise> Disguises() {
  const std::vector<std::string> all = {"show", "status", "resume"};
  return {{"lock", all},
          {"campaign.db", all},
          {"campaign.db-wal", all},
          {"campaign.db-journal", all},
          {"experiment.toml", all},
          {"searches.json", all},
          {"slurm.toml", {"status", "resume"}},
          {"epoch", {"resume"}},
          {"origin.json", {"resume"}},
          {"log", {"resume"}},
          {"log/master.log", {"resume"}},
          {"log/worker-1.log", {"resume"}},
          {"status.json", {}},
          {"stop", {}}};
}

TEST_F(HostileDirectoryTest, WhatIsNoRegularFileIsNeitherFollowedNorWaitedFor) {
  for (const auto& [file, refused_by] : Disguises()) {
    for (const std::string kind : {"pipe", "link", "device", "directory"}) {
      if (file == "log" && kind == "directory") continue;
      if (kind == "device" && geteuid() != 0) continue;
      for (const std::string command : {"show", "status", "resume"}) {
        // A resume that is not refused goes on to the end.
        if (command == "resume" && std::ranges::count(refused_by, command) == 0) continue;
        const std::string dir = scratch_ / "one";
        fs::remove_all(dir);
        fs::copy(dir_, dir, fs::copy_options::recursive);
        const std::string path = dir + "/" + file;
        fs::remove_all(path);
        if (kind == "pipe") {
          ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
        } else if (kind == "device") {
          ASSERT_EQ(mknod(path.c_str(), S_IFCHR | 0600, makedev(1, 5)), 0);  // /dev/zero
        } else if (kind == "link") {
          fs::create_symlink(scratch_ / (file == "log" ? "folder" : "precious"), path);
        } else {
          fs::create_directory(path);
        }
        std::vector<std::string> arguments = {command, dir};
        if (command != "resume") arguments.push_back("--json");
        if (command == "resume" && file != "slurm.toml")
          arguments.insert(arguments.end(), {"--workers", "1"});
        Process process(GauntletCommand(arguments));
        const ProcessResult result = process.Wait(kSoon);
        const std::string what = fmt::format("{} with a {} as {}: {}", command, kind, file, result.err);
        EXPECT_EQ(result.signal, 0) << what;
        ExpectNothingTouched();
        if (std::ranges::count(refused_by, command) == 0) {
          EXPECT_THAT(result.exit_code, testing::AnyOf(0, 2)) << what;
        } else if (file == "slurm.toml" && command == "status") {
          EXPECT_EQ(result.exit_code, 0) << what;
          EXPECT_THAT(result.out, HasSubstr("The cluster was not asked")) << what;
        } else {
          EXPECT_THAT(result.exit_code, testing::AnyOf(2, 3)) << what;
          EXPECT_THAT(result.err, HasSubstr(path + " is ")) << what;
        }
      }
    }
  }
}

// Otherwise it would wait for half a minute.
TEST_F(HostileDirectoryTest, ASignalEndsTheWaitForThoseWhoRead) {
  const UniqueFd reader(open((dir_ + "/lock").c_str(), O_RDONLY | O_CLOEXEC));
  ASSERT_EQ(flock(reader.get(), LOCK_SH), 0);
  for (const int signal : {SIGTERM, SIGINT}) {
    const std::vector<std::string> longer = {"--generations", "30"};
    for (const std::vector<std::string>& options : {std::vector<std::string>(), longer}) {
      std::vector<std::string> arguments = {"resume", dir_, "--workers", "1"};
      arguments.insert(arguments.end(), options.begin(), options.end());
      Process master(GauntletCommand(arguments));
      ASSERT_TRUE(Eventually([&] { return Catches(master.pid(), signal); }, kPatience));
      master.Signal(signal);
      const ProcessResult stopped = master.Wait(kSoon);
      EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
      EXPECT_THAT(stopped.err, AllOf(HasSubstr("told to stop while it waited"), HasSubstr("Go on with: ")));
    }
  }
}

TEST_F(HostileDirectoryTest, ANumberOfTheLastMasterThatCannotBeCountedOnIsRefused) {
  for (const std::string number : {"4294967295", "4294967296", "18446744073709551615"}) {
    WriteTo(dir_ + "/epoch", number + "\n");
    const ProcessResult result = RunProcess(GauntletCommand({"resume", dir_, "--workers", "1"}), {}, kSoon);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr("epoch holds '" + number + "'"));
  }
}

TEST_F(HostileDirectoryTest, NothingIsExecutedOrSubmittedFromAForeignDirectory) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  WriteTo(dir_ + "/slurm.toml", "tag = \"x\"\nsetup = \"touch /tmp/owned\"\n");
  for (const auto& entry : fs::recursive_directory_iterator(dir_))
    ASSERT_EQ(lchown(entry.path().c_str(), kStranger, kStranger), 0);
  ASSERT_EQ(chown(dir_.c_str(), kStranger, kStranger), 0);
  const std::vector<std::string> environment = WithSbatch();
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"resume", dir_},
        {"resume", dir_, "--workers", "1"},
        {"resume", dir_, "--bind", "tcp://127.0.0.1:*"},
        {"stop", dir_},
        {"master", "flocking", "--dir", dir_, "--bind", "tcp://127.0.0.1:*", "--resume"}}) {
    const ProcessResult result = RunProcess(GauntletCommand(command), environment, kSoon);
    EXPECT_EQ(result.exit_code, 2) << command[0];
    EXPECT_THAT(result.err,
                AllOf(HasSubstr("belongs to user 54321, not to you (user 0)"), HasSubstr("`cp -r " + dir_)))
        << command[0];
  }
  for (const std::vector<std::string>& command : {std::vector<std::string>{"show", dir_},
                                                  {"status", dir_},
                                                  {"status", dir_, "--json"},
                                                  {"replay", dir_, "1"}}) {
    const ProcessResult result = RunProcess(GauntletCommand(command), environment, kSoon);
    EXPECT_EQ(result.exit_code, 0) << command[0] << result.err;
  }
  EXPECT_FALSE(fs::exists(scratch_ / "called"));
  // The way out.
  fs::copy(dir_, scratch_ / "mine", fs::copy_options::recursive);
  fs::remove(scratch_ / "mine/slurm.toml");
  EXPECT_EQ(RunProcess(GauntletCommand({"resume", scratch_ / "mine", "--workers", "2"})).exit_code, 0);
}

TEST_F(HostileDirectoryTest, NothingIsExecutedOrSubmittedWhereOthersMayWrite) {
  const std::vector<std::string> environment = WithSbatch();
  WriteTo(dir_ + "/slurm.toml", "tag = \"x\"\n");
  for (const std::string name : {"", "/slurm.toml", "/campaign.db", "/log"}) {
    const std::string path = dir_ + name;
    const fs::perms before = fs::status(path).permissions();
    fs::permissions(path, fs::perms::group_write, fs::perm_options::add);
    const std::vector<std::string> resume = name == "/campaign.db" || name == "/log"
                                                ? std::vector<std::string>{"resume", dir_, "--workers", "1"}
                                                : std::vector<std::string>{"resume", dir_};
    const ProcessResult result = RunProcess(GauntletCommand(resume), environment, kSoon);
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_THAT(result.err, HasSubstr("`chmod go-w " + path + "`")) << name;
    EXPECT_EQ(Gauntlet({"show", dir_}).exit_code, 0) << name;
    fs::permissions(path, before);
  }
  EXPECT_FALSE(fs::exists(scratch_ / "called"));

  fs::permissions(scratch_ / "folder", fs::perms::all);
  const ProcessResult result =
      Gauntlet({"evolve", "flocking", "--dir", scratch_ / "folder", "--generations", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "gauntlet: " + (scratch_ / "folder") +
                            " has mode 777: other users may write it, who so would decide what this command "
                            "does in your name. If it holds what you left there: `chmod go-w " +
                            (scratch_ / "folder") + "`\n");
  EXPECT_TRUE(fs::is_empty(scratch_ / "folder"));
}

TEST_F(HostileDirectoryTest, AWorkerServesNobodyElse) {
  const std::string access = dir_ + "/access.json";
  WriteTo(access, R"({"format": 1, "campaign": "c", "epoch": 1, "endpoints": ["tcp://127.0.0.1:1"]})");
  chmod(access.c_str(), 0622);
  ProcessResult result = RunProcess({WorkerPath(), "--dir", dir_, "--orphan-timeout", "1"}, {}, kSoon);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("other users may write it"));
  if (geteuid() != 0) return;
  chmod(access.c_str(), 0600);
  ASSERT_EQ(chown(access.c_str(), kStranger, kStranger), 0);
  result = RunProcess({WorkerPath(), "--dir", dir_, "--orphan-timeout", "1"}, {}, kSoon);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("belongs to user 54321"));
}

TEST_F(HostileDirectoryTest, WithoutAUmaskNothingIsMadeThatOthersMayWrite) {
  const std::string script = fmt::format(
      "umask 000; {} evolve flocking --dir {}/new/campaign --population 4 --generations 1 --workers 2 "
      "--quiet && "
      "{} replay {}/new/campaign 1 --csv {}/new/run.csv",
      GauntletPath(), scratch_.path(), GauntletPath(), scratch_.path(), scratch_.path());
  const ProcessResult result = RunProcess({"/bin/sh", "-c", script});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(scratch_ / "new")) {
    struct stat info {};
    ASSERT_EQ(lstat(entry.path().c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 022, 0u) << entry.path();
    ++seen;
  }
  EXPECT_GE(seen, 8);
}

// ---- Deleted and replaced while a master serves them.

struct Loss {
  const char* name;  // of the test
  std::string file;  // in the campaign's directory; "" is the directory
  bool replaced;
  std::string words;
};
void PrintTo(const Loss& loss, std::ostream* os) {
  *os << loss.name;
}

class DeletedUnderOurFeetTest : public testing::TestWithParam<Loss> {};

TEST_P(DeletedUnderOurFeetTest, TheMasterSaysSoAndStops) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  SmallCampaign campaign;
  campaign.population = 20;
  campaign.generations = 500;
  std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(campaign, dir, 1));
  ASSERT_TRUE(RunsDone(dir, 4)) << master->Err();
  const std::string path = GetParam().file.empty() ? dir : dir + "/" + GetParam().file;
  // A living master may write its status between two looks into the directory.
  std::error_code error;
  if (GetParam().replaced) {
    const auto options = fs::copy_options::recursive | fs::copy_options::overwrite_existing;
    EXPECT_TRUE(
        Eventually([&] { return fs::copy(path, scratch / "other", options, error), !error; }, kPatience));
    fs::rename(path, scratch / "away");
    fs::rename(scratch / "other", path);
  } else {
    EXPECT_TRUE(Eventually([&] { return fs::remove_all(path, error), !fs::exists(path); }, kPatience));
  }
  const ProcessResult stopped = master->Wait(kPatience);
  EXPECT_EQ(stopped.exit_code, 3) << stopped.err;
  EXPECT_THAT(stopped.err, AllOf(HasSubstr(path), HasSubstr(GetParam().words)));
  EXPECT_THAT(stopped.err, testing::Not(HasSubstr("all of them stored")));
}

INSTANTIATE_TEST_SUITE_P(
    Files, DeletedUnderOurFeetTest,
    testing::Values(Loss{"Database", "campaign.db", false, "What was stored is lost"},
                    Loss{"DatabaseReplaced", "campaign.db", true, "another one has its name"},
                    Loss{"Log", "campaign.db-wal", false, "stored last are lost"},
                    Loss{"LogReplaced", "campaign.db-wal", true, "another one has its name"},
                    Loss{"Directory", "", false, "is gone, deleted or moved away"},
                    Loss{"DirectoryReplaced", "", true, "another one has its name"},
                    Loss{"Lock", "lock", false, "Another master may have begun"}),
    [](const auto& test) { return test.param.name; });

class DeletedDescriptionTest : public testing::TestWithParam<const char*> {};

TEST_P(DeletedDescriptionTest, IsWrittenAgainByTheMasterThatHoldsTheLock) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  SmallCampaign campaign;
  campaign.generations = 500;
  std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(campaign, dir, 1));
  ASSERT_TRUE(RunsDone(dir, 4)) << master->Err();
  const std::string path = dir + "/" + GetParam();
  const std::string text = ReadFile(path);
  fs::remove(path);
  EXPECT_TRUE(Eventually([&] { return fs::exists(path) && ReadFile(path) == text; }, kPatience));
  master->Signal(SIGTERM);
  EXPECT_EQ(master->Wait().exit_code, 3);
  EXPECT_EQ(Gauntlet({"show", dir}).exit_code, 0);
}

INSTANTIATE_TEST_SUITE_P(Files, DeletedDescriptionTest, testing::Values("epoch", "experiment.toml"));

TEST(DeletedDatabaseTest, IsToldOnceItsMasterIsGone) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  ASSERT_EQ(Gauntlet(EvolveArguments(SmallCampaign(), dir, 1)).exit_code, 0);
  for (const char* name : {"campaign.db", "campaign.db-wal", "campaign.db-shm"}) fs::remove(dir + "/" + name);
  for (const char* command : {"show", "resume"}) {
    const ProcessResult refused = Gauntlet({command, dir});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, testing::HasSubstr("its campaign.db is gone")) << command;
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
