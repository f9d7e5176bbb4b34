#include "controllers/generic/formula.h"

#include <muParser.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/check.h"
#include "base/nearest_name.h"
#include "base/number_text.h"

namespace gauntlet::controllers::generic {
namespace {

// Leaves muParser, and is caught at its border.
struct NoNumber {
  std::string why;
};

double Finite(double value, const char* what) {
  if (std::isfinite(value)) return value;
  throw NoNumber{std::string(what) + " is no finite number"};
}

double Add(double a, double b) {
  return Finite(a + b, "a sum");
}
double Subtract(double a, double b) {
  return Finite(a - b, "a difference");
}
double Multiply(double a, double b) {
  return Finite(a * b, "a product");
}
double Divide(double a, double b) {
  if (b == 0.0) throw NoNumber{"it divides " + NumberText(a) + " by 0"};
  return Finite(a / b, "a quotient");
}
double SquareRoot(double a) {
  if (a < 0.0) throw NoNumber{"it takes the square root of " + NumberText(a)};
  return std::sqrt(a);
}
double Absolute(double a) {
  return std::abs(a);
}
double Negative(double a) {
  return -a;
}
double Not(double a) {
  return a == 0.0 ? 1.0 : 0.0;
}
double Smallest(const double* values, int count) {
  return *std::min_element(values, values + count);
}
double Largest(const double* values, int count) {
  return *std::max_element(values, values + count);
}

// The library's own operators would divide by zero in silence, and its optimiser may turn terms round.
void DefineOperations(mu::Parser& parser) {
  parser.EnableOptimizer(false);
  parser.EnableBuiltInOprt(false);
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearOprt();
  parser.ClearInfixOprt();
  parser.ClearPostfixOprt();
  const auto binary = [&parser](const char* name, mu::fun_type2 operation, unsigned precedence) {
    parser.DefineOprt(name, operation, precedence, mu::oaLEFT);
  };
  binary("+", Add, mu::prADD_SUB);
  binary("-", Subtract, mu::prADD_SUB);
  binary("*", Multiply, mu::prMUL_DIV);
  binary("/", Divide, mu::prMUL_DIV);
  binary(
      "<", [](double a, double b) { return a < b ? 1.0 : 0.0; }, mu::prCMP);
  binary(
      "<=", [](double a, double b) { return a <= b ? 1.0 : 0.0; }, mu::prCMP);
  binary(
      ">", [](double a, double b) { return a > b ? 1.0 : 0.0; }, mu::prCMP);
  binary(
      ">=", [](double a, double b) { return a >= b ? 1.0 : 0.0; }, mu::prCMP);
  binary(
      "==", [](double a, double b) { return a == b ? 1.0 : 0.0; }, mu::prCMP);
  binary(
      "!=", [](double a, double b) { return a != b ? 1.0 : 0.0; }, mu::prCMP);
  binary(
      "&&", [](double a, double b) { return a != 0.0 && b != 0.0 ? 1.0 : 0.0; }, mu::prLAND);
  binary(
      "||", [](double a, double b) { return a != 0.0 || b != 0.0 ? 1.0 : 0.0; }, mu::prLOR);
  parser.DefineInfixOprt("-", Negative);
  parser.DefineInfixOprt("!", Not);
  parser.DefineFun("abs", Absolute);
  parser.DefineFun("sqrt", SquareRoot);
  parser.DefineFun("min", Smallest);
  parser.DefineFun("max", Largest);
}

constexpr std::array<std::string_view, 4> kFunctions = {"min", "max", "abs", "sqrt"};

bool IsNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// The name that begins at `place`; "" when something else stands there.
std::string_view NameAt(std::string_view text, std::size_t place) {
  if (place >= text.size() || (text[place] >= '0' && text[place] <= '9')) return {};
  std::size_t end = place;
  while (end < text.size() && IsNameCharacter(text[end])) ++end;
  return text.substr(place, end - place);
}

// The name that ends before `place`; "" when something else stands there.
std::string_view NameBefore(std::string_view text, std::size_t place) {
  std::size_t begin = place;
  while (begin > 0 && IsNameCharacter(text[begin - 1])) --begin;
  return NameAt(text, begin);
}

std::string Complaint(const mu::ParserError& error, const std::string& text,
                      const std::vector<std::string>& names) {
  // What follows the last character is missing there.
  const std::size_t place = std::min(static_cast<std::size_t>(std::max(error.GetPos(), 0)), text.size());
  const std::string where = "character " + std::to_string(place + 1) + ": ";
  const std::string_view name = NameAt(text, place);
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !name.empty()) {
    if (std::ranges::count(kFunctions, name) > 0)
      return where + "behind '" + std::string(name) + "' stands '('";
    return where + UnknownName("measure", name, names);
  }
  if (const std::string_view function = NameBefore(text, place);
      text.substr(place, 1) == "(" && !function.empty())
    return where + "unknown function '" + std::string(function) + "'; known: " + NamesOf(kFunctions);
  if (place == text.size()) return where + "it ends too early: a value or a bracket is missing";
  std::string found = "'";
  found.append(name.empty() ? std::string_view(text).substr(place, 1) : name).append("'");
  return where + found +
         " cannot stand here; a formula consists of measures, numbers, + - * /, < <= > >= == !=, && || !, "
         "condition ? a : b, brackets, min, max, abs and sqrt";
}

}  // namespace

struct Formula::Compiled {
  std::vector<std::string> names;
  std::vector<double> values;  // of the names; the parser reads them here
  mu::Parser parser;
};

Formula::Formula(std::unique_ptr<Compiled> compiled) : compiled_(std::move(compiled)) {}
Formula::Formula(Formula&& other) noexcept = default;
Formula& Formula::operator=(Formula&& other) noexcept = default;
Formula::~Formula() = default;

Result<Formula> Formula::Compile(const std::string& text, const std::vector<std::string>& names) {
  if (text.size() > kMaxFormulaLength) {
    return InvalidInput("a formula of " + std::to_string(text.size()) + " characters; it may have " +
                        std::to_string(kMaxFormulaLength));
  }
  const auto strange = std::ranges::find_if(text, [](char c) { return c < ' ' || c > '~' || c == '"'; });
  if (strange != text.end()) {
    return InvalidInput("character " + std::to_string(strange - text.begin() + 1) +
                        " is none that a formula consists of");
  }
  if (text.find_first_not_of(' ') == std::string::npos) return InvalidInput("the formula is empty");
  auto compiled = std::make_unique<Compiled>();
  compiled->names = names;
  compiled->values.assign(names.size(), 0.0);
  try {
    DefineOperations(compiled->parser);
    for (std::size_t i = 0; i < names.size(); ++i) compiled->parser.DefineVar(names[i], &compiled->values[i]);
    compiled->parser.SetExpr(text);
    compiled->parser.GetUsedVar();  // reads it without computing anything
    try {
      compiled->parser.Eval();  // finds what reading it does not
    } catch (const NoNumber&) {
      // Of these values; a run has others.
    }
    if (compiled->parser.GetNumResults() != 1)
      return InvalidInput("it gives " + std::to_string(compiled->parser.GetNumResults()) +
                          " values, separated by commas; one is expected");
  } catch (const mu::ParserError& error) {
    return InvalidInput(Complaint(error, text, names));
  }
  return Formula(std::move(compiled));
}

Result<double> Formula::Evaluate(std::span<const double> values) {
  GAUNTLET_CHECK(values.size() == compiled_->values.size(), "a value for each name");
  std::ranges::copy(values, compiled_->values.begin());
  std::string why;
  try {
    return Finite(compiled_->parser.Eval(), "its value");
  } catch (const NoNumber& no_number) {
    why = no_number.why;
  } catch (const mu::ParserError& error) {
    why = error.GetMsg();
  }
  std::string used;
  for (const auto& [name, value] : compiled_->parser.GetUsedVar()) {
    used.append(used.empty() ? ", with " : ", ").append(name).append(" = ").append(NumberText(*value));
  }
  return InvalidInput(why + used);
}

}  // namespace gauntlet::controllers::generic
