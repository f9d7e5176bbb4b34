#include "proto/access_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/process.h"

namespace gauntlet::proto {
namespace {

using testing::HasSubstr;

constexpr const char* kGood =
    R"({"format": 1, "campaign": "c0ffee", "epoch": 3, "endpoints": ["tcp://127.0.0.1:40123", "ipc:///tmp/x"],
        "server_key": "a later version's"})";

TEST(AccessFileTest, ReadsWhatTheMasterWritesAndIgnoresLaterKeys) {
  const Result<Access> access = ParseAccess(kGood, "access.json");
  ASSERT_TRUE(access.ok()) << access.error().message;
  EXPECT_EQ(*access, (Access{"c0ffee", 3, {"tcp://127.0.0.1:40123", "ipc:///tmp/x"}}));
}

TEST(AccessFileTest, ReadsKeysAndRefusesAFileThatOthersMayRead) {
  const testing_support::TemporaryDirectory scratch;
  const std::string path = scratch / "access.json";
  const std::string key(40, 'k');
  std::ofstream(path) << R"({"format": 1, "campaign": "c", "epoch": 1, "endpoints": ["tcp://10.0.0.1:5"],)"
                      << R"("curve": {"server_public": ")" << key << R"(", "worker_public": ")" << key
                      << R"(", "worker_secret": ")" << key << R"("}})";
  std::filesystem::permissions(path, std::filesystem::perms(0600));
  Result<Access> access = ReadAccess(path);
  ASSERT_TRUE(access.ok()) << access.error().message;
  EXPECT_EQ(access->curve, (CurveKeys{key, key, key}));
  std::filesystem::permissions(path, std::filesystem::perms(0640));
  access = ReadAccess(path);
  ASSERT_FALSE(access.ok());
  EXPECT_THAT(access.error().message, testing::AllOf(HasSubstr("mode 640"), HasSubstr("chmod 600")));
  EXPECT_THAT(access.error().message, testing::Not(HasSubstr(key)));
}

struct BadAccess {
  const char* name;
  const char* text;
  const char* complaint;
};

void PrintTo(const BadAccess& param, std::ostream* out) {
  *out << param.name;
}

class BadAccessTest : public testing::TestWithParam<BadAccess> {};

TEST_P(BadAccessTest, IsRefusedWithItsPlaceAndWhatWouldBeRight) {
  const Result<Access> access = ParseAccess(GetParam().text, "dir/access.json");
  ASSERT_FALSE(access.ok());
  EXPECT_THAT(access.error().message, HasSubstr("dir/access.json"));
  EXPECT_THAT(access.error().message, HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    AccessFile, BadAccessTest,
    testing::Values(BadAccess{"Empty", "", "dir/access.json:1:1"},
                    BadAccess{"Torn", "{\"format\": 1,\n \"camp", "dir/access.json:2:"},
                    BadAccess{"List", "[]", "an object"}, BadAccess{"NoFormat", "{}", "\"format\""},
                    BadAccess{"NewerFormat", R"({"format": 2})", "format 2, this version reads format 1"},
                    BadAccess{"NoCampaign", R"({"format": 1, "campaign": ""})", "\"campaign\""},
                    BadAccess{"NegativeEpoch", R"({"format": 1, "campaign": "a", "epoch": -1})", "\"epoch\""},
                    BadAccess{"NoEndpoints", R"({"format": 1, "campaign": "a", "epoch": 1, "endpoints": []})",
                              "\"endpoints\""},
                    BadAccess{"WrongControllers",
                              R"({"format": 1, "campaign": "a", "epoch": 1, "endpoints": ["tcp://h:1"],
                                  "controllers": ["a", 2]})",
                              "\"controllers\" must be a list of names"},
                    BadAccess{"WrongEndpoint",
                              R"({"format": 1, "campaign": "a", "epoch": 1, "endpoints": ["udp://x"]})",
                              "udp://x"}),
    [](const auto& test) { return test.param.name; });

TEST(AccessFileTest, NewerFormatIsAMatterOfVersions) {
  EXPECT_EQ(ParseAccess(R"({"format": 2})", "x").error().kind, ErrorKind::kVersion);
}

TEST(AccessFileTest, MissingFileIsNotFound) {
  const testing_support::TemporaryDirectory directory;
  EXPECT_EQ(ReadAccess(directory / "access.json").error().kind, ErrorKind::kNotFound);
  std::ofstream(directory / "access.json") << kGood;
  EXPECT_TRUE(ReadAccess(directory / "access.json").ok());
}

TEST(AccessFileTest, NoErrorRepeatsWhatMayBeAPartOfAKey) {
  const std::string secret(40, 's');
  const std::string whole = R"({"format": 1, "campaign": "c", "epoch": 1, "endpoints": ["tcp://10.0.0.1:5"],
      "curve": {"server_public": ")" +
                            secret + R"(", "worker_public": ")" + secret + R"(", "worker_secret": ")" +
                            secret + "\"}}";
  ASSERT_TRUE(ParseAccess(whole, "a.json").ok());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const Result<Access> torn = ParseAccess(whole.substr(0, length), "a.json");
    ASSERT_FALSE(torn.ok());
    EXPECT_THAT(torn.error().message, testing::Not(HasSubstr("sss"))) << length;
  }
  std::string no_key = whole;
  no_key[whole.rfind('s')] = '"';
  EXPECT_THAT(ParseAccess(no_key, "a.json").error().message, testing::Not(HasSubstr("sss")));
  no_key[whole.rfind('s')] = '~';
  EXPECT_EQ(ParseAccess(no_key, "a.json").error().message,
            "a.json: \"curve\".\"worker_secret\" must be a key of 40 characters of Z85");
}

TEST(AccessFileTest, WhatIsNoRegularFileCannotBeReadAndKeepsNobodyWaiting) {
  const testing_support::TemporaryDirectory scratch;
  std::filesystem::create_directory(scratch / "directory");
  ASSERT_EQ(mkfifo((scratch / "pipe").c_str(), 0600), 0);
  for (const char* name : {"directory", "pipe"}) {
    const Result<Access> access = ReadAccess(scratch / name);
    ASSERT_FALSE(access.ok());
    EXPECT_EQ(access.error().kind, ErrorKind::kIo);
    EXPECT_THAT(access.error().message, HasSubstr("is no regular file"));
  }
}

TEST(AccessFileTest, ANumberBeyondAllRangesIsRefusedLikeAnyOther) {
  const Result<Access> access = ParseAccess(R"({"format": 1e999})", "a.json");
  ASSERT_FALSE(access.ok());
  EXPECT_THAT(access.error().message, testing::StartsWith("a.json: "));
}

const Access kAccess{"00112233445566778899aabbccddeeff", 3, {"tcp://127.0.0.1:41234", "ipc:///tmp/x"}};

TEST(AccessFileTest, HoldsWhatAWorkerNeedsForItsOwnerAlone) {
  const testing_support::TemporaryDirectory scratch;
  const std::string path = scratch / "access.json";
  ASSERT_TRUE(WriteAccess(path, kAccess).ok());
  std::ifstream file(path);
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  EXPECT_EQ(json, nlohmann::json({{"format", 1},
                                  {"campaign", "00112233445566778899aabbccddeeff"},
                                  {"epoch", 3},
                                  {"endpoints", {"tcp://127.0.0.1:41234", "ipc:///tmp/x"}}}));
  struct stat info {};
  ASSERT_EQ(stat(path.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777, 0600u);

  Access with_keys = kAccess;
  with_keys.curve = CurveKeys{std::string(40, 'a'), std::string(40, 'b'), std::string(40, 'c')};
  with_keys.controllers = {"flocking", "foraging"};
  ASSERT_TRUE(WriteAccess(path, with_keys).ok());
  EXPECT_EQ(*ReadAccess(path), with_keys);
}

TEST(AccessFileTest, IsRemovedByItsMasterButNotByAnOlderOne) {
  const testing_support::TemporaryDirectory scratch;
  const std::string path = scratch / "access.json";
  ASSERT_TRUE(WriteAccess(path, kAccess).ok());
  EXPECT_TRUE(RemoveAccess(path, 2).ok());
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_TRUE(RemoveAccess(path, 3).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(RemoveAccess(path, 3).ok()) << "a second time is no error";
}

TEST(AccessFileTest, OfAMasterThatWasKilledIsRemovedByTheNext) {
  const testing_support::TemporaryDirectory scratch;
  const std::string path = scratch / "access.json";
  ASSERT_TRUE(WriteAccess(path, kAccess).ok());
  EXPECT_TRUE(RemoveAccess(path, 4).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
  std::ofstream(path) << "garbage";
  EXPECT_TRUE(RemoveAccess(path, 4).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace gauntlet::proto
