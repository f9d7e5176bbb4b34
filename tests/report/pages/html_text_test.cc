#include "report/pages/html_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gauntlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(JsonInHtmlTest, CannotEndItsScriptAndReadsBack) {
  const nlohmann::ordered_json value = {{"name", "</script><!--<script>&"}};
  const std::string text = JsonInHtml(value);
  EXPECT_THAT(text, AllOf(Not(HasSubstr("<")), Not(HasSubstr(">")), Not(HasSubstr("&"))));
  EXPECT_EQ(nlohmann::ordered_json::parse(text), value);
  EXPECT_THAT(JsonInHtml({{"name", "\xff"}}), HasSubstr("\xef\xbf\xbd"));
}

}  // namespace
}  // namespace gauntlet
