#include "analysis/tables/cell.h"

#include <cmath>
#include <iterator>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

// Integers up to here are exact in every JSON reader.
constexpr std::uint64_t kExactInJson = 1ULL << 53;

void AppendCsvText(const std::string& text, std::string& out) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  out += '"';
}

template <typename Number>
void AppendNumber(Number number, std::string& out) {
  fmt::format_to(std::back_inserter(out), "{}", number);
}

}  // namespace

Value NumberValue(double value) {
  return std::isfinite(value) ? Value(value) : Value();
}

Value TextValue(std::string text) {
  return text.empty() ? Value() : Value(std::move(text));
}

Json JsonValue(const Value& value) {
  return std::visit(
      [](const auto& one) -> Json {
        using One = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<One, std::monostate>) {
          return {};
        } else if constexpr (std::is_same_v<One, std::uint64_t>) {
          return one <= kExactInJson ? Json(one) : Json(std::to_string(one));
        } else if constexpr (std::is_same_v<One, double>) {
          return std::isfinite(one) ? Json(one) : Json();
        } else if constexpr (std::is_same_v<One, std::shared_ptr<const Json>>) {
          return *one;
        } else {
          return one;
        }
      },
      value);
}

void AppendJson(const Value& value, std::string& out) {
  const auto* number = std::get_if<double>(&value);
  if (number != nullptr && std::isfinite(*number)) {
    AppendNumber(*number, out);  // as CSV has it: 1, not 1.0
  } else if (const auto* whole = std::get_if<std::uint64_t>(&value);
             whole != nullptr && *whole <= kExactInJson) {
    AppendNumber(*whole, out);
  } else {
    out += JsonValue(value).dump(-1, ' ', false, Json::error_handler_t::replace);
  }
}

void AppendCsv(const Value& value, std::string& out) {
  if (const auto* text = std::get_if<std::string>(&value)) {
    const bool obeyed =
        text->size() > 1 && std::string_view("=+-@\t\r").find(text->front()) != std::string_view::npos;
    AppendCsvText(obeyed ? "'" + *text : *text, out);
  } else if (const auto* holds = std::get_if<bool>(&value)) {
    // R takes no other words for truth values than these; pandas takes them too.
    out += *holds ? "TRUE" : "FALSE";
  } else if (const auto* whole = std::get_if<std::uint64_t>(&value)) {
    AppendNumber(*whole, out);
  } else if (!std::holds_alternative<std::monostate>(value)) {
    std::string json;
    AppendJson(value, json);
    AppendCsvText(json, out);
  }
}

Cell::Cell(double number)
    : text(std::isfinite(number) ? NumberText(number) : "-"), value(NumberValue(number)) {}

Cell CountCell(std::uint64_t count) {
  return {FormatCount(count), count};
}

Cell DecimalCell(double value, int decimals) {
  return std::isfinite(value) ? Cell(fmt::format("{:.{}f}", value, decimals), value) : Cell();
}

Cell FitnessCell(double fitness) {
  return DecimalCell(fitness, 3);
}

std::string FormatFitness(double fitness) {
  return FitnessCell(fitness).text;
}

Cell DigitsCell(double value, int digits) {
  return std::isfinite(value) ? Cell(fmt::format("{:.{}g}", value, digits), value) : Cell();
}

Cell TextCell(std::string text) {
  return {text, TextValue(text)};
}

Cell OutOfCell(std::uint64_t k, std::uint64_t n) {
  return JsonCell({k, n}, fmt::format("{} of {}", k, n));
}

Cell PercentCell(const analysis::Interval& interval) {
  return JsonCell({interval.low, interval.high},
                  fmt::format("{:3.0f} to {:3.0f} %", 100.0 * interval.low, 100.0 * interval.high));
}

Cell IntervalCell(const std::optional<analysis::Interval>& interval) {
  if (!interval) return {};
  return JsonCell({interval->low, interval->high},
                  fmt::format("{:.3f} to {:.3f}", interval->low, interval->high));
}

Cell JsonCell(Json json, std::string text) {
  return {std::move(text), std::make_shared<const Json>(std::move(json))};
}

Cell LinkCell(Cell cell, std::string link) {
  cell.link = std::move(link);
  return cell;
}

}  // namespace gauntlet
