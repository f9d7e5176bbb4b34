// Keys that people set, in a file or on the command line: one row says the type of a key's value, what it may
// be, what it means, and where it stands in the settings. Reading, checking, writing and lists share the row.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace gauntlet {

enum class KeyType {
  kText,
  kChoice,   // one of `choices` or `unlisted_choices`
  kInteger,  // min to max
  kNumber,   // min to max
  kFlag,     // true or false; 0 and 1 are taken too
  kSeed,     // 0 to 2^64-1; in TOML, whose integers are signed, also as a string of decimal digits
};
// "text", "choice", "integer", "number", "flag", "seed".
std::string_view NameOf(KeyType type);

// kText and kChoice: string; kInteger: int64; kNumber: double; kFlag: bool; kSeed: uint64.
using KeyValue = std::variant<std::string, std::int64_t, double, bool, std::uint64_t>;

// A key as programs that list and check keys see it.
struct KeyInfo {
  std::string path;  // dotted, "search.population"
  KeyType type = KeyType::kNumber;
  std::string unit;  // "" where there is none
  double min = 0.0;  // of integers and numbers
  double max = 0.0;
  std::vector<std::string> choices;
  std::vector<std::string> unlisted_choices = {};  // taken as well, named nowhere
  std::string description;                         // one line
  KeyValue default_value;
  // What is wrong with a text; may be empty.
  std::function<std::optional<std::string>(const KeyValue&)> check;
};

template <typename Settings>
struct SettingsKey : KeyInfo {
  std::function<KeyValue(const Settings&)> get;
  std::function<void(Settings&, const KeyValue&)> set;  // `value` must have passed CheckValue
};

// What is wrong with a value of the right type ("search.crossover_probability = 1.5 is out of range, allowed
// 0 to 1"), or nothing.
std::optional<std::string> CheckValue(const KeyInfo& key, const KeyValue& value);

// "a whole number, 1 to 10": what a key's value has to be.
std::string ExpectationOf(const KeyInfo& key);

// A flag, a whole number or a number, as one.
double NumberOf(const KeyValue& value);

// A TOML basic string.
std::string QuoteToml(std::string_view text);
// "1.5", "20", "true", "\"genetic\"": the value as TOML.
std::string ToToml(const KeyValue& value);
// The same as --set takes it: a text without quotes.
std::string ToSet(const KeyValue& value);

// The field of the settings at the end of a path of pointers to members.
template <auto First, auto... Rest>
auto& MemberAt(auto& settings) {
  if constexpr (sizeof...(Rest) == 0) {
    return settings.*First;
  } else {
    return MemberAt<Rest...>(settings.*First);
  }
}

// The key of the place at Path: text, flag, whole number (of seconds too), number or seed, as what stands
// there.
template <typename Settings, auto... Path>
SettingsKey<Settings> FieldKey(const std::string& path, const std::string& description) {
  using Place = std::remove_cvref_t<decltype(MemberAt<Path...>(std::declval<Settings&>()))>;
  constexpr bool kDuration = requires(Place place) {
    place.count();
  };
  using Held = std::conditional_t<std::is_same_v<Place, int> || kDuration, std::int64_t, Place>;
  SettingsKey<Settings> key;
  key.path = path;
  key.type = std::is_same_v<Held, std::string>    ? KeyType::kText
             : std::is_same_v<Held, bool>         ? KeyType::kFlag
             : std::is_same_v<Held, std::int64_t> ? KeyType::kInteger
             : std::is_same_v<Held, double>       ? KeyType::kNumber
                                                  : KeyType::kSeed;
  key.description = description;
  key.get = [](const Settings& settings) -> KeyValue {
    if constexpr (kDuration) {
      return Held{MemberAt<Path...>(settings).count()};
    } else {
      return Held{MemberAt<Path...>(settings)};
    }
  };
  key.set = [](Settings& settings, const KeyValue& value) {
    MemberAt<Path...>(settings) = static_cast<Place>(std::get<Held>(value));
  };
  return key;
}

// The same of numbers, whole ones and others.
template <typename Settings, auto... Path>
SettingsKey<Settings> NumberKey(const std::string& path, const std::string& unit, double min, double max,
                                const std::string& description) {
  SettingsKey<Settings> key = FieldKey<Settings, Path...>(path, description);
  key.unit = unit;
  key.min = min;
  key.max = max;
  return key;
}

// The key of an enumeration at Path, which begins at 0 without gaps; `choices` in its order.
template <typename Settings, auto... Path>
SettingsKey<Settings> ChoiceKey(const std::string& path, const std::vector<std::string>& choices,
                                const std::string& description) {
  using Place = std::remove_cvref_t<decltype(MemberAt<Path...>(std::declval<Settings&>()))>;
  SettingsKey<Settings> key;
  key.path = path;
  key.type = KeyType::kChoice;
  key.choices = choices;
  key.description = description;
  key.get = [choices](const Settings& settings) -> KeyValue {
    return choices.at(static_cast<std::size_t>(MemberAt<Path...>(settings)));
  };
  key.set = [choices](Settings& settings, const KeyValue& value) {
    std::size_t number = 0;
    while (choices.at(number) != std::get<std::string>(value)) ++number;
    MemberAt<Path...>(settings) = static_cast<Place>(number);
  };
  return key;
}

}  // namespace gauntlet
