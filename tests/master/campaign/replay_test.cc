// A stored run is simulated again and compared; the worker program is a script that answers what it is told
// to.
#include "master/campaign/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "proto/run_codec.h"
#include "tests/master/session/toy_campaign.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::MemoryStore;

class ReplayTest : public testing::Test {
 protected:
  void SetUp() override {
    Write("worker", "#!/bin/sh\ncat > '" + scratch_ / "asked" + "'\ncat '" + scratch_ / "answer" + "'\n");
    std::filesystem::permissions(scratch_ / "worker", std::filesystem::perms::owner_all);
    setenv("GAUNTLET_WORKER", (scratch_ / "worker").c_str(), 1);
    Answer(ToyRun(proto::DecodeRunSpec(store_.runs.at(5).spec).value()));
  }
  void TearDown() override { unsetenv("GAUNTLET_WORKER"); }
  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(scratch_ / name, std::ios::binary) << bytes;
  }
  void Answer(sim::RunResult result) const {
    sim::SetHashes(result);
    Write("answer", proto::EncodeRunResult(result));
  }

  testing_support::TemporaryDirectory scratch_;
  MemoryStore store_ = FinishedToyCampaign({ToyExperiment()});
};

TEST_F(ReplayTest, TheSameResultIsReproduced) {
  const Result<ReplayReport> report = ReplayRun(store_, 5);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_THAT(report->damage, IsEmpty());
  EXPECT_THAT(report->differences, IsEmpty());
  EXPECT_EQ(report->stored.id, 5U);
  EXPECT_EQ(report->spec.seed, report->stored.seed);
  std::ifstream asked(scratch_ / "asked", std::ios::binary);
  const Result<sim::RunSpec> spec =
      proto::DecodeRunSpec(std::string(std::istreambuf_iterator<char>(asked), {}));
  ASSERT_TRUE(spec.ok());
  EXPECT_TRUE(spec->record_trajectory);
  EXPECT_EQ(spec->seed, report->spec.seed);
}

TEST_F(ReplayTest, AnotherResultIsToldFieldByField) {
  sim::RunResult other = ToyRun(proto::DecodeRunSpec(store_.runs.at(5).spec).value());
  other.ticks += 1;
  other.metrics[0].second = 3.5;
  Answer(other);
  const Result<ReplayReport> report = ReplayRun(store_, 5);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_THAT(report->differences,
              ElementsAre(HasSubstr("hash differs"), HasSubstr("number of ticks differs"),
                          HasSubstr("metric fitness differs")));
}

TEST_F(ReplayTest, ARunThatIsNotThereIsNotFound) {
  const Result<ReplayReport> report = ReplayRun(store_, 5000);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().kind, ErrorKind::kNotFound);
}

TEST_F(ReplayTest, WhatDoesNotDecodeIsDamageAndNothingIsSimulated) {
  store_.runs.at(5).spec = "\x07";
  store_.runs.at(6).result = "\x07";
  for (const auto& [run, message] : {std::pair<RunId, const char*>{5, "the stored spec of run 5 is damaged"},
                                     {6, "the stored result of run 6 is damaged"}}) {
    const Result<ReplayReport> report = ReplayRun(store_, run);
    ASSERT_TRUE(report.ok()) << report.error().message;
    EXPECT_THAT(report->damage, HasSubstr(message));
  }
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "asked"));
}

TEST_F(ReplayTest, AChangedSpecIsADifference) {
  StoredRun& run = store_.runs.at(5);
  sim::RunSpec spec = proto::DecodeRunSpec(run.spec).value();
  spec.controller_parameters["gain"] = 2.0;
  run.spec = proto::EncodeRunSpec(spec);
  const Result<ReplayReport> report = ReplayRun(store_, 5);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_THAT(report->differences, ElementsAre(HasSubstr("the stored spec was changed")));
}

TEST_F(ReplayTest, ARowThatContradictsItsResultIsAnError) {
  store_.runs.at(5).fitness += 1.0;
  const Result<ReplayReport> report = ReplayRun(store_, 5);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().kind, ErrorKind::kCorrupt);
  EXPECT_THAT(report.error().message, HasSubstr("run 5 has fitness"));
}

TEST_F(ReplayTest, AWorkerProgramThatFailsIsAnError) {
  Write("worker", "#!/bin/sh\nexit 7\n");
  const Result<ReplayReport> report = ReplayRun(store_, 5);
  ASSERT_FALSE(report.ok());
  EXPECT_THAT(report.error().message, HasSubstr("ended with status 7"));
}

}  // namespace
}  // namespace gauntlet
