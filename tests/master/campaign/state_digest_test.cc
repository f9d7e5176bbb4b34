#include "master/campaign/state_digest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <functional>

#include "master/store/run_numbers.h"

namespace gauntlet {
namespace {

StoredRun MakeRun(RunId id) {
  StoredRun run;
  run.id = id;
  run.search = 1;
  run.individual = 10 + id;
  run.evaluation = 2;
  run.replicate = 3;
  run.seed = 0xfedcba9876543210ULL;
  run.hash = 0x0123456789abcdefULL;
  return run;
}

ResultsDigest DigestOf(const std::vector<StoredRun>& runs) {
  ResultsDigest digest;
  for (const StoredRun& run : runs) digest.Add(run);
  return digest;
}

// Computed from master/store/README.md with another implementation of BLAKE2b.
TEST(StateHashTest, IsWhatTheDocumentSays) {
  EXPECT_EQ(StateHash("", ResultsDigest(), "", ""),
            "6e4ed5f55ab4d12542f9b8985a2ef5ff68f23ef6e7898c7f4a5671dffd715e91");
  EXPECT_EQ(
      StateHash("seed = 1\n", DigestOf({MakeRun(1), MakeRun(2)}), "population", std::string("state\0x", 7)),
      "3a0fb7b1622879e7dd1268987e0801ff2acafd3f97e9fb8f332c2ff93aae3805");
}

TEST(StateHashTest, EveryIngredientCounts) {
  const std::string hash = StateHash("e", DigestOf({MakeRun(1)}), "p", "s");
  EXPECT_EQ(hash, StateHash("e", DigestOf({MakeRun(1)}), "p", "s"));
  EXPECT_NE(hash, StateHash("E", DigestOf({MakeRun(1)}), "p", "s"));
  EXPECT_NE(hash, StateHash("e", DigestOf({MakeRun(2)}), "p", "s"));
  EXPECT_NE(hash, StateHash("e", DigestOf({MakeRun(1)}), "P", "s"));
  EXPECT_NE(hash, StateHash("e", DigestOf({MakeRun(1)}), "p", "S"));
  // Borders between the parts count too.
  EXPECT_NE(StateHash("ab", {}, "", ""), StateHash("a", {}, "b", ""));
  EXPECT_NE(StateHash("", {}, "ab", ""), StateHash("", {}, "a", "b"));
}

struct Change {
  std::string name;
  std::function<void(StoredRun&)> change;
};

TEST(ResultsDigestTest, EveryLogicalFieldOfAResultCounts) {
  const std::vector<Change> changes = {
      {"id", [](StoredRun& run) { ++run.id; }},
      {"individual", [](StoredRun& run) { ++run.individual; }},
      {"evaluation", [](StoredRun& run) { ++run.evaluation; }},
      {"replicate", [](StoredRun& run) { ++run.replicate; }},
      {"seed", [](StoredRun& run) { ++run.seed; }},
      {"hash", [](StoredRun& run) { ++run.hash; }},
      {"verdict", [](StoredRun& run) { run.verdict = sim::Verdict::kRefused; }},
  };
  for (const Change& change : changes) {
    StoredRun run = MakeRun(1);
    change.change(run);
    EXPECT_NE(DigestOf({run}).bytes(), DigestOf({MakeRun(1)}).bytes()) << change.name;
  }
}

TEST(ResultsDigestTest, IsThatOfTheCampaignsOnlySearch) {
  StoredRun run = MakeRun(RunIdOf(3, 1));
  run.search = 3;
  run.individual = MakeRun(1).individual;
  EXPECT_EQ(DigestOf({run}).bytes(), DigestOf({MakeRun(1)}).bytes());
}

TEST(ResultsDigestTest, WhoDidItAndHowOftenItWasTriedDoesNotCount) {
  StoredRun run = MakeRun(1);
  run.worker = "another@host";
  run.attempt = 17;
  run.spec = "handed over";
  run.result = "handed over";
  EXPECT_EQ(DigestOf({run}).bytes(), DigestOf({MakeRun(1)}).bytes());
}

TEST(ResultsDigestTest, OrderAndNumberCount) {
  EXPECT_NE(DigestOf({MakeRun(1), MakeRun(2)}).bytes(), DigestOf({MakeRun(2), MakeRun(1)}).bytes());
  EXPECT_NE(DigestOf({MakeRun(1)}).bytes(), DigestOf({MakeRun(1), MakeRun(1)}).bytes());
  EXPECT_EQ(DigestOf({}).bytes(), std::string(32, '\0'));
}

RC_GTEST_PROP(ResultsDigestProperty, ResumedAnywhereItEndsTheSame, ()) {
  const auto ids = *rc::gen::container<std::vector<RunId>>(rc::gen::arbitrary<RunId>());
  const auto cut = *rc::gen::inRange<std::size_t>(0, ids.size() + 1);
  ResultsDigest whole;
  ResultsDigest digest;
  for (std::size_t i = 0; i <= ids.size(); ++i) {
    if (i == cut) {
      Result<ResultsDigest> restored = ResultsDigest::Restore(digest.bytes());
      RC_ASSERT(restored.ok());
      digest = *restored;
    }
    if (i == ids.size()) break;
    whole.Add(MakeRun(ids[i]));
    digest.Add(MakeRun(ids[i]));
  }
  RC_ASSERT(digest.bytes() == whole.bytes());
}

TEST(ResultsDigestTest, OnlyThirtyTwoBytesAreRestored) {
  for (const std::size_t size : {0, 31, 33}) {
    const Result<ResultsDigest> restored = ResultsDigest::Restore(std::string(size, 'x'));
    ASSERT_FALSE(restored.ok());
    EXPECT_EQ(restored.error().kind, ErrorKind::kCorrupt);
    EXPECT_EQ(restored.error().message,
              "a results digest of " + std::to_string(size) + " bytes instead of 32");
  }
}

}  // namespace
}  // namespace gauntlet
