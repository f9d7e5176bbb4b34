#include "master/session/reproduction_bundle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "proto/case_json.h"
#include "proto/run_codec.h"
#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ReproductionBundleTest : public testing::Test {
 protected:
  void SetUp() override {
    experiment_ = LoadExperiment("flocking", {"seed=5"}, BuiltInCatalogue()).value();
    sim::TestCase test_case;
    test_case.name = "the one";
    test_case.obstacles = {{1.0, 2.0, 0.5, 0.1, 45.0}};
    run_.id = 17;
    run_.individual = 4;
    run_.evaluation = 1;
    run_.replicate = 2;
    run_.seed = 99;
    run_.spec = proto::EncodeRunSpec(SpecOf(experiment_, test_case, run_.seed));
    finished_.id = 17;
    finished_.result.verdict = sim::Verdict::kCrashed;
    finished_.result.message = "ended by signal 11";
    finished_.worker = "a1b2@host";
    finished_.stderr_tail = "Segmentation fault\n";
    context_ = {scratch_.path(), {"cafe", 1, "1.2.3", {{experiment_.controller, 0xdeadbeef}}}, {}};
    context_.limits.cpu_limit_seconds = 90.0;
    context_.limits.memory_limit_bytes = 1234567890;
  }
  std::string Read(const std::string& name) const { return ReadFile(scratch_ / ("bundles/run-17/" + name)); }

  ScratchDirectory scratch_;
  Experiment experiment_;
  StoredRun run_;
  FinishedRun finished_;
  BundleContext context_;
};

TEST_F(ReproductionBundleTest, HoldsAllThatIsNeededToSeeTheRunAgain) {
  const Status written = WriteBundle(context_, experiment_, run_, finished_);
  ASSERT_TRUE(written.ok()) << written.error().message;
  EXPECT_EQ(Read("run.spec"), run_.spec);
  EXPECT_EQ(Read("stderr.txt"), "Segmentation fault\n");
  const Result<sim::TestCase> test_case = proto::ParseCaseJson(Read("case.json"), "case.json");
  ASSERT_TRUE(test_case.ok()) << test_case.error().message;
  EXPECT_EQ(test_case->name, "the one");
  EXPECT_EQ(test_case->obstacles.size(), 1U);
  const Result<Experiment> experiment =
      ParseExperiment(Read("experiment.toml"), "experiment.toml", {}, BuiltInCatalogue());
  ASSERT_TRUE(experiment.ok()) << experiment.error().message;
  EXPECT_EQ(experiment->seed, 5U);
}

TEST_F(ReproductionBundleTest, SaysWhatHappenedAndTheOneCommandThatRepeatsIt) {
  ASSERT_TRUE(WriteBundle(context_, experiment_, run_, finished_).ok());
  EXPECT_THAT(Read("README.txt"),
              AllOf(HasSubstr("Run 17 of the campaign cafe"), HasSubstr("ended by signal 11"),
                    HasSubstr("(crashed)"), HasSubstr("a1b2@host"),
                    HasSubstr("gauntlet-worker --run-spec run.spec --cpu-limit 90 --memory-limit 1234567890"),
                    HasSubstr("individual    4, evaluation 1, replicate 2"),
                    HasSubstr("version       gauntlet 1.2.3"), HasSubstr("00000000deadbeef")));
}

TEST_F(ReproductionBundleTest, TellsTheLastLineThatWasPrinted) {
  EXPECT_EQ(LastWords(context_.directory, 17), "");
  finished_.stderr_tail = "loading\nuncaught exception: the weights are missing\n\n";
  ASSERT_TRUE(WriteBundle(context_, experiment_, run_, finished_).ok());
  EXPECT_EQ(LastWords(context_.directory, 17), "uncaught exception: the weights are missing");
}

TEST_F(ReproductionBundleTest, AnOlderOneIsReplaced) {
  ASSERT_TRUE(WriteBundle(context_, experiment_, run_, finished_).ok());
  finished_.stderr_tail = "Aborted\n";
  ASSERT_TRUE(WriteBundle(context_, experiment_, run_, finished_).ok());
  EXPECT_EQ(Read("stderr.txt"), "Aborted\n");
}

TEST_F(ReproductionBundleTest, WithoutAPlaceItIsAnErrorThatNamesIt) {
  WriteFile(scratch_ / "bundles", "a file");
  const Status written = WriteBundle(context_, experiment_, run_, finished_);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().message,
            (scratch_ / "bundles") + " is a file; here belongs a directory, or nothing");
}

TEST(LeavesBundleTest, WhatFailedOfItselfButNoRefusal) {
  EXPECT_TRUE(LeavesBundle(sim::Verdict::kCrashed));
  EXPECT_TRUE(LeavesBundle(sim::Verdict::kHung));
  EXPECT_TRUE(LeavesBundle(sim::Verdict::kOutOfMemory));
  EXPECT_FALSE(LeavesBundle(sim::Verdict::kCompleted));
  EXPECT_FALSE(LeavesBundle(sim::Verdict::kRefused));
  EXPECT_FALSE(LeavesBundle(sim::Verdict::kInvalidCommand));
}

}  // namespace
}  // namespace gauntlet
