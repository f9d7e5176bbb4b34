#include "base/result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

namespace gauntlet {
namespace {

Result<int> Whole(const std::string& text) {
  if (text.empty()) return InvalidInput("nothing is no number");
  return static_cast<int>(text.size());
}

template <typename A, typename B>
Result<std::map<A, B>> MapOf(A key, B value) {
  return std::map<A, B>{{key, value}};
}

Result<std::unique_ptr<int>> Owned(int value) {
  return std::make_unique<int>(value);
}

Status Check(int value) {
  if (value > 3) return InvalidInput("more than 3");
  return Ok();
}

Result<int> SumOf(const std::string& first, const std::string& second) {
  TRY(const int a, Whole(first));
  TRY(Check(a));
  int b = 0;
  TRY(b, Whole(second));
  TRY(const auto map, MapOf<int, int>(a, b));
  TRY(const std::unique_ptr<int> owned, Owned(map.at(a)));
  return a + *owned;
}

TEST(Try, GoesOnWithTheValue) {
  const Result<int> sum = SumOf("ab", "abcd");
  ASSERT_TRUE(sum.ok());
  EXPECT_EQ(*sum, 6);
}

TEST(Try, ReturnsTheFirstErrorAsItIs) {
  const Result<int> unread = SumOf("ab", "");
  ASSERT_FALSE(unread.ok());
  EXPECT_EQ(unread.error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(unread.error().message, "nothing is no number");
  EXPECT_EQ(SumOf("abcd", "").error().message, "more than 3");
}

}  // namespace
}  // namespace gauntlet
