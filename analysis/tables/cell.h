// What a table says in one place: a text for people, a value for programs.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <nlohmann/json_fwd.hpp>

#include "analysis/statistics/interval.h"
#include "base/number_text.h"

namespace gauntlet {

// For programs. The first: there is nothing to say, null in JSON and an empty field in CSV. The last: a list
// or an object, of which CSV holds the JSON.
using Value = std::variant<std::monostate, bool, std::uint64_t, std::int64_t, double, std::string,
                           std::shared_ptr<const nlohmann::ordered_json>>;
// A number, or nothing when it is not finite.
Value NumberValue(double value);
// A text, or nothing when it is empty.
Value TextValue(std::string text);

// Whole numbers above 2^53, which not every reader of JSON keeps, become texts; numbers that are not finite
// become null.
nlohmann::ordered_json JsonValue(const Value& value);
// The text of the same. Bytes that are not UTF-8 become U+FFFD.
void AppendJson(const Value& value, std::string& out);
// Texts are quoted where they have to be, truth values are TRUE and FALSE. A text that a spreadsheet would
// take for a formula gets an apostrophe in front.
void AppendCsv(const Value& value, std::string& out);

struct Cell {
  // Nothing to say: "-".
  Cell() : text("-") {}
  Cell(const char* words) : Cell(std::string(words)) {}              // NOLINT(google-explicit-constructor)
  Cell(std::string_view words) : Cell(std::string(words)) {}         // NOLINT(google-explicit-constructor)
  Cell(std::string words) : text(words), value(std::move(words)) {}  // NOLINT(google-explicit-constructor)
  Cell(bool holds) : text(holds ? "yes" : "no"), value(holds) {}     // NOLINT(google-explicit-constructor)
  // Digits alone, as ids are written; counts are told by CountCell.
  template <std::integral Whole>
  Cell(Whole number) : text(std::to_string(number)) {  // NOLINT(google-explicit-constructor)
    if constexpr (std::signed_integral<Whole>) {
      value = std::int64_t{number};
    } else {
      value = std::uint64_t{number};
    }
  }
  // The shortest text that reads back as the same number; nothing when it is not finite.
  Cell(double number);  // NOLINT(google-explicit-constructor)
  Cell(std::string for_people, Value for_programs)
      : text(std::move(for_people)), value(std::move(for_programs)) {}

  std::string text;  // as it was made: the renderings see to what a terminal or a page obeys
  Value value;
  std::string link = "";  // where a page leads from it; "" = nowhere
};

// "1,234"
Cell CountCell(std::uint64_t count);
// So many decimals; nothing when it is not finite.
Cell DecimalCell(double value, int decimals);
// Three decimals, as fitness is told everywhere.
Cell FitnessCell(double fitness);
std::string FormatFitness(double fitness);
// So many digits that count, "0.0012" or "1.2e-11"; nothing when it is not finite.
Cell DigitsCell(double value, int digits);
// Words, of which "" is nothing to programs and empty for people.
Cell TextCell(std::string text);
// "3 of 5"; [3, 5], for a column of two keys.
Cell OutOfCell(std::uint64_t k, std::uint64_t n);
// "12 to 80 %" of a probability; [0.12, 0.8].
Cell PercentCell(const analysis::Interval& interval);
// "0.120 to 0.800"; [0.12, 0.8].
Cell IntervalCell(const std::optional<analysis::Interval>& interval);
// A list or an object for programs.
Cell JsonCell(nlohmann::ordered_json json, std::string text = "");
// Leads to `link` on a page; "" = nowhere.
Cell LinkCell(Cell cell, std::string link);

}  // namespace gauntlet
