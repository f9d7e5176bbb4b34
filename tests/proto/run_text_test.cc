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
