#include "controllers/command/metric_source.h"

#include <re2/re2.h>

#include <cmath>
#include <fstream>
#include <vector>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "controllers/command/left_file.h"

namespace gauntlet::controllers::command {
namespace {

constexpr std::string_view kLog = "log:";
constexpr std::string_view kCsv = "csv:";
constexpr std::streamoff kMostCsvBytes = std::streamoff{1} << 30;

RE2::Options Quiet() {
  RE2::Options options;
  options.set_log_errors(false);
  return options;
}

// Calls `use` with each line, cut at kMostLineBytes, until it answers false.
template <typename Use>
void ForEachLine(std::string_view text, Use use) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, std::min(end, kMostLineBytes));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!use(line)) return;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// Without the sequences by which terminals are told of colours.
std::string WithoutColours(std::string_view line) {
  static const RE2 kSequences("\x1b\\[[0-9;?]*[A-Za-z]");
  std::string plain(line);
  if (plain.find('\x1b') != std::string::npos) RE2::GlobalReplace(&plain, kSequences, "");
  return plain;
}

std::string_view Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\"");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\"\r") - begin + 1);
}

Result<double> NumberIn(std::string_view text, const std::string& where) {
  std::string_view digits = Trimmed(text);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const std::optional<double> number = ParseNumber<double>(digits);
  if (number && std::isfinite(*number)) return *number;
  return InvalidInput(where + " says '" + Printable(std::string(text.substr(0, 40))) +
                      "', which is no finite number");
}

std::optional<std::string> LastMatch(const RE2& pattern, std::string_view text) {
  std::optional<std::string> last;
  ForEachLine(text, [&](std::string_view line) {
    const std::string plain = WithoutColours(line);
    re2::StringPiece rest(plain);
    re2::StringPiece found[2];
    const int groups = pattern.NumberOfCapturingGroups() > 0 ? 2 : 1;
    while (pattern.Match(rest, 0, rest.size(), RE2::UNANCHORED, found, groups)) {
      last = std::string(found[groups - 1]);
      const auto behind = static_cast<std::size_t>(found[0].data() - rest.data()) + found[0].size();
      if (behind >= rest.size() || found[0].empty()) break;
      rest.remove_prefix(behind);
    }
    return true;
  });
  return last;
}

Result<double> FromLog(const std::string& pattern, std::string_view out, std::string_view err) {
  const RE2 compiled(pattern, Quiet());
  std::optional<std::string> match = LastMatch(compiled, out);
  if (!match) match = LastMatch(compiled, err);
  if (!match) return InvalidInput("nothing that it printed matches " + pattern);
  return NumberIn(*match, "the last match of " + pattern);
}

std::vector<std::string_view> FieldsOf(std::string_view line) {
  const char separator = line.find(',') != std::string_view::npos    ? ','
                         : line.find(';') != std::string_view::npos  ? ';'
                         : line.find('\t') != std::string_view::npos ? '\t'
                                                                     : ' ';
  std::vector<std::string_view> fields;
  while (true) {
    if (separator == ' ') line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    const std::size_t end = line.find(separator);
    fields.push_back(Trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

struct CsvSource {
  std::string file;
  std::string column;
};
std::optional<CsvSource> CsvOf(std::string_view source) {
  source.remove_prefix(kCsv.size());
  const std::size_t colon = source.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == source.size()) return std::nullopt;
  return CsvSource{std::string(source.substr(0, colon)), std::string(source.substr(colon + 1))};
}

Result<double> FromCsv(const CsvSource& source, const std::string& folder) {
  std::ifstream file = OpenLeftFile(folder + "/" + source.file, /*at_end=*/true);
  if (!file) return InvalidInput("it has left no file " + source.file);
  if (file.tellg() > kMostCsvBytes) return InvalidInput("its file " + source.file + " is larger than 1 GB");
  file.seekg(0);
  std::string first;
  std::string last;
  std::size_t rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (Trimmed(line).empty() || line.starts_with('#')) continue;
    if (rows++ == 0) first = line;
    last.swap(line);
  }
  // A first row of numbers has no names.
  std::vector<std::string_view> names = FieldsOf(first);
  if (std::ranges::all_of(names, [](std::string_view name) { return ParseNumber<double>(name).has_value(); }))
    names.clear();
  std::size_t column = 0;
  while (column < names.size() && names[column] != source.column) ++column;
  if (column == names.size()) {
    const auto number = ParseNumber<std::size_t>(source.column);
    if (!number || *number < 1)
      return InvalidInput(source.file + ": " + UnknownName("column", source.column, names));
    column = *number - 1;
  } else if (rows < 2) {
    return InvalidInput("its file " + source.file + " has no rows");
  }
  const std::vector<std::string_view> values = FieldsOf(last);
  if (rows == 0 || column >= values.size())
    return InvalidInput("the last row of its file " + source.file + " has no column " + source.column);
  return NumberIn(values[column], "the last row of " + source.file + ", column " + source.column + ",");
}

}  // namespace

Status CheckPattern(const std::string& pattern) {
  const RE2 compiled(pattern, Quiet());
  if (pattern.empty()) return InvalidInput("a pattern is missing");
  if (compiled.ok()) return Ok{};
  return InvalidInput("the pattern " + Printable(pattern) + ": " + compiled.error() +
                      " (RE2's syntax: no look-ahead, no back-references)");
}

std::optional<std::string> FirstLineWith(const std::string& pattern, std::string_view text) {
  const RE2 compiled(pattern, Quiet());
  std::optional<std::string> found;
  ForEachLine(text, [&](std::string_view line) {
    std::string plain = WithoutColours(line);
    if (RE2::PartialMatch(plain, compiled)) found = std::move(plain);
    return !found.has_value();
  });
  return found;
}

Status CheckSource(const std::string& source) {
  if (source.starts_with(kLog)) return CheckPattern(source.substr(kLog.size()));
  if (source.starts_with(kCsv) && CsvOf(source)) return Ok{};
  return InvalidInput("from = '" + Printable(source) +
                      "' is none of log:PATTERN, csv:FILE:COLUMN and trajectory:MEASURE");
}

Result<double> ReadSource(const std::string& source, std::string_view out, std::string_view err,
                          const std::string& folder) {
  if (source.starts_with(kLog)) return FromLog(source.substr(kLog.size()), out, err);
  return FromCsv(*CsvOf(source), folder);
}

}  // namespace gauntlet::controllers::command
