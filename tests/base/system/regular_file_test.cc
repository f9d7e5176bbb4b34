#include "base/system/regular_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Without the process' umask.
class RegularFileTest : public testing::Test {
 protected:
  RegularFileTest() : before_(umask(0)) {}
  ~RegularFileTest() override { umask(before_); }

  static mode_t ModeOf(const std::string& path) {
    struct stat info {};
    EXPECT_EQ(lstat(path.c_str(), &info), 0) << path;
    return info.st_mode & 07777;
  }
  void MakeSocket(const std::string& path) const {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
    const UniqueFd socket_fd(socket(AF_UNIX, SOCK_STREAM, 0));
    ASSERT_EQ(bind(socket_fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }

  const mode_t before_;
  ScratchDirectory scratch_;
};

TEST_F(RegularFileTest, ReadsAndMakesWhatIsRegular) {
  WriteFile(scratch_ / "file", "text");
  EXPECT_EQ(*ReadRegularFile(scratch_ / "file"), "text");
  EXPECT_EQ(ReadRegularFile(scratch_ / "file", 3).error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(ReadRegularFile(scratch_ / "none").error().kind, ErrorKind::kNotFound);
  EXPECT_TRUE(OpenRegularFile(scratch_ / "new", O_WRONLY | O_CREAT, 0644).ok());
  EXPECT_EQ(ModeOf(scratch_ / "new"), 0644u);
}

TEST_F(RegularFileTest, NothingElseIsOpenedAndNobodyWaits) {
  WriteFile(scratch_ / "target", "precious");
  fs::create_symlink("target", scratch_ / "link");
  fs::create_symlink("nothing", scratch_ / "dangling");
  fs::create_directory(scratch_ / "directory");
  ASSERT_EQ(mkfifo((scratch_ / "pipe").c_str(), 0600), 0);
  MakeSocket(scratch_ / "socket");
  struct Case {
    const char* name;
    const char* kind;
  };
  for (const auto& [name, kind] :
       {Case{"link", "a symbolic link"}, Case{"dangling", "a symbolic link"},
        Case{"directory", "a directory"}, Case{"pipe", "a named pipe"}, Case{"socket", "a socket"}}) {
    const std::string path = scratch_ / name;
    for (const int flags : {O_RDONLY, O_RDWR, O_RDWR | O_CREAT, O_WRONLY | O_CREAT | O_APPEND}) {
      const Result<UniqueFd> opened = OpenRegularFile(path, flags, 0600);
      ASSERT_FALSE(opened.ok()) << name << flags;
      EXPECT_EQ(opened.error().kind, ErrorKind::kInvalidInput) << name << flags;
      EXPECT_EQ(opened.error().message, path + " is " + kind + "; here belongs a regular file, or none");
    }
    EXPECT_FALSE(CheckRegularFile(path).ok()) << name;
  }
  EXPECT_EQ(OpenRegularFile("/dev/null", O_RDONLY).error().message,
            "/dev/null is a device; here belongs a regular file, or none");
  EXPECT_EQ(ReadFile(scratch_ / "target"), "precious");
  EXPECT_FALSE(fs::exists(scratch_ / "nothing"));
  EXPECT_TRUE(CheckRegularFile(scratch_ / "target").ok());
  EXPECT_TRUE(CheckRegularFile(scratch_ / "none").ok());
}

TEST_F(RegularFileTest, ADirectoryIsMadeForItsOwnerToWriteAlone) {
  EXPECT_TRUE(MakeDirectory(scratch_ / "log").ok());
  EXPECT_TRUE(MakeDirectory(scratch_ / "log").ok()) << "there is one";
  EXPECT_EQ(ModeOf(scratch_ / "log"), 0755u);
  fs::create_directory(scratch_ / "elsewhere");
  fs::create_directory_symlink("elsewhere", scratch_ / "link");
  EXPECT_THAT(MakeDirectory(scratch_ / "link").error().message, HasSubstr("link is a symbolic link"));
  WriteFile(scratch_ / "file", "");
  EXPECT_EQ(MakeDirectory(scratch_ / "file").error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(MakeDirectory(scratch_ / "none/below").error().kind, ErrorKind::kNotFound);
}

TEST_F(RegularFileTest, AFileIsKnownAgainWhereverItIsMovedAndItsSuccessorIsAnother) {
  WriteFile(scratch_ / "a", "x");
  const std::optional<FileId> id = *IdentifyFile(scratch_ / "a");
  ASSERT_TRUE(id);
  fs::rename(scratch_ / "a", scratch_ / "b");
  EXPECT_EQ(*IdentifyFile(scratch_ / "b"), id);
  EXPECT_EQ(*IdentifyFile(scratch_ / "a"), std::nullopt);
  WriteFile(scratch_ / "a", "x");
  EXPECT_NE(*IdentifyFile(scratch_ / "a"), id);
  EXPECT_EQ(*IdentifyFile(scratch_ / "a/below"), std::nullopt);
}

}  // namespace
}  // namespace gauntlet
