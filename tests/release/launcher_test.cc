// The launcher in a release of scripts: which loader it starts, and with which libraries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::ProcessResult;

class LauncherTest : public testing::Test {
 protected:
  LauncherTest() {
    for (const char* folder : {"bin", "lib/libc", "lib/libstdc++", "libexec", "elsewhere"})
      fs::create_directories(root() + "/" + folder);
    fs::copy_file(GAUNTLET_BINARY_DIR "/launcher", root() + "/bin/gauntlet");
    Script("libexec/gauntlet", "echo the machine\n");
    Release(9999);
    Library("lib/libstdc++", 9998);
  }

  std::string root() const { return fs::canonical(scratch_.path()); }
  void Script(const std::string& file, const std::string& text) const {
    std::ofstream(root() + "/" + file) << "#!/bin/sh\n" << text;
    fs::permissions(root() + "/" + file, fs::perms::owner_all);
  }
  // Of the loader in the release, which prints what it is given.
  void Release(int number) const {
    Script("lib/libc/ld-linux-x86-64.so.2", "# stable release version 2." + std::to_string(number) +
                                                ".\necho \"own $GAUNTLET_PROGRAM: $*\"\n");
  }
  void Library(const std::string& folder, int version) const {
    std::ofstream(root() + "/" + folder + "/libstdc++.so.6")
        << "GLIBCXX_3.4.7 GLIBCXX_3.4." << version << " x";
  }
  ProcessResult Start(const std::string& program, const std::string& paths = "") const {
    return testing_support::RunProcess({program, "show", "a b"}, {"LD_LIBRARY_PATH=" + paths});
  }

  testing_support::TemporaryDirectory scratch_;
};

TEST_F(LauncherTest, TakesTheReleasesOwnWhereTheMachineHasNothingNewer) {
  fs::create_symlink(root() + "/bin/gauntlet", root() + "/elsewhere/short");
  const std::string lib = root() + "/lib";
  EXPECT_EQ(Start(root() + "/elsewhere/short").out, "own " + root() + "/bin/gauntlet: --library-path " + lib +
                                                        ":" + lib + "/libc:" + lib + "/libstdc++ " + root() +
                                                        "/libexec/gauntlet show a b\n");
}

TEST_F(LauncherTest, TakesANewerLibraryOfTheMachineAndKeepsItsPaths) {
  Library("elsewhere", 9999);
  const std::string elsewhere = root() + "/elsewhere";
  EXPECT_THAT(
      Start(root() + "/bin/gauntlet", "/absent:" + elsewhere).out,
      AllOf(HasSubstr("/lib/libc:/absent:" + elsewhere + " --preload " + elsewhere + "/libstdc++.so.6 "),
            Not(HasSubstr("/lib/libstdc++"))));
}

TEST_F(LauncherTest, LeavesLibrariesOf32BitProgramsAlone) {
  std::ofstream(root() + "/elsewhere/libstdc++.so.6") << "\177ELF\1 GLIBCXX_3.4.9999 ";
  EXPECT_THAT(Start(root() + "/bin/gauntlet", root() + "/elsewhere").out, Not(HasSubstr("--preload")));
}

TEST_F(LauncherTest, TakesANewerLoaderOfTheMachine) {
  Release(1);
  Library("lib/libstdc++", 9999);
  const ProcessResult result = Start(root() + "/bin/gauntlet");
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("libexec/gauntlet: error while loading shared libraries"))
      << "this machine's loader says so";
}

TEST_F(LauncherTest, SaysWhatIsMissing) {
  fs::remove(root() + "/libexec/gauntlet");
  const ProcessResult result = Start(root() + "/bin/gauntlet");
  EXPECT_EQ(result.exit_code, 126);
  EXPECT_EQ(result.err,
            "gauntlet: cannot start: " + root() + "/libexec/gauntlet: No such file or directory\n");
}

}  // namespace
}  // namespace gauntlet
