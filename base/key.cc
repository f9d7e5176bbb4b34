#include "base/key.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace gauntlet {

std::string_view NameOf(KeyType type) {
  constexpr std::string_view kNames[] = {"text", "choice", "integer", "number", "flag", "seed"};
  return kNames[static_cast<std::size_t>(type)];
}

double NumberOf(const KeyValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1.0 : 0.0;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return std::get<double>(value);
}

std::string QuoteToml(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (c == '\t') {
      quoted += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) {
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string ToToml(const KeyValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return QuoteToml(*text);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *integer);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* seed = std::get_if<std::uint64_t>(&value)) {
    return *seed <= std::uint64_t{INT64_MAX} ? fmt::format("{}", *seed) : fmt::format("\"{}\"", *seed);
  }
  // The shortest decimal that reads back as the same double, recognisable as a number that is not whole.
  std::string number = fmt::format("{}", std::get<double>(value));
  if (number.find_first_of(".enai") == std::string::npos) number += ".0";
  return number;
}

std::string ToSet(const KeyValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text != nullptr ? *text : ToToml(value);
}

std::string ExpectationOf(const KeyInfo& key) {
  switch (key.type) {
    case KeyType::kText:
      return "text";
    case KeyType::kChoice:
      return fmt::format("one of {}", fmt::join(key.choices, ", "));
    case KeyType::kInteger:
      return fmt::format("a whole number, {} to {}", key.min, key.max);
    case KeyType::kNumber:
      if (std::isinf(key.max)) return "a number";
      return fmt::format("a number, {} to {}{}{}", key.min, key.max, key.unit.empty() ? "" : " ", key.unit);
    case KeyType::kFlag:
      return "true or false";
    case KeyType::kSeed:
      break;
  }
  return "a whole number, 0 to 18446744073709551615 (as text from 9223372036854775808 on)";
}

std::optional<std::string> CheckValue(const KeyInfo& key, const KeyValue& value) {
  if (key.check) return key.check(value);
  const auto message = [&](std::string_view what) {
    return fmt::format("{} = {} {}", key.path, ToToml(value), what);
  };
  if (key.type == KeyType::kChoice) {
    for (const auto* choices : {&key.choices, &key.unlisted_choices}) {
      if (std::ranges::count(*choices, std::get<std::string>(value)) > 0) return std::nullopt;
    }
    return message(fmt::format("is unknown, allowed {}", fmt::join(key.choices, ", ")));
  }
  if (key.type == KeyType::kInteger || key.type == KeyType::kNumber) {
    const double number = NumberOf(value);
    if (number >= key.min && number <= key.max) return std::nullopt;
    return message(fmt::format("is out of range, allowed {} to {}{}{}", key.min, key.max,
                               key.unit.empty() ? "" : " ", key.unit));
  }
  return std::nullopt;
}

}  // namespace gauntlet
