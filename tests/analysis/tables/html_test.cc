#include "analysis/tables/html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kEvil = "</script><script>alert(1)</script>\"'&\n\xff";

TEST(HtmlTest, LeavesNoMarkup) {
  EXPECT_THAT(Html(kEvil), AllOf(Not(HasSubstr("<")), Not(HasSubstr(">")), Not(HasSubstr("\""))));
  EXPECT_EQ(Html("a < b & c"), "a &lt; b &amp; c");
}

TEST(HtmlTest, LinesStayLines) {
  EXPECT_EQ(HtmlLines("a\n<b>\n\nc"), "a\n&lt;b&gt;\n\nc\n");
  EXPECT_EQ(HtmlLines(""), "");
}

TEST(DataUriTest, StaysWithinItsAttribute) {
  const std::string uri = DataUri("<svg a=\"1\">#%&</svg>\n");
  EXPECT_EQ(uri, "data:image/svg+xml,%3Csvg a=%221%22%3E%23%25%26%3C/svg%3E%0A");
}

TEST(CommandHtmlTest, HoldsTheCommandAsText) {
  EXPECT_EQ(CommandHtml("gauntlet show '<b>'"),
            "<div class=\"command\"><code>gauntlet show '&lt;b&gt;'</code></div>\n");
}

}  // namespace
}  // namespace gauntlet
