#include "master/directory/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "base/system/sha256.h"
#include "controllers/run_start.h"
#include "master/directory/plugins.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryDirectory;

class CommandsTest : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& content) {
    std::ofstream(scratch_ / name) << content;
  }
  ExperimentText Experiment(const std::string& more) {
    return {
        "scenario = \"command\"\n[command]\nrun = [\"./sim\", \"{case}\"]\nmetrics = [\"items\"]\n"
        "fitness = \"items\"\nfailure = \"items < 5\"\n" +
            more,
        scratch_ / "my.toml"};
  }
  Result<controllers::command::Definition> Added(const std::string& more,
                                                 const std::vector<std::string>& allowed = {}) {
    TRY(const std::optional<std::string> hash, AddCommandOf(Experiment(more), {}, allowed));
    return CommandOf(*hash);
  }
  std::string ErrorOf(const std::string& more) {
    const auto added = Added(more);
    return added.ok() ? "" : added.error().message;
  }

  TemporaryDirectory scratch_;
};

TEST_F(CommandsTest, FilesAndFoldersAreNamedByTheirContent) {
  Write("sim", "#!/bin/sh\n");
  chmod((scratch_ / "sim").c_str(), 0755);
  std::filesystem::create_directories(scratch_ / "maps/deep");
  Write("maps/deep/a.png", "a");
  Write("maps/b.png", "b");
  const auto definition = Added("files = [\"sim\", \"maps\"]\n");
  ASSERT_TRUE(definition.ok()) << definition.error().message;
  ASSERT_EQ(definition->files.size(), 3U);
  EXPECT_EQ(definition->files[0].name, "maps/b.png");
  EXPECT_EQ(definition->files[0].hash, Sha256("b"));
  EXPECT_EQ(definition->files[1].name, "maps/deep/a.png");
  EXPECT_TRUE(definition->files[2].executable);
  EXPECT_FALSE(definition->files[0].executable);
}

TEST_F(CommandsTest, WhatBecomesOfAFileAfterwardsChangesNothing) {
  Write("sim", "first");
  const auto hash = AddCommandOf(Experiment("files = [\"sim\"]\n"), {}, {});
  ASSERT_TRUE(hash.ok()) << hash.error().message;
  Write("sim", "second");
  const std::string kept = controllers::FindPlugin(**hash)->file;
  TemporaryDirectory campaign;
  ASSERT_TRUE(CopyCommandFiles(kept, campaign.path()).ok());
  EXPECT_TRUE(std::filesystem::exists(campaign / ("files/" + Sha256("first"))));
  const auto again = AddCommandOf(Experiment("files = [\"sim\"]\n"), {}, {});
  ASSERT_TRUE(again.ok());
  EXPECT_NE(**again, **hash) << "another file, another command";
}

TEST_F(CommandsTest, FilesStayBelowTheExperimentUnlessTheUserNamesThem) {
  TemporaryDirectory elsewhere;
  std::ofstream(elsewhere / "data.bin") << "data";
  std::filesystem::create_symlink(elsewhere / "data.bin", scratch_ / "link");
  std::filesystem::create_directory_symlink(elsewhere.path(), scratch_ / "folder");
  EXPECT_THAT(ErrorOf("files = [\"missing\"]\n"), HasSubstr("[command] files: there is no "));
  EXPECT_THAT(ErrorOf("files = [\"link\"]\n"), HasSubstr("link"));
  EXPECT_THAT(ErrorOf("files = [\"folder/data.bin\"]\n"), HasSubstr("leads out of"));
  const auto allowed = Added("", {elsewhere / "data.bin"});
  ASSERT_TRUE(allowed.ok()) << allowed.error().message;
  EXPECT_EQ(allowed->files.at(0).name, "data.bin");
  Write("data.bin", "ours");
  const auto twice = Added("files = [\"data.bin\"]\n", {elsewhere / "data.bin"});
  EXPECT_THAT(twice.error().message, HasSubstr("two are called data.bin"));
}

TEST_F(CommandsTest, ATemplateIsOneOfTheFilesAndRight) {
  Write("course.xml", "<a/>\n");
  EXPECT_THAT(ErrorOf("template = \"course.xml\"\n"),
              HasSubstr("template = \"course.xml\" is none of `files`"));
  EXPECT_THAT(ErrorOf("template = \"course.xml\"\nfiles = [\"course.xml\"]\n"),
              HasSubstr("course.xml: there is no line with @obstacles@"));
}

TEST_F(CommandsTest, ADefinitionReadsBackFromItsFile) {
  const auto hash = AddCommandOf(Experiment("cores = 3\n"), {"command.cores=2"}, {});
  ASSERT_TRUE(hash.ok()) << hash.error().message;
  EXPECT_EQ(CommandOf(**hash)->cores, 2);
  const auto from_file = AddPluginFile(controllers::FindPlugin(**hash)->file);
  ASSERT_TRUE(from_file.ok()) << from_file.error().message;
  EXPECT_EQ(*from_file, **hash);
  Write("x.command", "{}");
  EXPECT_THAT(AddPluginFile(scratch_ / "x.command").error().message,
              HasSubstr("it is no definition of a command"));
}

TEST_F(CommandsTest, ItsRunsBeginWithARobotlessStart) {
  const auto hash = AddCommandOf(Experiment("robot_radius = 0.2\n"), {}, {});
  ASSERT_TRUE(hash.ok());
  sim::RunSpec spec;
  spec.scenario = controllers::command::kScenario;
  spec.scenario_plugin = **hash;
  spec.plugin = **hash;
  spec.controller = controllers::command::kController;
  const auto requirements = controllers::RequirementsOf(spec);
  ASSERT_TRUE(requirements.ok()) << requirements.error().message;
  EXPECT_EQ(requirements->inflation, 0.2);
  EXPECT_EQ(controllers::CountSwarm(spec)->robots, 0U);
}

}  // namespace
}  // namespace gauntlet
