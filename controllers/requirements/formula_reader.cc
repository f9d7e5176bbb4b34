#include "controllers/requirements/formula_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "base/parse_number.h"
#include "controllers/requirements/measures.h"

namespace gauntlet::controllers::requirements {
namespace {

constexpr double kLargestNumber = 1e9;

constexpr std::array<std::pair<std::string_view, Operation>, 6> kComparisons = {
    {{"<=", Operation::kLessEqual},
     {">=", Operation::kGreaterEqual},
     {"==", Operation::kEqual},
     {"!=", Operation::kUnequal},
     {"<", Operation::kLess},
     {">", Operation::kGreater}}};
constexpr std::array<std::pair<std::string_view, Operation>, 3> kFunctions = {
    {{"min", Operation::kSmaller}, {"max", Operation::kLarger}, {"abs", Operation::kAbsolute}}};
constexpr std::array<std::pair<std::string_view, Operation>, 4> kOfRobots = {
    {{"count", Operation::kCount},
     {"least", Operation::kLeast},
     {"greatest", Operation::kGreatest},
     {"mean", Operation::kMean}}};
constexpr std::array<std::pair<std::string_view, Place>, 3> kPlaces = {
    {{"goal", Place::kGoal}, {"start", Place::kStart}, {"center", Place::kCenter}}};

template <typename Words>
auto Meant(const Words& words, std::string_view word) {
  const auto found = std::ranges::find(words, word, [](const auto& entry) { return entry.first; });
  return found == words.end() ? std::nullopt : std::optional(found->second);
}

bool IsLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

// How many characters the token has that `text` begins with.
std::size_t TokenLength(std::string_view text) {
  const auto run = [text](auto belongs) {
    return static_cast<std::size_t>(std::ranges::find_if_not(text, belongs) - text.begin());
  };
  if (IsLetter(text[0])) return run([](char c) { return IsLetter(c) || IsDigit(c); });
  if (IsDigit(text[0]) || text[0] == '.') {
    std::size_t length = run([](char c) { return IsDigit(c) || c == '.'; });
    if (length < text.size() && (text[length] == 'e' || text[length] == 'E')) {
      ++length;
      if (length < text.size() && (text[length] == '-' || text[length] == '+')) ++length;
      while (length < text.size() && IsDigit(text[length])) ++length;
    }
    return length;
  }
  constexpr std::array<std::string_view, 6> kPairs = {"<=", ">=", "==", "!=", "&&", "||"};
  return std::ranges::count(kPairs, text.substr(0, 2)) > 0 ? 2 : 1;
}

// Counts how deep it is.
class Deeper {
 public:
  explicit Deeper(int& depth) : depth_(depth) { ++depth_; }
  Deeper(const Deeper&) = delete;
  Deeper& operator=(const Deeper&) = delete;
  ~Deeper() { --depth_; }

 private:
  int& depth_;
};

}  // namespace

Result<std::size_t> FormulaReader::Read(std::string_view text) {
  if (text.size() > kMostCharacters)
    return InvalidInput(
        fmt::format("a formula of {} characters; it may have {}", text.size(), kMostCharacters));
  text_ = text;
  rest_ = 0;
  TRY(Next());
  if (token_.empty()) return InvalidInput("the formula is empty");
  TRY(const std::size_t node, Implication());
  if (!token_.empty()) return Wrong(fmt::format("'{}' cannot stand here", token_));
  return node;
}

Status FormulaReader::Next() {
  last_end_ = token_at_ + token_.size();
  const std::size_t at = std::min(text_.find_first_not_of(' ', rest_), text_.size());
  token_at_ = at;
  token_ = text_.substr(at, at < text_.size() ? TokenLength(text_.substr(at)) : 0);
  rest_ = at + token_.size();
  constexpr std::string_view kSigns = "<>=!&|+-*/(),[]";
  const bool known = token_.empty() || IsLetter(token_[0]) || IsDigit(token_[0]) || token_[0] == '.' ||
                     kSigns.find(token_[0]) != std::string_view::npos;
  if (!known) return Wrong("nothing that a formula consists of");
  return Ok{};
}

Error FormulaReader::Wrong(const std::string& what) const {
  return InvalidInput(fmt::format("character {}: {}", token_at_ + 1, what));
}

bool FormulaReader::Takes(std::string_view word) {
  return token_ == word;
}

Status FormulaReader::Expect(std::string_view word) {
  if (!Takes(word))
    return Wrong(token_.empty() ? fmt::format("it ends too early: '{}' is missing", word)
                                : fmt::format("'{}' instead of '{}'", token_, word));
  return Next();
}

std::size_t FormulaReader::Add(Node node) {
  nodes_.push_back(std::move(node));
  return nodes_.size() - 1;
}

Status FormulaReader::NeedTruth(std::size_t node, std::string_view of) const {
  if (nodes_[node].truth) return Ok{};
  return Wrong(fmt::format("'{}' is of something that holds or does not, not of a number: compare it", of));
}

Status FormulaReader::NeedNumber(std::size_t node, std::string_view of) const {
  if (!nodes_[node].truth) return Ok{};
  return Wrong(fmt::format("'{}' is of a number, not of something that holds or does not", of));
}

Result<Node> FormulaReader::Combined(Operation operation, std::size_t left, std::size_t right) const {
  return Node{.operation = operation,
              .per_robot = nodes_[left].per_robot || nodes_[right].per_robot,
              .left = left,
              .right = right};
}

FormulaReader::Index FormulaReader::Implication() {
  TRY(const std::size_t left, Disjunction());
  if (!Takes("implies")) return left;
  const Deeper deeper(depth_);
  if (depth_ > kDeepest) return Wrong(fmt::format("it is nested deeper than {}", kDeepest));
  TRY(NeedTruth(left, "implies"));
  TRY(Next());
  TRY(const std::size_t right, Implication());
  TRY(NeedTruth(right, "implies"));
  TRY(Node negation, Combined(Operation::kNot, left, left));
  negation.truth = true;
  TRY(Node implication, Combined(Operation::kOr, Add(negation), right));
  implication.truth = true;
  return Add(implication);
}

FormulaReader::Index FormulaReader::Disjunction() {
  TRY(std::size_t left, Conjunction());
  while (Takes("or") || Takes("||")) {
    TRY(NeedTruth(left, "or"));
    TRY(Next());
    TRY(const std::size_t right, Conjunction());
    TRY(NeedTruth(right, "or"));
    TRY(Node node, Combined(Operation::kOr, left, right));
    node.truth = true;
    left = Add(node);
  }
  return left;
}

FormulaReader::Index FormulaReader::Conjunction() {
  TRY(std::size_t left, Until());
  while (Takes("and") || Takes("&&")) {
    TRY(NeedTruth(left, "and"));
    TRY(Next());
    TRY(const std::size_t right, Until());
    TRY(NeedTruth(right, "and"));
    TRY(Node node, Combined(Operation::kAnd, left, right));
    node.truth = true;
    left = Add(node);
  }
  return left;
}

FormulaReader::Index FormulaReader::Until() {
  TRY(const std::size_t left, Unary());
  if (!Takes("until")) return left;
  TRY(NeedTruth(left, "until"));
  TRY(Next());
  TRY(const Window window, ReadWindow());
  TRY(const std::size_t right, Unary());
  TRY(NeedTruth(right, "until"));
  TRY(Node node, Combined(Operation::kUntil, left, right));
  if (node.per_robot) return Wrong("'until' is of the swarm, not of each robot");
  node.truth = true;
  node.window = window;
  return Add(node);
}

Result<Window> FormulaReader::ReadWindow() {
  Window window;
  if (!Takes("[")) return window;
  TRY(Next());
  TRY(window.begin, Second());
  TRY(Expect(","));
  TRY(window.end, Second());
  if (window.begin > window.end)
    return Wrong(fmt::format("the window [{},{}] ends before it begins", NumberText(window.begin),
                             NumberText(window.end)));
  TRY(Expect("]"));
  return window;
}

Result<double> FormulaReader::Second() {
  if (Takes("-")) return Wrong("a window lies in the future: its seconds count from 0 on");
  return Number();
}

Result<double> FormulaReader::Number() {
  const bool digits = !token_.empty() && (IsDigit(token_[0]) || token_[0] == '.');
  const std::optional<double> number = digits ? ParseNumber<double>(token_) : std::nullopt;
  if (!number || !(*number <= kLargestNumber))
    return Wrong(fmt::format("'{}' is no number from 0 to {}", token_, NumberText(kLargestNumber)));
  TRY(Next());
  return *number;
}

FormulaReader::Index FormulaReader::Unary() {
  const Deeper deeper(depth_);
  if (depth_ > kDeepest) return Wrong(fmt::format("it is nested deeper than {}", kDeepest));
  const std::string word(token_);
  const bool negates = word == "not" || word == "!";
  if (!negates && word != "always" && word != "eventually") return Comparison();
  TRY(Next());
  Window window;
  if (!negates) {
    TRY(window, ReadWindow());
  }
  TRY(const std::size_t of, Unary());
  TRY(NeedTruth(of, word));
  const Operation operation = negates            ? Operation::kNot
                              : word == "always" ? Operation::kAlways
                                                 : Operation::kEventually;
  TRY(Node node, Combined(operation, of, of));
  if (node.per_robot && !negates) return Wrong(fmt::format("'{}' is of the swarm, not of each robot", word));
  node.truth = true;
  node.window = window;
  return Add(node);
}

FormulaReader::Index FormulaReader::Comparison() {
  const std::size_t begin = token_at_;
  TRY(const std::size_t left, Sum());
  const std::optional<Operation> operation = Meant(kComparisons, token_);
  if (!operation) return left;
  const std::string sign(token_);
  TRY(NeedNumber(left, sign));
  TRY(Next());
  TRY(const std::size_t right, Sum());
  TRY(NeedNumber(right, sign));
  TRY(Node node, Combined(*operation, left, right));
  node.truth = true;
  node.text = std::string(text_.substr(begin, last_end_ - begin));
  return Add(node);
}

FormulaReader::Index FormulaReader::Sum() {
  TRY(std::size_t left, Product());
  while (Takes("+") || Takes("-")) {
    const std::string sign(token_);
    TRY(NeedNumber(left, sign));
    TRY(Next());
    TRY(const std::size_t right, Product());
    TRY(NeedNumber(right, sign));
    TRY(const Node node, Combined(sign == "+" ? Operation::kAdd : Operation::kSubtract, left, right));
    left = Add(node);
  }
  return left;
}

FormulaReader::Index FormulaReader::Product() {
  TRY(std::size_t left, Factor());
  while (Takes("*") || Takes("/")) {
    const bool divides = Takes("/");
    TRY(NeedNumber(left, token_));
    TRY(Next());
    std::size_t right = 0;
    if (divides) {
      // A quotient by what may be 0 has no range to scale by.
      TRY(const double divisor, Number());
      if (divisor == 0.0) return Wrong("it divides by 0");
      right = Add({.operation = Operation::kNumber, .number = 1.0 / divisor});
    } else {
      TRY(right, Factor());
      TRY(NeedNumber(right, "*"));
    }
    TRY(const Node node, Combined(Operation::kMultiply, left, right));
    left = Add(node);
  }
  return left;
}

FormulaReader::Index FormulaReader::Factor() {
  const Deeper deeper(depth_);
  if (depth_ > kDeepest) return Wrong(fmt::format("it is nested deeper than {}", kDeepest));
  if (token_.empty()) return Wrong("it ends too early: a value or a bracket is missing");
  if (Takes("(")) {
    TRY(Next());
    TRY(const std::size_t inner, Implication());
    TRY(Expect(")"));
    return inner;
  }
  if (Takes("-")) {
    TRY(Next());
    TRY(const std::size_t of, Factor());
    TRY(NeedNumber(of, "-"));
    TRY(const Node node, Combined(Operation::kNegative, of, of));
    return Add(node);
  }
  if (IsDigit(token_[0]) || token_[0] == '.') {
    TRY(const double number, Number());
    return Add({.operation = Operation::kNumber, .number = number});
  }
  if (!IsLetter(token_[0])) return Wrong(fmt::format("'{}' cannot stand here", token_));
  return Named(std::string(token_));
}

FormulaReader::Index FormulaReader::Named(const std::string& name) {
  if (const std::optional<Operation> operation = Meant(kFunctions, name)) return OfNumbers(*operation);
  if (const std::optional<Operation> operation = Meant(kOfRobots, name)) return OfRobots(*operation);
  if (const auto sentence = std::ranges::find(sentences_, name, &Sentence::name);
      sentence != sentences_.end()) {
    if (within_robots_ && nodes_[sentence->node].truth)
      return Wrong(fmt::format("'{}' is of the swarm, not of each robot", name));
    TRY(Next());
    return sentence->node;
  }
  const std::span<const MeasureRow> rows = MeasureRows();
  for (const bool per_robot : {true, false}) {
    if (per_robot && !within_robots_) continue;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (rows[row].name == name && rows[row].per_robot == per_robot) return Measure(row);
    }
  }
  if (FindByName(metrics_, name) != nullptr) {
    TRY(Next());
    const auto row = static_cast<std::size_t>(FindByName(metrics_, name) - metrics_.data());
    return Add({.operation = Operation::kMetric, .row = row});
  }
  if (FindByName(rows, name) != nullptr)
    return Wrong(
        fmt::format("'{0}' is of each robot: write count(... {0} ...), least({0}), greatest({0}) or "
                    "mean({0})",
                    name));
  std::vector<std::string_view> known;
  for (const Sentence& sentence : sentences_) known.push_back(sentence.name);
  for (const MeasureRow& row : rows) {
    if (std::ranges::count(known, row.name) == 0) known.push_back(row.name);
  }
  for (const auto* words : {&kOfRobots}) {
    for (const auto& [word, operation] : *words) known.push_back(word);
  }
  for (const MetricInfo& metric : metrics_) known.push_back(metric.name);
  return Wrong(UnknownName("measure", name, known));
}

FormulaReader::Index FormulaReader::OfNumbers(Operation operation) {
  const std::string name(token_);
  TRY(Next());
  TRY(Expect("("));
  TRY(std::size_t left, Implication());
  TRY(NeedNumber(left, name));
  if (operation == Operation::kAbsolute) {
    TRY(const Node node, Combined(operation, left, left));
    left = Add(node);
  } else {
    if (!Takes(",")) return Wrong(fmt::format("'{}' is of two values or more, separated by commas", name));
    while (Takes(",")) {
      TRY(Next());
      TRY(const std::size_t right, Implication());
      TRY(NeedNumber(right, name));
      TRY(const Node node, Combined(operation, left, right));
      left = Add(node);
    }
  }
  TRY(Expect(")"));
  return left;
}

FormulaReader::Index FormulaReader::OfRobots(Operation operation) {
  const std::string name(token_);
  if (within_robots_) return Wrong(fmt::format("'{}' stands within another one", name));
  TRY(Next());
  TRY(Expect("("));
  within_robots_ = true;
  const Index of = Implication();
  within_robots_ = false;
  if (!of) return of;
  TRY(operation == Operation::kCount ? NeedTruth(*of, name) : NeedNumber(*of, name));
  if (!nodes_[*of].per_robot)
    return Wrong(
        fmt::format("what stands in '{}' is the same for all robots: say something of each, such as "
                    "distance_to(goal)",
                    name));
  TRY(Expect(")"));
  return Add({.operation = operation, .left = *of, .right = *of});
}

FormulaReader::Index FormulaReader::Measure(std::size_t row) {
  const MeasureRow& measure = MeasureRows()[row];
  Node node{.operation = Operation::kMeasure, .per_robot = measure.per_robot, .row = row};
  TRY(Next());
  if (measure.argument == Argument::kNone) return Add(node);
  TRY(Expect("("));
  if (measure.argument == Argument::kLinkRange) {
    TRY(node.number, Number());
  } else if (const std::optional<Place> place = Meant(kPlaces, token_)) {
    node.place = *place;
    TRY(Next());
  } else {
    for (double* coordinate : {&node.point.x(), &node.point.y()}) {
      const bool negative = Takes("-");
      if (negative) {
        TRY(Next());
      }
      if (token_.empty() || (!IsDigit(token_[0]) && token_[0] != '.'))
        return Wrong("a distance is to (goal), (start), (center) or (X, Y) in m");
      TRY(const double number, Number());
      *coordinate = negative ? -number : number;
      if (coordinate == &node.point.x()) {
        TRY(Expect(","));
      }
    }
  }
  TRY(Expect(")"));
  return Add(node);
}

}  // namespace gauntlet::controllers::requirements
