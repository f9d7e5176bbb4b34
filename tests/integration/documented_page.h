// A page of docs/ whose commands are run and whose quoted output is held.
#pragma once

#include <string>
#include <vector>

#include "tests/support/process.h"

namespace gauntlet::testing_support {

// Of the lines that are indented by four blanks outside of fenced blocks: commands are those that begin with
// a program's name, everything else is output that the page quotes.
struct DocumentedPage {
  std::vector<std::string> commands;
  std::vector<std::string> quoted;
};
// `file`: below docs/.
DocumentedPage ReadPage(const std::string& file);

// Runs its commands in their order in `folder`, until one of them fails.
ProcessResult RunCommands(const DocumentedPage& page, const std::string& folder);
// Runs the page's commands in a folder of their own, and expects what it quotes in what they said.
void ExpectCommandsSayWhatIsQuoted(const std::string& file, std::size_t least_commands,
                                   std::size_t least_quoted);
// The text of the first fenced block of the page, TOML or JSON.
std::string FencedText(const std::string& file, const std::string& language);

// The blank-separated words of a text.
std::vector<std::string> Words(const std::string& text);
// Output with one blank between words, as somebody sees it who works in `folder` and calls the program
// `gauntlet`.
std::string AsRead(const std::string& output, const std::string& folder);

// Expects every quoted line, or each part of one between its "...", in what was `said` (AsRead).
void ExpectQuoted(const DocumentedPage& page, const std::string& said);

}  // namespace gauntlet::testing_support
