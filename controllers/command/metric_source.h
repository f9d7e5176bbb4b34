// Where a program's output holds a number: a pattern, which takes time linear in the text, or a column of a
// CSV file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace gauntlet::controllers::command {

// What of a line is looked at.
inline constexpr std::size_t kMostLineBytes = std::size_t{64} << 10;

// Error: RE2's words.
Status CheckPattern(const std::string& pattern);
// The whole first line in which the pattern matches.
std::optional<std::string> FirstLineWith(const std::string& pattern, std::string_view text);

// "log:PATTERN", whose first group, or else all that it matches, is the number, or "csv:FILE:COLUMN", a name
// of the first row or a number from 1 on. Error: it is none of these, with what would be right.
Status CheckSource(const std::string& source);
// The number: of the last match in the two texts (in the first one, where it has any), line by line, without
// colours; of the last row of the file. Error: there is none, or it is no finite number.
Result<double> ReadSource(const std::string& source, std::string_view out, std::string_view err,
                          const std::string& folder);

}  // namespace gauntlet::controllers::command
