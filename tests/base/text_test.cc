// Text that came from outside.
// Covers: base/printable.cc, base/shell_quoted.cc, base/split.cc, base/utf8.cc
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "base/parse_number.h"
#include "base/printable.h"
#include "base/shell_quoted.h"
#include "base/split.h"
#include "base/utf8.h"

namespace gauntlet {
namespace {

TEST(Utf8Test, KeepsWhatIsWellFormedAndReplacesTheRest) {
  EXPECT_EQ(ToUtf8("Z\xc3\xbcrich \xe2\x82\xac \xf0\x9f\xa4\x96\n"),
            "Z\xc3\xbcrich \xe2\x82\xac \xf0\x9f\xa4\x96\n");
  EXPECT_EQ(ToUtf8("a\xff\xc3"), "a??") << "a lone lead byte at the end";
  EXPECT_EQ(ToUtf8("\xc0\xaf"), "??") << "overlong form of '/'";
  EXPECT_EQ(ToUtf8("\xed\xa0\x80"), "???") << "surrogate";
  EXPECT_EQ(ToUtf8("\xf4\x90\x80\x80"), "????") << "beyond U+10FFFF";
  EXPECT_EQ(ToUtf8("\x1b[31mred\t"), "?[31mred\t") << "no terminal commands from a run";
}

RC_GTEST_PROP(Utf8Property, TheResultIsAlwaysUtf8AndNoLonger, (const std::string& bytes)) {
  const std::string clean = ToUtf8(bytes);
  RC_ASSERT(IsUtf8(clean));
  RC_ASSERT(clean.size() == bytes.size());
}

TEST(Split, KeepsEmptyParts) {
  EXPECT_EQ(Split("a,b;c", ','), (std::vector<std::string>{"a", "b;c"}));
  EXPECT_EQ(Split(",a,", ','), (std::vector<std::string>{"", "a", ""}));
  EXPECT_EQ(Split("", ','), std::vector<std::string>{""});
}

TEST(Trimmed, LosesWhatStandsAround) {
  EXPECT_EQ(Trimmed("\r\n\ta b \n"), "a b");
  EXPECT_EQ(Trimmed(" \t"), "");
  EXPECT_EQ(Trimmed(""), "");
}

TEST(Printable, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(Printable("plain \u00fcber"), "plain \u00fcber");
  EXPECT_EQ(Printable("a\nb\tc\x1b[31m\x7f"), "a\\nb\\tc\\x1b[31m\\x7f");
  EXPECT_EQ(Printable("\xc2\x9b"
                      "31m"),
            "\\x9b31m");
  EXPECT_EQ(Printable("\u00a0"), "\u00a0");
  EXPECT_EQ(Printable("half of a \xc3"), "half of a \\xc3");
  EXPECT_EQ(Printable("\xa9\xff"), "\\xa9\\xff");
}

RC_GTEST_PROP(PrintableProperty, TheResultIsUtf8WithoutControlCharactersAndStaysAsItIs,
              (const std::string& bytes)) {
  const std::string shown = Printable(bytes);
  RC_ASSERT(IsUtf8(shown));
  for (const char c : shown) RC_ASSERT(static_cast<unsigned char>(c) >= 0x20U && c != '\x7f');
  RC_ASSERT(Printable(shown) == shown);
}

TEST(PastedPath, IsTheSamePathForBashAndNeverAnOption) {
  EXPECT_EQ(PastedPath("campaigns/flocking-1"), "campaigns/flocking-1");
  EXPECT_EQ(PastedPath("-rf"), "./-rf");
  EXPECT_EQ(PastedPath("a$(touch X)`id`"), "'a$(touch X)`id`'");
  EXPECT_EQ(PastedPath("a\tb"), "$'a\\011b'");
  EXPECT_EQ(PastedPath("it's\n\xff"), "$'it\\'s\\012\\377'");
}

TEST(ShellQuoted, QuotesOnlyWhatAShellWouldChange) {
  EXPECT_EQ(ShellQuoted("campaigns/flocking-1"), "campaigns/flocking-1");
  EXPECT_EQ(ShellQuoted("my runs"), "'my runs'");
  EXPECT_EQ(ShellQuoted("it's"), "'it'\\''s'");
  EXPECT_EQ(ShellQuoted(""), "''");
  EXPECT_EQ(ShellQuoted("$HOME"), "'$HOME'");
}

TEST(PlaceIn, CountsLinesAndCharactersFromOne) {
  EXPECT_EQ(PlaceIn("ab", 0), "1:1");
  EXPECT_EQ(PlaceIn("a\nbc", 2), "2:1");
  EXPECT_EQ(PlaceIn("a\nZ\xc3\xbcx", 5), "2:3") << "characters, not bytes";
  EXPECT_EQ(PlaceIn("a\n", 100), "2:1");
}

TEST(ParseNumber, TakesTheWholeTextOrNothing) {
  EXPECT_EQ(ParseNumber<int>("-12"), -12);
  EXPECT_EQ(ParseNumber<double>("1e-2"), 0.01);
  for (const char* text : {"", "12 ", " 12", "+12", "12x", "1.5", "99999999999"}) {
    EXPECT_FALSE(ParseNumber<int>(text).has_value()) << text;
  }
  EXPECT_FALSE(ParseNumber<unsigned>("-1").has_value());
}

}  // namespace
}  // namespace gauntlet
