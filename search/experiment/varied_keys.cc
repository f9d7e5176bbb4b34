#include "search/experiment/varied_keys.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/parse_number.h"
#include "base/split.h"
#include "search/experiment/key_assignment.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet {
namespace {

constexpr std::string_view kRange = "..";
constexpr std::string_view kLog = ":log";
constexpr std::string_view kNormal = ":normal";
constexpr double kNormalEnds = 2.0;  // standard deviations from the middle

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

// Of a place, in standard deviations from the middle.
double DeviateAt(double place) {
  constexpr double kBelow = 0.02275013194817921;  // the ends
  return std::clamp(sim::NormalDeviate(kBelow + place * (1.0 - 2.0 * kBelow)), -kNormalEnds, kNormalEnds);
}

// What is read of one text, and what it is called.
struct Reading {
  std::string text;
  Varied varied;

  Error Wrong(const std::string& what) const {
    return InvalidInput(varied == Varied::kDrawn ? what : fmt::format("--vary {}: {}", text, what));
  }
};

Result<VariedKey> RangeOf(const Reading& reading, VariedKey varied, std::string_view range) {
  const auto take = [&](std::string_view ending, bool& taken) {
    taken = range.ends_with(ending);
    if (taken) range.remove_suffix(ending.size());
  };
  take(kLog, varied.log);
  if (reading.varied == Varied::kDrawn) take(kNormal, varied.normal);
  const auto wrong = [&](const std::string& what) { return reading.Wrong(what); };
  const std::size_t middle = range.find(kRange);
  const auto low = ParseNumber<double>(range.substr(0, middle));
  const auto high = ParseNumber<double>(range.substr(middle + kRange.size()));
  if (!low || !high || !std::isfinite(*low) || !std::isfinite(*high))
    return wrong(fmt::format("'{}' is no range of two numbers, as in 0.5..2", range));
  varied.low = *low;
  varied.high = *high;
  const Key& key = varied.key;
  for (const double end : {*low, *high}) {
    if (key.type == KeyType::kInteger && end != std::floor(end))
      return wrong(fmt::format("{} is {}, and {} is none", key.path, ExpectationOf(key), end));
    if (const auto refused = CheckValue(key, NumberFor(key, end))) return wrong(*refused);
  }
  if (*low >= *high) return wrong(fmt::format("{} is not below {}", *low, *high));
  if (varied.log && *low <= 0.0)
    return wrong(fmt::format("the range begins at {}, which has no logarithm", *low));
  return varied;
}

// The weight behind a word's last colon, which is cut off; 1 where there is none.
Result<double> WeightOf(const Reading& reading, std::string& word) {
  const std::size_t colon = word.rfind(':');
  if (reading.varied != Varied::kDrawn || colon == std::string::npos) return 1.0;
  const std::string text = word.substr(colon + 1);
  const auto weight = ParseNumber<double>(text);
  if (!weight || !std::isfinite(*weight) || *weight < 0.0)
    return reading.Wrong(
        fmt::format("'{}' is no weight of {}: want a number from 0 on", text, word.substr(0, colon)));
  word.resize(colon);
  return *weight;
}

Result<VariedKey> ListOf(const Reading& reading, VariedKey varied, const std::string& list) {
  const auto wrong = [&](const std::string& what) { return reading.Wrong(what); };
  double sum = 0.0;
  for (std::string word : Split(list, '|')) {
    TRY(const double weight, WeightOf(reading, word));
    TRY(const Assignment assignment, ReadSet(varied.key.path + "=" + word, "--vary"));
    varied.weights.push_back(weight);
    sum += weight;
    TRY(KeyValue value, ValueFor(varied.key, assignment));
    if (std::ranges::find(varied.values, value) != varied.values.end())
      return wrong(fmt::format("{} stands twice", word));
    varied.values.push_back(std::move(value));
  }
  if (varied.values.size() < 2)
    return wrong(fmt::format("{} is a single value: LOW..HIGH or A|B is needed", list));
  if (sum <= 0.0) return wrong("the weights sum to nothing");
  const bool equal = std::ranges::count(varied.weights, varied.weights.front()) == std::ssize(varied.weights);
  if (equal) varied.weights.clear();
  return varied;
}

// Of the list, by the weights.
std::size_t EntryAt(const VariedKey& varied, double place) {
  if (varied.weights.empty()) {
    const auto index = static_cast<std::size_t>(place * static_cast<double>(varied.values.size()));
    return std::min(index, varied.values.size() - 1);
  }
  double left = place * std::accumulate(varied.weights.begin(), varied.weights.end(), 0.0);
  std::size_t entry = 0;
  while (left >= varied.weights[entry] && entry + 1 < varied.values.size()) left -= varied.weights[entry++];
  while (varied.weights[entry] == 0.0) --entry;  // only rounding leads behind the last that has a weight
  return entry;
}

std::vector<std::string_view> PathsThatCanVary(std::span<const Key> keys) {
  std::vector<std::string_view> paths;
  for (const Key& key : keys) {
    if (!WhyItCannotVary(key)) paths.push_back(key.path);
  }
  return paths;
}

}  // namespace

std::optional<std::string> WhyItCannotVary(const Key& key) {
  for (const std::string_view of_searches : {"search.", "fit.", "margin.", "repair.", "probability."}) {
    if (key.path.starts_with(of_searches)) return "says how is searched";
  }
  if (key.type == KeyType::kSeed) return "gives every run its seed";
  if (key.for_people) return "has no influence on a run";
  if (key.type == KeyType::kText) return "is a text";
  return std::nullopt;
}

KeyValue VariedKey::ValueAt(double place) const {
  if (listed()) return values[EntryAt(*this, place)];
  // A whole number has as much room as the others.
  const double margin = key.type == KeyType::kInteger ? 0.5 : 0.0;
  if (normal) place = 0.5 + 0.5 * DeviateAt(place) / kNormalEnds;
  double number = log ? sim::Exp(sim::Log(low) + place * (sim::Log(high) - sim::Log(low)))
                      : low - margin + place * (high - low + 2.0 * margin);
  if (step > 0.0) number = low + std::round((number - low) / step) * step;
  return NumberFor(key, std::clamp(number, low, high));
}

double VariedKey::DensityAt(double place) const {
  if (listed())
    return weights.empty() ? 1.0 : weights[EntryAt(*this, place)] / *std::ranges::max_element(weights);
  if (normal) return sim::Exp(-0.5 * DeviateAt(place) * DeviateAt(place));
  return log ? low / NumberOf(ValueAt(place)) : 1.0;
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
  if (!listed()) return fmt::format("{}={}..{}{}", key.path, low, high, log ? kLog : normal ? kNormal : "");
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < values.size(); ++i)
    texts.push_back(ToSet(values[i]) + (weights.empty() ? "" : fmt::format(":{}", weights[i])));
  return fmt::format("{}={}", key.path, fmt::join(texts, "|"));
}

Result<std::vector<VariedKey>> ParseVariedKeys(const std::vector<std::string>& texts,
                                               std::span<const Key> keys, const Experiment& experiment,
                                               Varied how) {
  std::vector<VariedKey> varied;
  std::set<std::string> known;
  for (const std::string& text : texts) {
    const auto wrong = [&](const std::string& what) { return Reading{text, how}.Wrong(what); };
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      return wrong("KEY=LOW..HIGH, KEY=LOW..HIGH:log or KEY=A|B is needed");
    const std::string path = text.substr(0, equals);
    const std::string rest = text.substr(equals + 1);
    const auto key = std::ranges::find(keys, path, &Key::path);
    if (key == keys.end()) return wrong(UnknownKey(path, PathsThatCanVary(keys)));
    if (const auto reason = WhyItCannotVary(*key)) return wrong(fmt::format("{} {}", path, *reason));
    if (!known.insert(path).second) return wrong(path + " varies twice");
    VariedKey one{.key = *key, .step = OnGrid(path) ? experiment.genome.step : 0.0};
    const bool is_number = key->type == KeyType::kNumber || key->type == KeyType::kInteger;
    if (is_number && rest.find('|') == std::string::npos) {
      if (rest.find(kRange) == std::string::npos)
        return wrong(fmt::format("'{}' is no range, as in {}=0.5..2", rest, path));
      TRY(one, RangeOf({text, how}, std::move(one), rest));
    } else {
      TRY(one, ListOf({text, how}, std::move(one), rest));
    }
    varied.push_back(std::move(one));
  }
  if (varied.empty() && how == Varied::kTried)
    return InvalidInput("nothing varies: --vary KEY=LOW..HIGH is needed");
  return varied;
}

Experiment WithValues(const Experiment& experiment, std::span<const VariedKey> varied,
                      std::span<const KeyValue> values) {
  Experiment changed = experiment;
  for (std::size_t i = 0; i < varied.size(); ++i) varied[i].key.set(changed, values[i]);
  return changed;
}

}  // namespace gauntlet
