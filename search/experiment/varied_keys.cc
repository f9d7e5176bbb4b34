#include "search/experiment/varied_keys.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/split.h"
#include "search/experiment/key_assignment.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

constexpr std::string_view kRange = "..";
constexpr std::string_view kLog = ":log";

// Genes lie on the grid that the experiment gives them.
bool OnGrid(const std::string& path) {
  constexpr std::array kOnGrid = {"genome.position_min", "genome.position_max", "genome.length_min",
                                  "genome.length_max",   "genome.width_min",    "genome.width_max"};
  return std::ranges::find(kOnGrid, path) != kOnGrid.end();
}

KeyValue NumberFor(const Key& key, double number) {
  if (key.type == KeyType::kInteger) return static_cast<std::int64_t>(std::llround(number));
  return number;
}

std::string WithDigits(double number, int digits) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::scientific, digits - 1)
          .ptr;
  return {text.data(), end};
}

Error Wrong(const std::string& text, const std::string& what) {
  return InvalidInput(fmt::format("--vary {}: {}", text, what));
}

Result<VariedKey> RangeOf(const std::string& text, VariedKey varied, std::string_view range) {
  if (range.ends_with(kLog)) {
    varied.log = true;
    range.remove_suffix(kLog.size());
  }
  const std::size_t middle = range.find(kRange);
  const auto low = ParseNumber<double>(range.substr(0, middle));
  const auto high = ParseNumber<double>(range.substr(middle + kRange.size()));
  if (!low || !high || !std::isfinite(*low) || !std::isfinite(*high))
    return Wrong(text, fmt::format("'{}' is no range of two numbers, as in 0.5..2", range));
  varied.low = *low;
  varied.high = *high;
  const Key& key = varied.key;
  for (const double end : {*low, *high}) {
    if (key.type == KeyType::kInteger && end != std::floor(end))
      return Wrong(text, fmt::format("{} is {}, and {} is none", key.path, ExpectationOf(key), end));
    if (const auto wrong = CheckValue(key, NumberFor(key, end))) return Wrong(text, *wrong);
  }
  if (*low >= *high) return Wrong(text, fmt::format("{} is not below {}", *low, *high));
  if (varied.log && *low <= 0.0)
    return Wrong(text, fmt::format("the range begins at {}, which has no logarithm", *low));
  return varied;
}

Result<VariedKey> ListOf(const std::string& text, VariedKey varied, const std::string& list) {
  for (const std::string& word : Split(list, '|')) {
    TRY(const Assignment assignment, ReadSet(varied.key.path + "=" + word, "--vary"));
    TRY(KeyValue value, ValueFor(varied.key, assignment));
    if (std::ranges::find(varied.values, value) != varied.values.end())
      return Wrong(text, fmt::format("{} stands twice", word));
    varied.values.push_back(std::move(value));
  }
  if (varied.values.size() < 2)
    return Wrong(text, fmt::format("{} is a single value: LOW..HIGH or A|B is needed", list));
  return varied;
}

}  // namespace

std::optional<std::string> WhyItCannotVary(const Key& key) {
  for (const std::string_view of_searches : {"search.", "fit.", "margin.", "repair."}) {
    if (key.path.starts_with(of_searches)) return "says how is searched";
  }
  if (key.type == KeyType::kSeed) return "gives every run its seed";
  if (key.for_people) return "has no influence on a run";
  if (key.type == KeyType::kText) return "is a text";
  return std::nullopt;
}

KeyValue VariedKey::ValueAt(double place) const {
  if (listed()) {
    const auto index = static_cast<std::size_t>(place * static_cast<double>(values.size()));
    return values[std::min(index, values.size() - 1)];
  }
  // A whole number has as much room as the others.
  const double margin = key.type == KeyType::kInteger ? 0.5 : 0.0;
  double number = log ? sim::Exp(sim::Log(low) + place * (sim::Log(high) - sim::Log(low)))
                      : low - margin + place * (high - low + 2.0 * margin);
  if (step > 0.0) number = low + std::round((number - low) / step) * step;
  return NumberFor(key, std::clamp(number, low, high));
}

double VariedKey::PlaceOf(const KeyValue& value) const {
  if (listed()) {
    const auto index = static_cast<double>(std::ranges::find(values, value) - values.begin());
    return (index + 0.5) / static_cast<double>(values.size());
  }
  const double number = NumberOf(value);
  if (log) return (sim::Log(number) - sim::Log(low)) / (sim::Log(high) - sim::Log(low));
  const double margin = key.type == KeyType::kInteger ? 0.5 : 0.0;
  return (number - low + margin) / (high - low + 2.0 * margin);
}

KeyValue VariedKey::RoundedAt(double place) const {
  const KeyValue value = ValueAt(place);
  if (listed() || key.type == KeyType::kInteger) return value;
  double rounded = 0.0;
  const std::string text = WithDigits(std::get<double>(value), 2);
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return std::clamp(rounded, low, high);
}

std::string VariedKey::ToText() const {
  if (!listed()) return fmt::format("{}={}..{}{}", key.path, low, high, log ? kLog : "");
  std::vector<std::string> texts;
  for (const KeyValue& value : values) texts.push_back(ToSet(value));
  return fmt::format("{}={}", key.path, fmt::join(texts, "|"));
}

Result<std::vector<VariedKey>> ParseVariedKeys(const std::vector<std::string>& texts,
                                               std::span<const Key> keys, const Experiment& experiment) {
  std::vector<VariedKey> varied;
  std::set<std::string> known;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      return Wrong(text, "KEY=LOW..HIGH, KEY=LOW..HIGH:log or KEY=A|B is needed");
    const std::string path = text.substr(0, equals);
    const std::string rest = text.substr(equals + 1);
    const auto key = std::ranges::find(keys, path, &Key::path);
    if (key == keys.end()) return Wrong(text, UnknownName("key", path, keys));
    if (const auto reason = WhyItCannotVary(*key)) return Wrong(text, fmt::format("{} {}", path, *reason));
    if (!known.insert(path).second) return Wrong(text, path + " varies twice");
    VariedKey one{.key = *key, .step = OnGrid(path) ? experiment.genome.step : 0.0};
    const bool is_number = key->type == KeyType::kNumber || key->type == KeyType::kInteger;
    if (is_number && rest.find('|') == std::string::npos) {
      if (rest.find(kRange) == std::string::npos)
        return Wrong(text, fmt::format("'{}' is no range, as in {}=0.5..2", rest, path));
      TRY(one, RangeOf(text, std::move(one), rest));
    } else {
      TRY(one, ListOf(text, std::move(one), rest));
    }
    varied.push_back(std::move(one));
  }
  if (varied.empty()) return InvalidInput("nothing varies: --vary KEY=LOW..HIGH is needed");
  return varied;
}

Experiment WithValues(const Experiment& experiment, std::span<const VariedKey> varied,
                      std::span<const KeyValue> values) {
  Experiment changed = experiment;
  for (std::size_t i = 0; i < varied.size(); ++i) varied[i].key.set(changed, values[i]);
  return changed;
}

}  // namespace gauntlet
