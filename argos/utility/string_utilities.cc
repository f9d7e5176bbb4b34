#include <argos3/core/utility/string_utilities.h>

#include <regex.h>

#include <algorithm>
#include <cctype>

namespace argos {
namespace {

std::string Mapped(std::string text, int (*map)(int)) {
  for (char& letter : text) letter = static_cast<char>(map(static_cast<unsigned char>(letter)));
  return text;
}

}  // namespace

void Tokenize(const std::string& text, std::vector<std::string>& tokens, const std::string& delimiters) {
  std::size_t begin = text.find_first_not_of(delimiters);
  while (begin != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(delimiters, begin), text.size());
    tokens.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(delimiters, end);
  }
}

std::string StringToUpperCase(const std::string& text) {
  return Mapped(text, std::toupper);
}

std::string StringToLowerCase(const std::string& text) {
  return Mapped(text, std::tolower);
}

void Replace(std::string& text, const std::string& original, const std::string& replacement) {
  if (original.empty()) return;
  for (std::size_t at = text.find(original); at != std::string::npos;
       at = text.find(original, at + replacement.size())) {
    text.replace(at, original.size(), replacement);
  }
}

bool MatchPattern(const std::string& text, const std::string& pattern) {
  regex_t expression;
  if (regcomp(&expression, pattern.c_str(), REG_EXTENDED | REG_NOSUB) != 0) {
    throw CARGoSException("\"" + pattern + "\" is no regular expression");
  }
  const bool matches = regexec(&expression, text.c_str(), 0, nullptr, 0) == 0;
  regfree(&expression);
  return matches;
}

}  // namespace argos
