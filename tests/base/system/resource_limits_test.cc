#include "base/system/resource_limits.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/check.h"
#include "base/system/atomic_file.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::AllOf;

void Limit(__rlimit_resource resource, rlim_t soft, rlim_t hard) {
  const rlimit limit{soft, hard};
  if (setrlimit(resource, &limit) != 0) _exit(99);
}

// In a child, for limits and signals are the process' own.
void ExpectInChild(const std::function<bool()>& holds) {
  EXPECT_EXIT(_exit(holds() ? 0 : 1), testing::ExitedWithCode(0), "");
}

TEST(ResourceLimitsTest, NothingIsMadeThatOthersMayWriteWhateverTheUmask) {
  const ScratchDirectory scratch;
  for (const mode_t before : {0000, 0002, 0077}) {
    ExpectInChild([&] {
      umask(before);
      if (!PrepareProgram()) return false;
      const std::string path = scratch / std::to_string(before);
      const int fd = open(path.c_str(), O_CREAT | O_WRONLY, 0666);
      struct stat info {};
      return fd >= 0 && fstat(fd, &info) == 0 && (info.st_mode & 0777) == (0666 & ~(before | 022));
    });
  }
}

TEST(ResourceLimitsTest, AFileThatGrowsTooLargeIsAnErrorAndNoSignal) {
  const ScratchDirectory scratch;
  ExpectInChild([&] {
    Limit(RLIMIT_FSIZE, 1000, 1000);
    if (!PrepareProgram()) return false;
    const Status written = WriteFileAtomically(scratch / "file", std::string(2000, 'x'), kOwnerOnly);
    return !written && written.error().message.find("(ulimit -f)") != std::string::npos;
  });
}

TEST(ResourceLimitsTest, TheSoftLimitOfOpenFilesIsRaisedAndTheHardOneNamed) {
  ExpectInChild([] {
    Limit(RLIMIT_NOFILE, 20, 300);
    rlimit now{};
    return PrepareProgram().ok() && AllowOpenFiles(200, "they").ok() && getrlimit(RLIMIT_NOFILE, &now) == 0 &&
           now.rlim_cur == 200 && AllowOpenFiles(100, "they").ok();
  });
  ExpectInChild([] {
    Limit(RLIMIT_NOFILE, 20, 20);
    const Status prepared = PrepareProgram();
    return !prepared && prepared.error().kind == ErrorKind::kInvalidInput &&
           prepared.error().message.find("at most 20 are allowed here (ulimit -Hn)") != std::string::npos;
  });
}

TEST(ResourceLimitsTest, AnExceptionForWantOfSomethingSaysOfWhatAndUnderWhichLimits) {
  const std::optional<Error> thread = ErrorOfResources(std::system_error(EAGAIN, std::generic_category()));
  ASSERT_TRUE(thread);
  EXPECT_EQ(thread->kind, ErrorKind::kNoSpace);
  EXPECT_THAT(thread->message, AllOf(testing::HasSubstr("a thread or a process could not be had"),
                                     testing::HasSubstr("Limits here: ")));
  EXPECT_THAT(ErrorOfResources(std::bad_alloc())->message, testing::HasSubstr("memory could not be had"));
  EXPECT_TRUE(ErrorOfResources(std::system_error(EMFILE, std::generic_category())));
  EXPECT_FALSE(ErrorOfResources(std::system_error(EINVAL, std::generic_category())));
  EXPECT_FALSE(ErrorOfResources(std::runtime_error("x")));
}

TEST(ResourceLimitsTest, LimitsAreDescribedInTheUnitsOfUlimit) {
  ExpectInChild([] {
    Limit(RLIMIT_NOFILE, 60, 60);
    Limit(RLIMIT_FSIZE, 8192, RLIM_INFINITY);
    const std::string limits = DescribeLimits();
    return limits.find("60 open files (ulimit -n)") != std::string::npos &&
           limits.find("8 kB in a file (ulimit -f)") != std::string::npos &&
           limits.find("(ulimit -v)") == std::string::npos;
  });
}

TEST(ResourceLimitsDeathTest, AnAbortOfALibraryIsASentenceAndOneOfOursIsAnAbort) {
  EXPECT_EXIT(
      {
        ExplainAborts("gauntlet-test");
        std::abort();
      },
      testing::ExitedWithCode(kExitWithoutResources),
      "gauntlet-test: a library ended this process, which could not get a thread, a file or memory. Limits "
      "here: .*open files");
  EXPECT_EXIT(
      {
        ExplainAborts("gauntlet-test");
        GAUNTLET_CHECK(1 + 1 == 3, "arithmetic");
      },
      testing::KilledBySignal(SIGABRT), "check failed: 1 . 1 == 3: arithmetic");
}

}  // namespace
}  // namespace gauntlet
