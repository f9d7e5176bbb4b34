// A hostile world around a running campaign: second masters, damaged files, a full disk, garbage on the port.
// Covers: sim/run_checks.cc
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/integration/campaign_database.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/hostile_sockets.h"
#include "tests/integration/service_driver.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;
using testing::HasSubstr;

SmallCampaign LongerCampaign() {
  SmallCampaign campaign;
  campaign.population = 20;
  campaign.generations = 60;
  return campaign;
}

TEST(RefusalTest, ACampaignInUseIsRefusedWithItsOwner) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(LongerCampaign(), dir, 2));
  ASSERT_TRUE(Serves(dir)) << master->Err();
  const ProcessResult second = Gauntlet({"resume", dir, "--quiet"});
  EXPECT_EQ(second.exit_code, 2);
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  EXPECT_THAT(second.err, HasSubstr(std::to_string(master->pid())));
  EXPECT_THAT(second.err, HasSubstr(host));
  EXPECT_TRUE(master->Running());
  master->Signal(SIGTERM);
  EXPECT_EQ(master->Wait().exit_code, 3);
}

class DamagedCampaignTest : public testing::Test {
 protected:
  void SetUp() override {
    SmallCampaign campaign;
    campaign.generations = 1;
    ASSERT_EQ(Gauntlet(EvolveArguments(campaign, dir_, 2)).exit_code, 0);
  }
  // Both commands refuse, say why, and leave the file as it is.
  void ExpectRefusal(const std::string& said) {
    const std::string before = ReadFile(dir_ + "/campaign.db");
    for (const std::string command : {"show", "resume"}) {
      const ProcessResult result = Gauntlet({command, dir_});
      EXPECT_EQ(result.exit_code, 2) << command << ": " << result.err;
      EXPECT_THAT(result.err, HasSubstr(said)) << command;
    }
    EXPECT_EQ(ReadFile(dir_ + "/campaign.db"), before);
  }

  TemporaryDirectory scratch_;
  std::string dir_ = scratch_ / "c";
};

TEST_F(DamagedCampaignTest, ANewerFormatIsRefused) {
  AlterDatabase(dir_, "PRAGMA user_version = 999");
  ExpectRefusal("999");
}

TEST_F(DamagedCampaignTest, ADamagedDatabaseIsReportedAndLeftAlone) {
  std::fstream file(dir_ + "/campaign.db", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(4096);
  file << std::string(8192, '\x5a');
  file.close();
  ExpectRefusal("damaged");
}

TEST_F(DamagedCampaignTest, ADatabaseThatIsNoneIsReportedAndLeftAlone) {
  std::ofstream(dir_ + "/campaign.db", std::ios::binary)
      << "this is not a database, this is a text of some length";
  ExpectRefusal("campaign.db");
}

void SendBytes(int port, const std::string& bytes) {
  HostileSocket(port).Send(bytes);
}

TEST(HostilePortTest, GarbageAndOversizedMessagesAreDroppedAndTheCampaignGoesOn) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  SmallCampaign campaign;
  campaign.generations = 12;
  std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(campaign, dir, 2));
  ASSERT_TRUE(Serves(dir)) << master->Err();
  const json access = json::parse(ReadFile(dir + "/access.json"), nullptr, false);
  const std::string endpoint = access["endpoints"][0].get<std::string>();
  const int port = std::stoi(endpoint.substr(endpoint.rfind(':') + 1));

  SendBytes(port, "GET / HTTP/1.1\r\n\r\n");
  SendBytes(port, std::string(100000, '\xff'));
  // One short frame of garbage, then a frame that announces 2^40 bytes.
  SendBytes(port, ZmtpHandshake() + std::string("\0\x05hello", 7));
  SendBytes(port, ZmtpHandshake() + std::string("\x02\0\0\x01\0\0\0\0\0", 9) + std::string(1000, 'x'));

  const ProcessResult result = master->Wait();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(StateHash(dir), UndisturbedHash(campaign));
}

TEST(FullDiskTest, StopsWithExit3AndResumesWhenThereIsSpace) {
  const TemporaryDirectory scratch;
  const std::string mount = scratch / "small";
  std::filesystem::create_directory(mount);
  // A file system of its own in a mount namespace of its own; everything happens inside one shell, and ends
  // with it.
  const std::string script = fmt::format(
      "mount -t tmpfs -o size=350k none {0} || exit 77\n"
      "{1} evolve flocking --dir {0}/c --workers 2 --population 20 --generations 12 --quiet 2> "
      "{2}/first.err; echo first $?\n"
      "mount -o remount,size=64m {0}\n"
      "{1} resume {0}/c --workers 2 --quiet; echo resumed $?\n"
      "{1} show {0}/c --json > {2}/show.json\n",
      mount, GauntletPath(), scratch.path());
  const ProcessResult result =
      RunProcess({"/usr/bin/unshare", "--mount", "--map-root-user", "/bin/sh", "-c", script});
  if (result.exit_code == 77 || result.exit_code == 1)
    GTEST_SKIP() << "no mount namespace to be had here: " << result.err;
  EXPECT_THAT(result.out, HasSubstr("first 3")) << result.err;
  EXPECT_THAT(result.out, HasSubstr("resumed 0")) << result.err;
  EXPECT_THAT(ReadFile(scratch / "first.err"), HasSubstr("disk"));
  const TemporaryDirectory undisturbed;
  ASSERT_EQ(Gauntlet({"evolve", "flocking", "--dir", undisturbed / "c", "--workers", "2", "--population",
                      "20", "--generations", "12", "--quiet"})
                .exit_code,
            0);
  const json shown = json::parse(ReadFile(scratch / "show.json"), nullptr, false);
  ASSERT_FALSE(shown.is_discarded());
  EXPECT_EQ(shown["state_hash"], StateHash(undisturbed / "c"));
}

// Too small even for campaign.db: there is nothing to resume, and the directory is as good as new.
TEST(FullDiskTest, ACampaignThatCouldNotBeMadeIsMadeByTheSameCommandWhenThereIsSpace) {
  const TemporaryDirectory scratch;
  const std::string mount = scratch / "small";
  std::filesystem::create_directory(mount);
  std::string script = fmt::format("mount -t tmpfs -o size=8k none {} || exit 77\n", mount);
  const std::string command = fmt::format(
      "{} evolve flocking --dir {}/c --workers 1 --population 4 --generations 1 --quiet 2>> {}/err; echo $1 "
      "$?\n",
      GauntletPath(), mount, scratch.path());
  script += "again() {\n" + command + "}\n";
  for (const std::string size : {"8k", "40k", "100k", "64m"})
    script += fmt::format("mount -o remount,size={} {}\nagain {}\n", size, mount, size);
  const ProcessResult result =
      RunProcess({"/usr/bin/unshare", "--mount", "--map-root-user", "/bin/sh", "-c", script});
  if (result.exit_code == 77 || result.exit_code == 1)
    GTEST_SKIP() << "no mount namespace to be had here: " << result.err;
  const std::string said = ReadFile(scratch / "err");
  for (const std::string code : {"8k 3\n", "40k 3\n", "100k 3\n", "64m 0\n"})
    EXPECT_THAT(result.out, HasSubstr(code)) << said;
  EXPECT_THAT(said, HasSubstr("nothing was simulated. When there is room, the same command with --dir " +
                              mount + "/c starts anew"));
  EXPECT_THAT(said, testing::Not(HasSubstr("resume")));
}

TEST(RefusalTest, AMasterWhoseDirectoryIsMovedAwaySaysSoAndStops) {
  const TemporaryDirectory scratch;
  const std::string dir = scratch / "c";
  std::unique_ptr<Process> master = StartGauntlet(EvolveArguments(LongerCampaign(), dir, 2));
  ASSERT_TRUE(RunsDone(dir, 1)) << master->Err();
  std::filesystem::rename(dir, scratch / "moved");
  std::filesystem::create_directories(dir + "/log");  // as a worker that starts then does
  const ProcessResult stopped = master->Wait();
  EXPECT_EQ(stopped.exit_code, 3);
  EXPECT_THAT(stopped.err, HasSubstr("the directory " + dir + " is gone"));
  EXPECT_THAT(stopped.err, HasSubstr("resume THERE"));
  EXPECT_EQ(Show(scratch / "moved").value("finished", true), false);
}

}  // namespace
}  // namespace gauntlet::testing_support
