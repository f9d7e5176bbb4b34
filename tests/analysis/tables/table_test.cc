// Covers: analysis/tables/cell.cc
#include "analysis/tables/table.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

// One row with every kind of cell.
Table Everything() {
  Table table({{"name", "name"},
               {">runs", "runs"},
               {">fitness", "fitness"},
               {">failed", "k n"},
               {">probability", "interval"},
               {"ok", "ok"},
               ForPrograms("parents"),
               {"", "message?"},
               OnTerminals("to see it"),
               OnPages("seen")});
  table.AddRow({LinkCell("a|<b>\n", "#run-1"), CountCell(1234), FitnessCell(0.25), OutOfCell(3, 5),
                PercentCell({0.125, 0.8}), true, JsonCell({1, 2}), TextCell(""), "gauntlet", 7});
  table.AddRow({"c", 1ULL << 60, FitnessCell(std::numeric_limits<double>::quiet_NaN()), OutOfCell(0, 5),
                IntervalCell(std::nullopt), false, JsonCell({}), "lost"});
  return table;
}

TEST(Table, TellsPeopleAndProgramsTheSame) {
  EXPECT_EQ(Everything().ToText(),
            "  name                    runs  fitness  failed   probability  ok         to see it\n"
            "  a|<b>\\n                1,234    0.250  3 of 5   12 to  80 %  yes        gauntlet\n"
            "  c        1152921504606846976        -  0 of 5             -  no   lost\n");
  EXPECT_EQ(
      Everything().ToJson().dump(),
      R"([{"name":"a|<b>\n","runs":1234,"fitness":0.25,"k":3,"n":5,"interval":[0.125,0.8],"ok":true,)"
      R"("parents":[1,2]},)"
      R"({"name":"c","runs":"1152921504606846976","fitness":null,"k":0,"n":5,"interval":null,"ok":false,)"
      R"("parents":null,"message":"lost"}])");
}

TEST(Table, PagesObeyNothingThatACellHolds) {
  Table table({"name", ">n<b>", OnTerminals("hidden")});
  table.AddRow({LinkCell("<i>x</i>", "#run-1"), 3, "never"});
  EXPECT_EQ(table.ToHtml(),
            "<div class=\"scroll\"><table><thead><tr><th scope=\"col\">name</th><th scope=\"col\" "
            "class=\"number\">n&lt;b&gt;</th></tr></thead><tbody>\n<tr><td><a "
            "href=\"#run-1\">&lt;i&gt;x&lt;/i&gt;</a></td><td "
            "class=\"number\">3</td></tr>\n</tbody></table></div>\n");
}

TEST(Table, WithoutTitlesAPageTellsFacts) {
  Table table({"", ""});
  table.AddRow({"runs", CountCell(5000)});
  table.AddRow({"nothing", ""});
  EXPECT_EQ(table.ToHtml(),
            "<div class=\"scroll\"><table class=\"facts\"><tbody>\n<tr><th "
            "scope=\"row\">runs</th><td>5,000</td></tr>\n</tbody></table></div>\n");
}

TEST(Table, MarkdownEscapesItsBars) {
  Table table({"a", ">b"});
  table.AddRow({"x|y", 1});
  EXPECT_EQ(table.ToMarkdown(), "| a | b |\n|---|---:|\n| x\\|y | 1 |\n\n");
}

TEST(Table, CsvHoldsValuesNotTexts) {
  Table table({"a", ">b", "c"});
  table.AddRow({"x,\"y\"", DecimalCell(1.0 / 3.0, 1), true});
  table.AddRow({Cell(), -3, CountCell(1000)});
  EXPECT_EQ(table.ToCsv(), "a,b,c\n\"x,\"\"y\"\"\",0.3333333333333333,TRUE\n,-3,1000\n");
}

// Names of cases are names of files, which anybody chooses.
TEST(Table, CsvHoldsNothingThatASpreadsheetExecutes) {
  Table table({"name", ">x"});
  for (const char* name : {"=cmd()", "+1", "@x", "-x", "-", "a=b"}) table.AddRow({name, -3});
  EXPECT_EQ(table.ToCsv(), "name,x\n'=cmd(),-3\n'+1,-3\n'@x,-3\n'-x,-3\n-,-3\na=b,-3\n");
}

TEST(Table, FirstAndThinnedLeaveRowsOut) {
  Table table({""});
  for (int i = 1; i <= 10; ++i) table.AddRow({i});
  EXPECT_EQ(table.First(2).ToText(0), "1\n2\n");
  EXPECT_EQ(table.First(20).size(), 10U);
  EXPECT_EQ(table.Thinned(4).ToText(0), "1\n4\n7\n10\n");
  EXPECT_EQ(table.Thinned(10).size(), 10U);
}

}  // namespace
}  // namespace gauntlet
