#include "base/system/trusted_path.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>

#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::array<std::string_view, 2> kFiles = {"settings", "missing"};

class TrustedPathTest : public testing::Test {
 protected:
  TrustedPathTest() {
    std::filesystem::create_directory(directory_);
    Mode(directory_, 0755);
    WriteFile(file_, "");
    Mode(file_, 0644);
  }
  static void Mode(const std::string& path, mode_t mode) { EXPECT_EQ(chmod(path.c_str(), mode), 0); }

  ScratchDirectory scratch_;
  std::string directory_ = scratch_ / "it's here";
  std::string file_ = directory_ + "/settings";
};

TEST_F(TrustedPathTest, WhatWeAloneWriteIsTrusted) {
  EXPECT_TRUE(CheckOnlyWeWrite(directory_, kFiles).ok());
  std::filesystem::create_directory_symlink(directory_, scratch_ / "link");
  EXPECT_TRUE(CheckOnlyWeWrite(scratch_ / "link", kFiles).ok());
  EXPECT_EQ(CheckOnlyWeWrite(scratch_ / "none").error().kind, ErrorKind::kNotFound);
}

TEST_F(TrustedPathTest, WhatOthersMayWriteIsNotAndTheWayOutIsNamed) {
  for (const std::string& path : {directory_, file_}) {
    for (const mode_t mode : {0775, 0757, 0777, 01777}) {
      Mode(path, mode);
      const Status trusted = CheckOnlyWeWrite(directory_, kFiles);
      ASSERT_FALSE(trusted.ok()) << path << mode;
      EXPECT_EQ(trusted.error().kind, ErrorKind::kInvalidInput);
      EXPECT_THAT(
          trusted.error().message,
          AllOf(HasSubstr(fmt::format("{} has mode {:03o}", path, mode & 0777)), HasSubstr("`chmod go-w '")));
    }
    Mode(path, 0755);
  }
}

TEST_F(TrustedPathTest, WhatBelongsToAnotherUserIsNot) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can give files away";
  for (const std::string& path : {directory_, file_}) {
    ASSERT_EQ(chown(path.c_str(), 54321, 54321), 0);
    const Status trusted = CheckOnlyWeWrite(directory_, kFiles);
    ASSERT_FALSE(trusted.ok()) << path;
    EXPECT_THAT(trusted.error().message,
                AllOf(HasSubstr(path + " belongs to user 54321, not to you (user 0)"), HasSubstr("`cp -r '"),
                      HasSubstr("COPY`")));
    // Root may do everything anyway: what is root's is trusted by that user.
    ASSERT_EQ(chown(path.c_str(), 0, 0), 0);
    ASSERT_EQ(seteuid(54321), 0);
    const Status of_root = CheckOnlyWeWrite(directory_, kFiles);
    ASSERT_EQ(seteuid(0), 0);
    EXPECT_TRUE(of_root.ok() || of_root.error().kind == ErrorKind::kIo) << "its scratch folder is closed";
  }
}

TEST_F(TrustedPathTest, ALinkAmongTheFilesHasNoModeOfItsOwn) {
  WriteFile(scratch_ / "elsewhere", "");
  std::filesystem::remove(file_);
  std::filesystem::create_symlink(scratch_ / "elsewhere", file_);
  EXPECT_TRUE(CheckOnlyWeWrite(directory_, kFiles).ok()) << "it is refused when it is opened";
}

}  // namespace
}  // namespace gauntlet
