#include "proto/golden_hashes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::proto {
namespace {

const GoldenHashes kTwo = {{"bird", 0x1f}, {"robot", ~std::uint64_t{0}}};

TEST(GoldenHashesTest, AreALineEachAndComeBack) {
  EXPECT_EQ(WriteGoldenHashes(kTwo), "bird 000000000000001f\nrobot ffffffffffffffff\n");
  const Result<GoldenHashes> read = ReadGoldenHashes(WriteGoldenHashes(kTwo));
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(*read, kTwo);
}

TEST(GoldenHashesTest, AnotherFormIsNotTaken) {
  for (const char* text : {"", "\n", "000000000000001f\n", "bird 1f\n", "bird 000000000000001g\n",
                           " 000000000000001f\n", "bird 000000000000001f robot\n"}) {
    const Result<GoldenHashes> read = ReadGoldenHashes(text);
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_EQ(read.error().kind, ErrorKind::kCorrupt);
  }
}

TEST(GoldenHashesTest, OnlyWhatIsNeededMustBeAlike) {
  EXPECT_FALSE(FirstDifference({}, kTwo).has_value());
  EXPECT_FALSE(FirstDifference({{"bird", 0x1f}}, {{"bird", 0x1f}, {"robot", 7}, {"newer", 8}}).has_value());

  const auto other = FirstDifference(kTwo, {{"bird", 0x1f}, {"robot", 7}});
  ASSERT_TRUE(other.has_value());
  EXPECT_EQ(other->controller, "robot");
  EXPECT_EQ(other->needed, ~std::uint64_t{0});
  EXPECT_EQ(other->offered, 7u);

  const auto none = FirstDifference(kTwo, {{"robot", 7}});
  ASSERT_TRUE(none.has_value());
  EXPECT_EQ(none->controller, "bird");
  EXPECT_FALSE(none->offered.has_value());
}

}  // namespace
}  // namespace gauntlet::proto
