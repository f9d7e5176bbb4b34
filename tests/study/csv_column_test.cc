#include "study/sets/csv_column.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/process.h"

namespace gauntlet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CsvColumnTest : public testing::Test {
 protected:
  Result<CsvColumn> Read(const std::string& text, const std::string& column) {
    std::ofstream(scratch_ / "a.csv", std::ios::binary) << text;
    return ReadCsvColumn(scratch_ / "a.csv", column);
  }
  testing_support::TemporaryDirectory scratch_;
};

TEST_F(CsvColumnTest, ReadsAColumnByItsName) {
  const std::string text = "\xef\xbb\xbfname,fitness\r\n\"a, \"\"b\"\"\",1.5\r\n\r\nc,-2e-3\r\n";
  const auto values = Read(text, "fitness");
  ASSERT_TRUE(values.ok()) << values.error().message;
  EXPECT_THAT(values->values, ElementsAre(1.5, -2e-3));
  EXPECT_THAT(Read("\"fitness\"\n1", "fitness")->values, ElementsAre(1));
  EXPECT_THAT(Read("fitness\n", "fitness")->values, testing::IsEmpty());
}

TEST_F(CsvColumnTest, LeavesEmptyCellsOutAndCountsThem) {
  const auto column = Read("run,fitness\n1,0.5\n2,\n3,\"\"\n4,2\n", "fitness");
  ASSERT_TRUE(column.ok()) << column.error().message;
  EXPECT_THAT(column->values, ElementsAre(0.5, 2));
  EXPECT_EQ(column->empty_cells, 2U);
}

TEST_F(CsvColumnTest, NamesWhatIsWrongAndWhere) {
  const auto message = [&](const std::string& text) { return Read(text, "fitness").error().message; };
  EXPECT_THAT(message(""), HasSubstr("its first line has to name the columns"));
  EXPECT_THAT(message("fitnes,b\n1,2\n"), HasSubstr("unknown column 'fitness'; did you mean 'fitnes'?"));
  EXPECT_THAT(message("fitness,b\n1,2\n\n1\n"), HasSubstr("a.csv:4: 1 cells, but 2 columns have a name"));
  EXPECT_THAT(message("b,fitness\n1,x\n"), HasSubstr("a.csv:2: fitness is 'x', not a finite number"));
  for (const char* value : {"nan", "NaN", "inf", "NA", "1 "}) {
    EXPECT_THAT(message("b,fitness\n1," + std::string(value) + "\n"), HasSubstr("not a finite number"))
        << value;
  }
  EXPECT_FALSE(ReadCsvColumn(scratch_ / "none.csv", "x").ok());
}

}  // namespace
}  // namespace gauntlet
