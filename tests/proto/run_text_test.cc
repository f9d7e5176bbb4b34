#include "proto/run_text.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace gauntlet::proto {
namespace {

constexpr RunId kSecondSearch = RunId{1} << kSequenceBits;

TEST(RunText, NamesTheSearchWhereItIsNotTheFirst) {
  EXPECT_EQ(RunText(15), "15");
  EXPECT_EQ(RunText(kSecondSearch + 15), "2:15");
  EXPECT_EQ(RunAddress(15), "1:15");
  EXPECT_EQ(ParseRun("1099511627791"), ParseRun("2:15")) << "2^40 + 15, as older versions wrote it";
}

TEST(RunText, ListsOfRunsAreRanges) {
  EXPECT_EQ(RunRanges({}), "");
  EXPECT_EQ(RunRanges({3}), "3");
  EXPECT_EQ(RunRanges({kSecondSearch + 7, 8, 3, 7, 4, 9}), "3, 4, 7 to 9, 2:7");
  std::vector<RunId> apart;
  for (RunId run = 1; run < 40; run += 2) apart.push_back(run);
  EXPECT_EQ(RunRanges(apart), "1, 3, 5, 7, 9, 11, 13, 15, 17, 19 and 10 more runs");
  EXPECT_EQ(RunFileName(15), "run-15");
  EXPECT_EQ(RunFileName(kSecondSearch + 15), "run-2-15") << "no colon, which scp takes for a host";
}

TEST(RunText, IsReadOnlyWhereItIsARun) {
  for (const char* none : {"", ":", "0", "-1", "1:", ":1", "0:1", "1:0", "1:2:3", " 1", "1.5", "a",
                           "1:1099511627776", "16777217:1", "18446744073709551616"})
    EXPECT_EQ(ParseRun(none), std::nullopt) << none;
}

RC_GTEST_PROP(RunTextProperty, ReadsBackAsTheSameRun, ()) {
  const auto search = *rc::gen::inRange<RunId>(0, 1U << 24U);
  const auto number = *rc::gen::inRange<RunId>(1, kSecondSearch);
  const RunId run = (search << kSequenceBits) + number;
  RC_ASSERT(ParseRun(RunText(run)) == run);
  RC_ASSERT(ParseRun(RunAddress(run)) == run);
}

}  // namespace
}  // namespace gauntlet::proto
