#include "cli/adopt/project_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/process.h"

namespace gauntlet {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Key;
using testing::Pair;

class ProjectFolderTest : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text = "x") {
    const fs::path path = scratch_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path;
  }
  // Of the run folder that the script makes; argos3 is what `program` says.
  testing_support::ProcessResult RunIn(const std::string& folder, const RunFolderPlan& plan,
                                       const std::string& program) {
    fs::create_directories(scratch_ / folder);
    fs::create_directories(scratch_ / "bin");
    std::ofstream(scratch_ / "bin/argos3") << "#!/bin/sh\n" << program;
    fs::permissions(scratch_ / "bin/argos3", fs::perms::owner_all);
    std::ofstream(scratch_ / "run.sh") << RunScript(plan);
    return testing_support::RunProcess({"/bin/sh", "-c",
                                        "cd " + (scratch_ / folder) + " && PATH=" + (scratch_ / "bin") +
                                            ":$PATH exec sh ../run.sh case.argos 2>.gauntlet-stderr"});
  }

  testing_support::TemporaryDirectory scratch_;
};

TEST_F(ProjectFolderTest, IsWhereLibrariesAndMostOtherFilesAre) {
  const std::string file = Write("p/experiments/sub/my.argos");
  Write("p/build/libx.so");
  Write("p/experiments/build/libx");
  Write("p/lua/a.lua");
  EXPECT_EQ(*FindProjectFolder(file, {"build/libx"}, {}), fs::canonical(scratch_ / "p/experiments"));
  EXPECT_EQ(*FindProjectFolder(file, {"build/libx"}, {"lua/a.lua", "/etc/passwd"}),
            fs::canonical(scratch_ / "p"));
  const auto missing = FindProjectFolder(file, {"build/libx", "build/liby"}, {});
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().message, HasSubstr("its library build/liby is neither in "));
}

TEST_F(ProjectFolderTest, IsCopiedWithoutVersionControlAndLinksGoWhereTheyWent) {
  Write("p/a/b", "1");
  Write("p/.git/objects");
  Write("outside/c", "2");
  fs::create_symlink("b", scratch_ / "p/a/link");
  fs::create_symlink("../outside", scratch_ / "p/out");
  fs::create_directories(scratch_ / "copy");
  const std::string project = fs::canonical(scratch_ / "p");
  ASSERT_TRUE(CopyProject(project, scratch_ / "copy").ok());
  EXPECT_THAT(FilesIn(scratch_ / "copy"), ElementsAre(Key("a/b"), Key("a/link")));
  EXPECT_EQ(fs::read_symlink(scratch_ / "copy/out"), fs::canonical(scratch_ / "outside"));
  const auto before = FilesIn(scratch_ / "copy");
  Write("copy/a/b", "longer");
  EXPECT_NE(FilesIn(scratch_ / "copy"), before);
}

TEST_F(ProjectFolderTest, ARunWritesIntoItsOwnFolderAlone) {
  Write("p/data/in.txt", "in");
  Write("p/data/old.txt", "old\n");
  Write("p/.params", "1");
  Write("p/case.argos", "another");
  Write("run/case.argos", "0");
  Write("p/.git/HEAD");
  Write("p/large", std::string(100'000, 'x'));
  Write("outside/libx.so", "rebuilt");
  Write("outside/other", "2");
  fs::create_symlink("../outside", scratch_ / "p/build");
  fs::create_directory(scratch_ / "p/results");
  for (int i = 0; i < 30; ++i) Write("p/many/" + std::to_string(i));
  const auto before = FilesIn(scratch_ / "p");
  Write("run/own/lib/libx.so", "kept");
  const RunFolderPlan plan{.project = scratch_ / "p",
                           .own = "own",
                           .libraries = {{"build/libx.so", "libx.so"}},
                           .written = {"large", "logs/new.txt"}};
  // Also where adopt has seen nothing written.
  const auto ended =
      RunIn("run", plan,
            "cat case.argos data/in.txt build/libx.so build/other .params; echo new >> data/old.txt\n"
            "echo 1 > logs/new.txt; echo 2 > results/few.txt; echo 3 >> large\n"
            "ls -d .git many/7; echo $ARGOS_PLUGIN_PATH; touch gauntlet-trajectory.csv\n");
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.out, "0inkept21many/7\n" + (scratch_ / "run/own/plugins\n"));
  EXPECT_EQ(FilesIn(scratch_ / "p"), before);
  EXPECT_TRUE(fs::is_symlink(scratch_ / "run/many"));
}

// Another machine may have no such folder.
TEST_F(ProjectFolderTest, WithoutTheProjectNothingRuns) {
  const RunFolderPlan plan{.project = scratch_ / "gone", .own = "own", .libraries = {}, .written = {}};
  EXPECT_EQ(RunIn("run", plan, "touch gauntlet-trajectory.csv\n").exit_code, 1);
}

TEST_F(ProjectFolderTest, HowARunEndedIsSaid) {
  Write("p/a");
  const RunFolderPlan plan{.project = scratch_ / "p", .own = "own", .libraries = {}, .written = {}};
  const auto said = [&](const std::string& folder, const std::string& program) {
    const auto ended = RunIn(folder, plan, program);
    std::string text;
    std::getline(std::ifstream(scratch_ / (folder + "/.gauntlet-stderr")), text, '\0');
    return std::to_string(ended.exit_code) + ": " + text;
  };
  EXPECT_EQ(said("1", "exit 0\n"), "1: gauntlet: argos3 ended before the experiment did\n");
  EXPECT_EQ(said("2", "exit 7\n"), "7: ");
  const std::string no_room =
      "echo 'Error while trying to distribute entities' >&2; echo 'Impossible to place entity #6' >&2; exit "
      "1\n";
  EXPECT_THAT(said("3", no_room), testing::EndsWith("\ngauntlet: the robots find no room\n"));
  EXPECT_THAT(said("4", "touch gauntlet-trajectory.csv.draft; " + no_room),
              testing::Not(HasSubstr("find no room")))
      << "the experiment had begun";
}

}  // namespace
}  // namespace gauntlet
