#include "controllers/command/metric_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/process.h"

namespace gauntlet::controllers::command {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryDirectory;

// The number, or what is wrong.
std::string Read(const std::string& source, std::string_view out, std::string_view err = "") {
  const Result<double> number = ReadSource(source, out, err, "");
  return number.ok() ? std::to_string(*number) : number.error().message;
}

TEST(LogSource, TakesTheLastMatchAndItsFirstGroup) {
  EXPECT_EQ(Read("log:items (\\d+)", "items 3\nitems 4 items 5\nend\n"), "5.000000");
  EXPECT_EQ(Read("log:-?\\d+\\.\\d+e-?\\d+", "x -1.5e-1 y\n"), "-0.150000");
}

TEST(LogSource, SeesNoColoursAndNoCarriageReturns) {
  EXPECT_EQ(Read("log:items: (\\d+)$", "\x1b[1;32mitems: \x1b[0m7\x1b[0m\r\n"), "7.000000");
}

TEST(LogSource, StandardErrorIsReadWhereStandardOutputSaysNothing) {
  EXPECT_EQ(Read("log:n=(\\d+)", "n=1", "n=2"), "1.000000");
  EXPECT_EQ(Read("log:n=(\\d+)", "", "n=2"), "2.000000");
}

TEST(LogSource, LooksAtTheBeginningOfALineOnly) {
  EXPECT_EQ(Read("log:(\\d)$", std::string(kMostLineBytes, 'x') + "5\n"),
            "nothing that it printed matches (\\d)$");
}

TEST(LogSource, AHostilePatternTakesLinearTime) {
  const std::string text(kMostLineBytes, 'a');
  EXPECT_THAT(Read("log:(a*)*b", text), HasSubstr("nothing that it printed matches"));
}

TEST(LogSource, WhatIsNoFiniteNumberIsSaid) {
  EXPECT_EQ(Read("log:v=(\\S+)", "v=nan"),
            "the last match of v=(\\S+) says 'nan', which is no finite number");
  EXPECT_THAT(Read("log:v=(\\S+)", "v=many"), HasSubstr("'many', which is no finite number"));
}

class CsvSource : public testing::Test {
 protected:
  std::string Read(const std::string& content, const std::string& column) {
    std::ofstream(scratch_ / "t.csv") << content;
    const Result<double> number = ReadSource("csv:t.csv:" + column, "", "", scratch_.path());
    return number.ok() ? std::to_string(*number) : number.error().message;
  }
  TemporaryDirectory scratch_;
};

TEST_F(CsvSource, TakesTheLastRowOfANamedOrNumberedColumn) {
  EXPECT_EQ(Read("time,score\n0,1\n1, 2.5\n\n", "score"), "2.500000");
  EXPECT_EQ(Read("0;1\n1;+3\n", "2"), "3.000000");
  EXPECT_EQ(Read("# clock  score\n1  2\n3    4\n", "2"), "4.000000");
  EXPECT_EQ(Read("\"time\"\t\"score\"\n1\t9\n", "score"), "9.000000");
}

TEST_F(CsvSource, SaysWhatIsMissing) {
  EXPECT_THAT(Read("time,score\n0,1\n", "scor"), HasSubstr("unknown column 'scor'; did you mean 'score'?"));
  EXPECT_EQ(Read("time,score\n", "score"), "its file t.csv has no rows");
  EXPECT_EQ(Read("1,2\n3\n", "2"), "the last row of its file t.csv has no column 2");
  EXPECT_THAT(Read("a,b\n1,x\n", "b"), HasSubstr("says 'x', which is no finite number"));
  const Result<double> none = ReadSource("csv:other.csv:1", "", "", scratch_.path());
  EXPECT_EQ(none.error().message, "it has left no file other.csv");
}

TEST(MetricSource, IsOneOfTwo) {
  EXPECT_TRUE(CheckSource("csv:a:b:c").ok());
  for (const char* wrong : {"", "log:", "csv:", "csv:a", "csv:a:", "csv::a", "score"})
    EXPECT_FALSE(CheckSource(wrong).ok()) << wrong;
}

TEST(Refusals, AreWholeLines) {
  EXPECT_EQ(FirstLineWith("no room", "a\n\x1b[31mno room here\nno room there\n"), "no room here");
  EXPECT_EQ(FirstLineWith("no room", "a\n"), std::nullopt);
}

}  // namespace
}  // namespace gauntlet::controllers::command
