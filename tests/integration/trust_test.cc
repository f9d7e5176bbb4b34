// Nobody is believed: neither other users of the machine nor workers that lie. The long forms are LongDrills.
#include <gtest/gtest.h>

#include "tests/integration/lying_workers_drill.h"
#include "tests/integration/other_user_drill.h"
#include "tests/integration/stranger.h"

namespace gauntlet::testing_support {
namespace {

TEST(TrustTest, WhatAnotherUserSendsChangesNothing) {
  if (!CanBeAnotherUser()) GTEST_SKIP() << "only root can be another user";
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 9;
  EvolveUnderForgery(campaign, scratch / "c", 50);
}

struct Mix {
  const char* name;
  std::vector<Lie> liars;
};

void PrintTo(const Mix& mix, std::ostream* os) {
  *os << mix.name;
}

class LyingWorkers : public testing::TestWithParam<Mix> {};

TEST_P(LyingWorkers, ChangeNothingAndAreNamed) {
  const TemporaryDirectory scratch;
  SmallCampaign campaign;
  campaign.generations = 6;
  EvolveWithLiars(campaign, scratch / "c", GetParam().liars, true);
}

INSTANTIATE_TEST_SUITE_P(Mixes, LyingWorkers,
                         testing::Values(Mix{"OneThatCrashes", {Lie::kCrash}},
                                         Mix{"OneThatAnswersForOthers", {Lie::kForeignLease}},
                                         Mix{"TwoThatHang", {Lie::kHang, Lie::kHang}},
                                         Mix{"ThreeSorts", {Lie::kCrash, Lie::kWrongHash, Lie::kSlow}}),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace gauntlet::testing_support
