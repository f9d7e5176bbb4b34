#include "analysis/tables/section.h"

#include <gtest/gtest.h>

namespace gauntlet {
namespace {

Section Example() {
  Section section{.title = "What <happens>", .lead = {"Two cases."}, .table = Table({"case", ">runs"})};
  section.table.AddRow({"a", 5});
  section.sentences = {"None was lost."};
  section.pictures = {{"An arena", "How it looks.", "<svg/>"}};
  section.commands = {{"gauntlet show c", "see it"}};
  return section;
}

TEST(Section, IsToldInOrder) {
  EXPECT_EQ(ToText(Example()),
            "\nWhat <happens>\n  Two cases.\n  case  runs\n  a        5\n  None was lost.\n"
            "  gauntlet show c  # see it\n");
  EXPECT_EQ(ToHtml(Example()),
            "<h3>What &lt;happens&gt;</h3>\n<p>Two cases.</p>\n" + Example().table.ToHtml() +
                "<p>None was lost.</p>\n<figure><div class=\"scroll\"><img alt=\"An arena\" "
                "src=\"data:image/svg+xml,%3Csvg/%3E\"></div>\n<figcaption>How it "
                "looks.</figcaption></figure>\n<p>see it:</p>\n<div class=\"command\"><code>gauntlet show "
                "c</code></div>\n");
}

TEST(Section, OfNothingIsNothing) {
  EXPECT_EQ(ToText(Section()), "");
  EXPECT_EQ(ToHtml(Section()), "");
}

}  // namespace
}  // namespace gauntlet
