// Who is believed, without leases: workers say things of runs, and the policy answers.
// Covers: master/dispatch/trust/worker_record.cc
#include "master/dispatch/trust/trust_policy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace gauntlet {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Optional;

class TrustPolicyTest : public testing::Test {
 protected:
  static constexpr RunId kRun = 1;
  static constexpr Duration kNow{0};
  inline static const proto::RunnerFailure kCrash{proto::FailureKind::kCrashed, 11, 0};
  inline static const proto::RunnerFailure kHang{proto::FailureKind::kHung, 0, 0};

  TrustPolicyTest() {
    for (const InstanceId worker : all_) trust_.Meet(worker, "host");
  }
  // These have finished a run each.
  void Prove(const std::vector<InstanceId>& workers) {
    for (const InstanceId worker : workers) EXPECT_THAT(trust_.Finished(worker, next_proof_++), IsEmpty());
  }
  void Fail(InstanceId worker, RunId run = kRun, const proto::RunnerFailure& failure = kCrash) {
    trust_.Failed(worker, run, failure, kNow);
  }
  std::optional<Verdict> Judge(Duration now = kNow) { return trust_.Judge(kRun, all_, true, now); }

  std::vector<InstanceId> all_ = {10, 11, 12, 13};
  TrustPolicy trust_{{.attempts = 3, .patience = seconds(3)}};
  RunId next_proof_ = 1000;
};

TEST_F(TrustPolicyTest, AVerdictTakesAsManyTrustedWorkersAsAttempts) {
  Prove(all_);
  for (const InstanceId worker : {10U, 10U, 11U, 11U}) Fail(worker);
  EXPECT_FALSE(Judge());
  Fail(12);
  const auto verdict = Judge();
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->failure, kCrash);
  EXPECT_EQ(verdict->attempts, 5U);
  EXPECT_EQ(verdict->alike, 5U);
  EXPECT_EQ(verdict->workers, 3U);
}

TEST_F(TrustPolicyTest, AWorkerOfWhichOnlyEndsFromOutsideComeIsQuarantined) {
  for (RunId run = 1; run <= 3; ++run) {
    Fail(10, run, {proto::FailureKind::kExternal, 9, 0});
    EXPECT_EQ(trust_.Finished(11, run), run < 3 ? TrustPolicy::Workers{} : TrustPolicy::Workers{10});
  }
  EXPECT_EQ(
      InWords(trust_.RecordOf(10)),
      "3 of its runs, as it says, were ended from outside and then finished by other workers; it finished "
      "nothing");
  Prove({12});
  for (RunId run = 4; run <= 9; ++run) {
    Fail(12, run, {proto::FailureKind::kExternal, 9, 0});
    EXPECT_THAT(trust_.Finished(11, run), IsEmpty()) << "a memory killer may have been at it";
  }
}

TEST_F(TrustPolicyTest, WhereNobodyElseCanBeAskedOneWorkerIsEnough) {
  Prove({10});
  for (int i = 0; i < 3; ++i) Fail(10);
  const auto verdict = trust_.Judge(kRun, {10}, true, kNow);
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->workers, 1U);
}

TEST_F(TrustPolicyTest, OneHostCondemnsNothingWhileAnotherCanBeAsked) {
  trust_.Meet(13, "elsewhere");
  Prove(all_);
  for (const InstanceId worker : {10U, 11U, 12U}) Fail(worker);
  EXPECT_FALSE(Judge());
  EXPECT_THAT(trust_.NextFor(kRun, all_, all_, true), Optional(13U));
}

TEST_F(TrustPolicyTest, BeforeAnyRunWasFinishedVerdictsWaitForPatience) {
  for (const InstanceId worker : all_) Fail(worker);
  EXPECT_TRUE(trust_.PatienceLasts(seconds(2)));
  EXPECT_FALSE(Judge(seconds(2)));
  EXPECT_TRUE(Judge(seconds(3)));
}

TEST_F(TrustPolicyTest, TheVerdictIsWhatTrustedWorkersSayMostOften) {
  Prove({11, 12, 13});
  for (int i = 0; i < 4; ++i) Fail(10, kRun, kHang);
  for (const InstanceId worker : {11U, 12U, 13U}) Fail(worker);
  const auto verdict = Judge();
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->failure, kCrash);
  EXPECT_EQ(verdict->alike, 3U);
  EXPECT_EQ(verdict->attempts, 7U);
}

TEST_F(TrustPolicyTest, WhoIsContradictedThriceIsQuarantined) {
  for (const RunId run : {RunId{1}, RunId{2}}) {
    Fail(10, run);
    EXPECT_THAT(trust_.Finished(11, run), IsEmpty());
  }
  Fail(10, 3);
  EXPECT_THAT(trust_.Finished(11, 3), ElementsAre(10U));
  EXPECT_TRUE(trust_.RecordOf(10).quarantined);
  EXPECT_EQ(trust_.RecordOf(10).contradicted, 3U);
  EXPECT_FALSE(trust_.InDoubt(3));
}

TEST_F(TrustPolicyTest, AQuarantinedWorkersResultsContradictNobody) {
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(trust_.Strike(10));
  EXPECT_TRUE(trust_.Strike(10));
  Fail(11);
  EXPECT_THAT(trust_.Finished(10, kRun), IsEmpty());
  EXPECT_EQ(trust_.RecordOf(11).contradicted, 0U);
  EXPECT_EQ(trust_.RecordOf(10).finished, 0U);
}

TEST_F(TrustPolicyTest, AnUnreadableAnswerIsNoFailureOfTheRun) {
  Prove(all_);
  for (const InstanceId worker : all_) trust_.Failed(worker, kRun, std::nullopt, kNow);
  EXPECT_TRUE(trust_.InDoubt(kRun));
  EXPECT_FALSE(Judge());
  EXPECT_EQ(trust_.RecordOf(10).failed, 0U);
}

TEST_F(TrustPolicyTest, WhatIsDisregardedLeavesTheRunUndoubted) {
  Fail(10);
  EXPECT_THAT(trust_.TakeUnjudged(), ElementsAre(kRun));
  EXPECT_FALSE(trust_.Disregard(11, kRun));
  EXPECT_THAT(trust_.TakeUnjudged(), IsEmpty());
  EXPECT_TRUE(trust_.Disregard(10, kRun));
  EXPECT_FALSE(trust_.InDoubt(kRun));
}

TEST_F(TrustPolicyTest, ARunThatFailsOnTwoMakesNobodyABlackHole) {
  for (const RunId run : {RunId{1}, RunId{2}, RunId{3}}) Fail(10, run);
  EXPECT_TRUE(trust_.RecordOf(10).black_hole());
  Fail(11, 2);
  EXPECT_FALSE(trust_.RecordOf(10).black_hole());
}

TEST_F(TrustPolicyTest, TheNextToTryHasNotFailedItAndIsTrustedIfAnybodyIs) {
  Prove({10, 12});
  Fail(10);
  EXPECT_THAT(trust_.NextFor(kRun, all_, all_, false), Optional(12U));
  EXPECT_EQ(trust_.NextFor(kRun, {10}, all_, false), std::nullopt) << "it waits for another";
  EXPECT_THAT(trust_.NextFor(kRun, {10}, {10}, false), Optional(10U)) << "there is no other";
}

TEST_F(TrustPolicyTest, AHelperHasRatherNotFailedTheRun) {
  Prove({10, 12});
  EXPECT_THAT(trust_.HelperFor(kRun, {11, 12}), Optional(12U));
  Fail(12);
  EXPECT_THAT(trust_.HelperFor(kRun, {11, 12}), Optional(11U));
  EXPECT_THAT(trust_.HelperFor(kRun, {12}), Optional(12U));
  for (int i = 0; i < 2; ++i) Fail(12);
  EXPECT_EQ(trust_.HelperFor(kRun, {12}), std::nullopt);
}

TEST_F(TrustPolicyTest, AForgottenWorkersFailureKeepsTheTrustThatItHad) {
  Prove({10, 11, 12, 13});
  for (const InstanceId worker : {10U, 11U, 12U}) Fail(worker);
  trust_.Forget(10);
  EXPECT_TRUE(trust_.Judge(kRun, {11, 12, 13}, true, kNow));
}

TEST_F(TrustPolicyTest, OfAProgramThatMayBeRandomTheFirstEndingIsTheVerdict) {
  for (const Reproducible known : {Reproducible::kUnknown, Reproducible::kNo}) {
    trust_ = TrustPolicy({.attempts = 3, .patience = seconds(3), .reproducible = known});
    for (const InstanceId worker : all_) trust_.Meet(worker, "host");
    Fail(10, kRun, {proto::FailureKind::kExternal, 9, 0});
    trust_.Failed(11, kRun, std::nullopt, kNow);
    EXPECT_FALSE(Judge()) << "these say nothing of the run";
    Fail(12, kRun, kHang);
    Fail(13);
    const auto verdict = Judge();
    ASSERT_TRUE(verdict);
    EXPECT_EQ(verdict->worker, 12U);
    EXPECT_EQ(verdict->failure, kHang);
    EXPECT_TRUE(verdict->first_ending);
    EXPECT_FALSE(verdict->alone());
  }
}

TEST_F(TrustPolicyTest, AQuarantinedWorkersCrashIsNoEnding) {
  trust_ = TrustPolicy({.attempts = 3, .patience = seconds(3), .reproducible = Reproducible::kUnknown});
  for (const InstanceId worker : all_) trust_.Meet(worker, "host");
  for (int i = 0; i < 3; ++i) trust_.Strike(10);
  Fail(10);
  EXPECT_FALSE(Judge());
}

TEST_F(TrustPolicyTest, WhereNobodyContradictsItWhoFailsAloneIsQuarantined) {
  trust_ = TrustPolicy({.attempts = 3, .patience = seconds(3), .reproducible = Reproducible::kNo});
  for (const InstanceId worker : all_) trust_.Meet(worker, "host");
  for (int i = 0; i < 10; ++i) Prove({11});
  for (RunId run = 1; run < WorkerRecord::kMostInARow; ++run)
    EXPECT_FALSE(trust_.Failed(10, run, kCrash, kNow));
  EXPECT_TRUE(trust_.Failed(10, 99, kCrash, kNow));
  EXPECT_EQ(InWords(trust_.RecordOf(10)),
            "its last 8 runs failed, and other workers finished nearly all of theirs meanwhile");
}

TEST(TrustPolicyAudit, AuditsAboutItsShareOfRuns) {
  const TrustPolicy none({.audit_share = 0.0});
  const TrustPolicy quarter({.audit_share = 0.25});
  const TrustPolicy all({.audit_share = 1.0});
  int audited = 0;
  for (RunId run = 1; run <= 1000; ++run) {
    EXPECT_FALSE(none.Audits(run));
    EXPECT_TRUE(all.Audits(run));
    if (quarter.Audits(run)) ++audited;
  }
  EXPECT_NEAR(audited, 250, 50);
}

}  // namespace
}  // namespace gauntlet
