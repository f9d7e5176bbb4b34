#include "cli/output/table.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace gauntlet {
namespace {

TEST(Table, AlignsColumnsAndLeavesNoTrailingBlanks) {
  Table table({"name", ">runs", "note"});
  table.AddRow({"first", "7", "x"});
  table.AddRow({"a longer name", "1,234"});
  EXPECT_EQ(table.ToText(),
            "  name            runs  note\n"
            "  first              7  x\n"
            "  a longer name  1,234\n");
}

TEST(Table, WithoutHeadersThereIsNoHeaderLine) {
  Table table({"", ">"});
  table.AddRow({"a", "10"});
  table.AddRow({"bc", "9"});
  EXPECT_EQ(table.ToText(0),
            "a   10\n"
            "bc   9\n");
}

TEST(Table, CountsCharactersNotBytes) {
  Table table({"", ""});
  table.AddRow({"D\u00fcsseldorf", "|"});
  table.AddRow({"Duesseldorf", "|"});
  EXPECT_EQ(table.ToText(0),
            "D\u00fcsseldorf   |\n"
            "Duesseldorf  |\n");
}

TEST(Wrapped, BreaksAtBlanksAndIndents) {
  EXPECT_EQ(Wrapped("one two three four", 9, 2), "one two\n  three\n  four");
  EXPECT_EQ(Wrapped("unbreakable", 4, 2), "unbreakable");
  EXPECT_EQ(Wrapped("", 4, 2), "");
}

TEST(FormatCount, GroupsThousands) {
  EXPECT_EQ(FormatCount(0), "0");
  EXPECT_EQ(FormatCount(999), "999");
  EXPECT_EQ(FormatCount(1000), "1,000");
  EXPECT_EQ(FormatCount(1234567), "1,234,567");
}

TEST(FormatFitness, NamesNoNumberForWhatDoesNotExist) {
  EXPECT_EQ(FormatFitness(0.25), "0.250");
  EXPECT_EQ(FormatFitness(std::numeric_limits<double>::quiet_NaN()), "-");
  EXPECT_EQ(FormatFitness(std::numeric_limits<double>::infinity()), "-");
}

}  // namespace
}  // namespace gauntlet
