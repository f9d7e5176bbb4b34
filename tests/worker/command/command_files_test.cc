// Definitions of commands and their files, as runners find and copy them.
#include "worker/command/command_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/worker/command/command_folder.h"

namespace gauntlet::worker {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CommandFilesTest : public testing::Test {
 protected:
  CommandFilesTest() {
    controllers::command::Definition definition = ShellDefinition("true");
    definition.files = {folder_.AddFile("sim.py", "#!/usr/bin/python3\n", true),
                        folder_.AddFile("worlds/small/a.world", "world\n", false),
                        folder_.AddFile("nothing", "", false)};
    tool_ = definition.files[0].hash;
    hash_ = folder_.Add(definition);
  }

  std::string OpenError(const PluginSettings& settings) {
    CommandFiles files(settings);
    const auto opened = files.Open(hash_);
    return opened ? "" : opened.error().message;
  }
  std::string LayError(CommandFiles& files) {
    const testing_support::TemporaryDirectory run;
    if (const auto opened = files.Open(hash_); !opened) return opened.error().message;
    const Status laid = files.LayInto(run.path(), hash_);
    return laid ? "" : laid.error().message;
  }

  CommandFolder folder_;
  std::string tool_;
  std::string hash_;
};

mode_t ModeOf(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
}

TEST_F(CommandFilesTest, LaysCopiesWithTheirNamesAndModes) {
  CommandFiles files(folder_.settings());
  ASSERT_TRUE(files.Open(hash_).ok());
  const testing_support::TemporaryDirectory run;
  ASSERT_TRUE(files.LayInto(run.path(), hash_).ok());
  EXPECT_EQ(ContentsOf(run / "sim.py"), "#!/usr/bin/python3\n");
  EXPECT_EQ(ModeOf(run / "sim.py"), 0755U);
  EXPECT_EQ(ContentsOf(run / "worlds/small/a.world"), "world\n");
  EXPECT_EQ(ModeOf(run / "worlds/small/a.world"), 0644U);
  EXPECT_EQ(fs::file_size(run / "nothing"), 0U);
  std::ofstream(run / "sim.py") << "changed by a run";
  EXPECT_EQ(LayError(files), "") << "a run has copies";
}

TEST_F(CommandFilesTest, AreFoundByTheFileThatIsNamed) {
  EXPECT_EQ(OpenError({.files = {"/no/library.so", folder_.PathOf(hash_)}}), "");
  fs::rename(folder_.PathOf(hash_), folder_.path() + "/mine.command");
  CommandFiles files({.files = {folder_.path() + "/mine.command"}});
  EXPECT_EQ(LayError(files), "");
}

TEST_F(CommandFilesTest, WhatIsMissingIsNamed) {
  const std::string asked = "the run needs the command " + hash_ + ": give its file by --plugin";
  EXPECT_EQ(OpenError({}), asked);
  EXPECT_EQ(OpenError({.files = {"/no/library.so"}}), asked);
  fs::remove(folder_.PathOf(hash_));
  EXPECT_THAT(OpenError(folder_.settings()), HasSubstr(folder_.PathOf(hash_)));
}

TEST_F(CommandFilesTest, AnotherDefinitionOrFileIsRefusedByItsHash) {
  CommandFiles files(folder_.settings());
  EXPECT_EQ(LayError(files), "");
  // In place, of the same size, also after it was verified.
  std::ofstream(folder_.PathOfFile(tool_)) << "#!/usr/bin/python2\n";
  EXPECT_THAT(LayError(files), HasSubstr(tool_ + " is not what the run was made for: its SHA-256 is "));
  std::ofstream(folder_.PathOfFile(tool_)) << "#!/usr/bin/python3\n";
  EXPECT_EQ(LayError(files), "");
  fs::remove(folder_.PathOfFile(tool_));
  EXPECT_THAT(LayError(files), HasSubstr(tool_));
  std::ofstream(folder_.PathOf(hash_), std::ios::app) << " ";
  EXPECT_THAT(OpenError(folder_.settings()), HasSubstr("is not what the run was made for"));
}

TEST_F(CommandFilesTest, WhatOthersMayWriteIsRefused) {
  for (const std::string& path :
       {folder_.path(), folder_.PathOf(hash_), folder_.path() + "/files", folder_.PathOfFile(tool_)}) {
    const mode_t before = ModeOf(path);
    chmod(path.c_str(), before | S_IWGRP);
    CommandFiles files(folder_.settings());
    EXPECT_THAT(LayError(files), HasSubstr("other users may write it")) << path;
    chmod(path.c_str(), before);
  }
  CommandFiles files(folder_.settings());
  EXPECT_EQ(LayError(files), "");
}

TEST_F(CommandFilesTest, LinksAreNotFollowed) {
  fs::rename(folder_.PathOfFile(tool_), folder_.path() + "/elsewhere");
  fs::create_symlink("../elsewhere", folder_.PathOfFile(tool_));
  CommandFiles files(folder_.settings());
  EXPECT_THAT(LayError(files), HasSubstr(tool_));
}

}  // namespace
}  // namespace gauntlet::worker
