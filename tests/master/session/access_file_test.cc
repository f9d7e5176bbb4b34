#include "master/session/access_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/master/store/store_records.h"

namespace gauntlet::master {
namespace {

const AccessInfo kInfo = {"00112233445566778899aabbccddeeff", 3, {"tcp://127.0.0.1:41234", "ipc:///tmp/x"}};

TEST(AccessFileTest, HoldsWhatAWorkerNeedsForItsOwnerAlone) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "access.json";
  ASSERT_TRUE(WriteAccessFile(path, kInfo).ok());
  const nlohmann::json json = nlohmann::json::parse(ReadFile(path), nullptr, false);
  EXPECT_EQ(json, nlohmann::json({{"format", 1},
                                  {"campaign", "00112233445566778899aabbccddeeff"},
                                  {"epoch", 3},
                                  {"endpoints", {"tcp://127.0.0.1:41234", "ipc:///tmp/x"}}}));
  struct stat info {};
  ASSERT_EQ(stat(path.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777, 0600u);
}

TEST(AccessFileTest, IsRemovedByItsMasterButNotByAnOlderOne) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "access.json";
  ASSERT_TRUE(WriteAccessFile(path, kInfo).ok());
  EXPECT_TRUE(RemoveAccessFile(path, 2).ok());
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_TRUE(RemoveAccessFile(path, 3).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(RemoveAccessFile(path, 3).ok()) << "a second time is no error";
}

TEST(AccessFileTest, OfAMasterThatWasKilledIsRemovedByTheNext) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "access.json";
  ASSERT_TRUE(WriteAccessFile(path, kInfo).ok());
  EXPECT_TRUE(RemoveAccessFile(path, 4).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
  WriteFile(path, "garbage");
  EXPECT_TRUE(RemoveAccessFile(path, 4).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace gauntlet::master
