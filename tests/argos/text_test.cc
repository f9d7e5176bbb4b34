// Covers: argos/utility/color.cc, argos/utility/string_utilities.cc
#include <argos3/core/utility/datatypes/any.h>
#include <argos3/core/utility/datatypes/set.h>
#include <argos3/core/utility/string_utilities.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace argos {
namespace {

TEST(Texts, AreCutJoinedAndMatched) {
  std::vector<std::string> tokens;
  Tokenize("  a b  c", tokens);
  EXPECT_EQ(tokens, (std::vector<std::string>{"a", "b", "c"}));
  std::string text = "a-b-c";
  Replace(text, "-", "--");
  EXPECT_EQ(text, "a--b--c");
  EXPECT_EQ(StringToUpperCase("fb0"), "FB0");
  EXPECT_TRUE(MatchPattern("fb12", "^fb[0-9]+$"));
  EXPECT_FALSE(MatchPattern("xfb12", "^fb[0-9]+$"));
  EXPECT_EQ(ToString(true), "true");
  EXPECT_EQ(FromString<int>("42"), 42);
}

TEST(Texts, ParseTheNumberOfValuesThatIsAskedFor) {
  double values[2] = {};
  ParseValues<double>(std::string("1.5,2"), 2, values, ',');
  EXPECT_EQ(values[1], 2.0);
  EXPECT_THROW(ParseValues<double>(std::string("1.5"), 2, values, ','), CARGoSException);
}

TEST(Exceptions, SayWhatIsNested) {
  std::runtime_error inner("inner");
  EXPECT_STREQ(CARGoSException("outer", &inner).what(), "[FATAL] outer\ninner");
  try {
    THROW_ARGOSEXCEPTION("robot " << 7);
  } catch (const CARGoSException& error) {
    EXPECT_STREQ(error.what(), "[FATAL] robot 7");
  }
}

TEST(Set, IsSortedWithoutDuplicates) {
  CSet<int> set;
  for (const int value : {3, 1, 3, 2}) set.insert(value);
  EXPECT_THAT(std::vector<int>(set.begin(), set.end()), testing::ElementsAre(1, 2, 3));
  set.erase(2);
  EXPECT_FALSE(set.exists(2));
  EXPECT_EQ(set.last(), 3);
}

TEST(Any, GivesBackItsExactTypeOnly) {
  CAny box = 7;
  EXPECT_EQ(any_cast<int>(box), 7);
  any_cast<int&>(box) = 8;
  EXPECT_EQ(*any_cast<int>(&box), 8);
  EXPECT_EQ(any_cast<long>(&box), nullptr);
  EXPECT_THROW(any_cast<long>(box), CARGoSException);
}

}  // namespace
}  // namespace argos
