#include "base/system/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

mode_t ModeOf(const std::string& path) {
  struct stat info {};
  EXPECT_EQ(stat(path.c_str(), &info), 0);
  return info.st_mode & 07777;
}

TEST(AtomicFileTest, WritesContentAndModeAndLeavesNothingElse) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "file";
  const std::string bytes = std::string("a\0b\n", 4) + std::string(100000, 'x');
  ASSERT_TRUE(WriteFileAtomically(path, bytes, 0640).ok());
  EXPECT_EQ(ReadFile(path), bytes);
  EXPECT_EQ(ModeOf(path), 0640u);
  ASSERT_TRUE(WriteFileAtomically(path, "", 0600).ok());
  EXPECT_EQ(ReadFile(path), "");
  EXPECT_EQ(ModeOf(path), 0600u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 1);
}

TEST(AtomicFileTest, AMissingDirectoryIsAnErrorWithItsPath) {
  const Status written = WriteFileAtomically("/nonexistent/file", "x", 0600);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().kind, ErrorKind::kNotFound);
  EXPECT_EQ(written.error().message, "cannot create a file in /nonexistent/: No such file or directory");
}

TEST(AtomicFileTest, ADirectoryIsNotReplacedAndTheDraftIsRemoved) {
  const ScratchDirectory scratch;
  std::filesystem::create_directory(scratch / "file");
  const Status written = WriteFileAtomically(scratch / "file", "x", 0600);
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(written.error().message, HasSubstr("file"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 1);
}

TEST(AtomicFileTest, AReaderNeverSeesHalfAFile) {
  const ScratchDirectory scratch;
  const std::string path = scratch / "file";
  const std::string a(20000, 'a');
  const std::string b(30000, 'b');
  ASSERT_TRUE(WriteFileAtomically(path, a, 0600).ok());
  std::atomic<bool> done = false;
  std::thread writer([&] {
    for (int i = 0; i < 50; ++i) EXPECT_TRUE(WriteFileAtomically(path, i % 2 == 0 ? b : a, 0600).ok());
    done = true;
  });
  while (!done) {
    const std::string seen = ReadFile(path);
    EXPECT_TRUE(seen == a || seen == b) << seen.size() << " bytes";
  }
  writer.join();
}

TEST(FileReplacementTest, TheOldContentStandsUntilTheEnd) {
  const ScratchDirectory scratch;
  WriteFile(scratch / "file", "old");
  {
    Result<FileReplacement> given_up = FileReplacement::Begin(scratch / "file", 0600);
    ASSERT_TRUE(given_up.ok());
    EXPECT_TRUE(given_up->Write("half of it").ok());
  }
  EXPECT_EQ(ReadFile(scratch / "file"), "old");
  Result<FileReplacement> file = FileReplacement::Begin(scratch / "file", 0640);
  ASSERT_TRUE(file.ok());
  FileReplacement moved = *std::move(file);
  EXPECT_TRUE(moved.Write("one, ").ok());
  EXPECT_TRUE(moved.Write("two").ok());
  EXPECT_EQ(ReadFile(scratch / "file"), "old");
  EXPECT_TRUE(moved.Finish().ok());
  EXPECT_EQ(ReadFile(scratch / "file"), "one, two");
  EXPECT_EQ(ModeOf(scratch / "file"), 0640u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 1);
}

TEST(AtomicFileTest, AFullDiskIsNamedSo) {
  EXPECT_EQ(SystemError("cannot write x", ENOSPC).kind, ErrorKind::kNoSpace);
  EXPECT_EQ(SystemError("cannot write x", ENOSPC).message,
            "the disk is full: cannot write x: No space left on device");
  EXPECT_EQ(SystemError("cannot write x", EDQUOT).kind, ErrorKind::kNoSpace);
  EXPECT_EQ(SystemError("cannot write x", EIO).kind, ErrorKind::kIo);
}

TEST(ReadSmallFileTest, RefusesWhatIsTooLong) {
  const ScratchDirectory scratch;
  WriteFile(scratch / "file", std::string(101, 'x'));
  EXPECT_TRUE(ReadSmallFile(scratch / "file", 101).ok());
  const Result<std::string> read = ReadSmallFile(scratch / "file", 100);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().kind, ErrorKind::kCorrupt);
  EXPECT_EQ(ReadSmallFile(scratch / "none").error().kind, ErrorKind::kNotFound);
}

}  // namespace
}  // namespace gauntlet
