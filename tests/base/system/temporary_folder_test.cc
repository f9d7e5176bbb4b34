#include "base/system/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>

namespace gauntlet {
namespace {

namespace fs = std::filesystem;

TEST(TemporaryFolderTest, GoesWithAllThatItHolds) {
  std::optional<TemporaryFolder> folder(std::in_place, "test");
  const fs::path path = folder->path();
  EXPECT_THAT(path.filename().string(), testing::StartsWith("gauntlet-test-"));
  EXPECT_EQ(path, fs::canonical(path));
  fs::create_directory(path / "a");
  std::ofstream(path / "a/b") << "c";
  const TemporaryFolder other("test");
  EXPECT_NE(other.path(), path);
  folder.reset();
  EXPECT_FALSE(fs::exists(path));
  EXPECT_TRUE(fs::exists(other.path()));
}

TEST(TemporaryFolderTest, WithoutRoomThereIsNone) {
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  setenv("TMPDIR", "/no/such/folder", 1);
  EXPECT_EQ(TemporaryFolder("test").path(), "");
  kept.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", kept.c_str(), 1);
}

}  // namespace
}  // namespace gauntlet
