#include "report/tables/data_table.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gauntlet {
namespace {

using nlohmann::json;

const std::vector<DataColumn> kColumns = {
    {"id", "", "which"}, {"way", "m", "how far"}, {"done", "", "whether"}, {"words", "", "what \"it\" said"}};

struct Written {
  std::string text;
  Sink sink() {
    return [this](std::string_view bytes) -> Status {
      text += bytes;
      return Ok{};
    };
  }
};

std::string TextOf(TableFormat format, const std::vector<std::vector<Value>>& rows) {
  Written written;
  DataTable table(format, kColumns, written.sink(), "{\n  \"name\": \"{}\"\n}\n", "steps");
  for (const auto& row : rows) EXPECT_TRUE(table.AddRow(row).ok());
  EXPECT_EQ(table.rows(), rows.size());
  EXPECT_TRUE(table.Finish().ok());
  return written.text;
}

TEST(DataTable, CsvQuotesWhereItHasToAndLeavesEmptyWhatIsNotThere) {
  EXPECT_EQ(TextOf(TableFormat::kCsv,
                   {{std::uint64_t{7}, 0.1, true, "plain"},
                    {std::numeric_limits<std::uint64_t>::max(), NumberValue(std::nan("")), false, "a,b"},
                    {std::int64_t{-1}, 1e-9, Value(), "he said \"no\"\nand left"},
                    {std::uint64_t{0}, 2.0, Value(), TextValue("")}}),
            "id,way,done,words\n"
            "7,0.1,TRUE,plain\n"
            "18446744073709551615,,FALSE,\"a,b\"\n"
            "-1,1e-09,,\"he said \"\"no\"\"\nand left\"\n"
            "0,2,,\n");
}

TEST(DataTable, JsonContinuesItsHeadWithColumnsAndRows) {
  const json document = json::parse(TextOf(
      TableFormat::kJson, {{(std::uint64_t{1} << 53) + 1, 0.25, true, "a \"b\"\n\xff"},
                           {std::uint64_t{1} << 53, NumberValue(std::nan("")), Value(), TextValue("")}}));
  EXPECT_EQ(document.at("name"), "{}");
  EXPECT_EQ(document.at("columns").at(1),
            json::parse(R"({"name": "way", "unit": "m", "meaning": "how far"})"));
  EXPECT_EQ(document.at("steps"), json::parse(R"([
    {"id": "9007199254740993", "way": 0.25, "done": true, "words": "a \"b\"\n�"},
    {"id": 9007199254740992, "way": null, "done": null, "words": null}])"));
}

TEST(DataTable, WithoutRowsItIsStillATable) {
  EXPECT_EQ(TextOf(TableFormat::kCsv, {}), "id,way,done,words\n");
  EXPECT_EQ(json::parse(TextOf(TableFormat::kJson, {})).at("steps"), json::array());
}

TEST(DataTable, HandsOnWhatItHasAndTheSinksError) {
  int calls = 0;
  DataTable table(
      TableFormat::kCsv, {{"words", "", ""}},
      [&](std::string_view) -> Status {
        if (++calls < 3) return Ok{};
        return Error{ErrorKind::kNoSpace, "full"};
      },
      "", "rows");
  Status written = Ok{};
  int rows = 0;
  for (; written && rows < 10'000; ++rows) written = table.AddRow({std::string(1000, 'x')});
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().kind, ErrorKind::kNoSpace);
  EXPECT_LT(rows, 300) << "three parts of 64 KiB";
}

}  // namespace
}  // namespace gauntlet
