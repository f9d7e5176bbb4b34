#include "base/nearest_name.h"

#include <array>

#include "gtest/gtest.h"

namespace gauntlet {
namespace {

constexpr std::array<std::string_view, 5> kKnown = {"bird_speed", "prey_speed", "birds", "time_limit",
                                                    "link_memory"};

TEST(EditDistance, CountsInsertionsDeletionsSubstitutionsAndSwaps) {
  EXPECT_EQ(EditDistance("", ""), 0u);
  EXPECT_EQ(EditDistance("", "abc"), 3u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
  EXPECT_EQ(EditDistance("ab", "ba"), 1u);
  EXPECT_EQ(EditDistance("ca", "abc"), 3u);
}

TEST(NearestName, FindsWhatWasMisspelt) {
  EXPECT_EQ(NearestName("bird_sped", kKnown), "bird_speed");
  EXPECT_EQ(NearestName("tiem_limit", kKnown), "time_limit");
  EXPECT_EQ(NearestName("bird", kKnown), "birds");
}

TEST(NearestName, CompletesABeginningOrAnEndThatBelongsToOneName) {
  EXPECT_EQ(NearestName("memory", kKnown), "link_memory");
  EXPECT_EQ(NearestName("prey", kKnown), "prey_speed");
  EXPECT_EQ(NearestName("_speed", kKnown), "");
}

TEST(NearestName, IsEmptyWhenNothingIsNear) {
  EXPECT_EQ(NearestName("mutation", kKnown), "");
  EXPECT_EQ(NearestName("", kKnown), "");
  EXPECT_EQ(NearestName("birds", {}), "");
}

}  // namespace
}  // namespace gauntlet
