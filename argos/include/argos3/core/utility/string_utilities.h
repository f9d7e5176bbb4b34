// Texts to values and back.
#pragma once

#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

template <typename T>
std::string ToString(const T& value) {
  std::ostringstream stream;
  stream.setf(std::ios_base::boolalpha);
  stream << value;
  return stream.str();
}

template <typename T>
T FromString(const std::string& text) {
  std::istringstream stream(text);
  stream.setf(std::ios_base::boolalpha);
  T value;
  stream >> value;
  return value;
}

// Appends the parts between any of the delimiters that are not empty.
void Tokenize(const std::string& text, std::vector<std::string>& tokens, const std::string& delimiters = " ");
std::string StringToUpperCase(const std::string& text);
std::string StringToLowerCase(const std::string& text);
// Every `original` in the text, in place.
void Replace(std::string& text, const std::string& original, const std::string& replacement);
// Does some part of the text match this extended POSIX expression?
bool MatchPattern(const std::string& text, const std::string& pattern);

// The next `count` values, a delimiter between two. Throws when there are fewer.
template <typename T>
void ParseValues(std::istream& stream, UInt32 count, T* values, char delimiter = '\n') {
  UInt32 read = 0;
  for (std::string token; read < count && std::getline(stream, token, delimiter);) {
    std::istringstream one(token);
    if (one >> values[read]) ++read;
  }
  if (read < count) {
    throw CARGoSException("Parse error: expected " + std::to_string(count) + " values, found " +
                          std::to_string(read));
  }
}
template <typename T>
void ParseValues(const std::string& text, UInt32 count, T* values, char delimiter = '\n') {
  std::istringstream stream(text);
  ParseValues<T>(stream, count, values, delimiter);
}

}  // namespace argos
