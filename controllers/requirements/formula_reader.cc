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

// Operations between two operands. Of one binding the left one comes first; but of `implies` the right one.
struct Infix {
  std::string_view word;
  Operation operation = Operation::kOr;
  int binding = 0;
};
constexpr int kImplies = 1;
constexpr int kUntil = 4;
constexpr int kPrefix = 5;  // not, always, eventually
constexpr int kComparison = 6;
constexpr int kTightest = 9;
constexpr std::array<Infix, 16> kInfixes = {{{"implies", Operation::kOr, kImplies},
                                             {"or", Operation::kOr, 2},
                                             {"||", Operation::kOr, 2},
                                             {"and", Operation::kAnd, 3},
                                             {"&&", Operation::kAnd, 3},
                                             {"until", Operation::kUntil, kUntil},
                                             {"<=", Operation::kLessEqual, kComparison},
                                             {">=", Operation::kGreaterEqual, kComparison},
                                             {"==", Operation::kEqual, kComparison},
                                             {"!=", Operation::kUnequal, kComparison},
                                             {"<", Operation::kLess, kComparison},
                                             {">", Operation::kGreater, kComparison},
                                             {"+", Operation::kAdd, 7},
                                             {"-", Operation::kSubtract, 7},
                                             {"*", Operation::kMultiply, 8},
                                             {"/", Operation::kMultiply, 8}}};
constexpr std::array<std::pair<std::string_view, Operation>, 4> kPrefixes = {
    {{"not", Operation::kNot},
     {"!", Operation::kNot},
     {"always", Operation::kAlways},
     {"eventually", Operation::kEventually}}};
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

const Infix* FindInfix(std::string_view word) {
  const auto* const found = std::ranges::find(kInfixes, word, &Infix::word);
  return found == kInfixes.end() ? nullptr : found;
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
  TRY(const std::size_t node, Expression(kImplies));
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

Status FormulaReader::Need(bool truth, std::size_t node, std::string_view of) const {
  if (nodes_[node].truth == truth) return Ok{};
  if (!truth) return Wrong(fmt::format("'{}' is of a number, not of something that holds or does not", of));
  return Wrong(fmt::format("'{}' is of something that holds or does not, not of a number: compare it", of));
}

std::size_t FormulaReader::Add(Operation operation, bool truth, std::size_t left, std::size_t right) {
  return Add({.operation = operation,
              .truth = truth,
              .per_robot = nodes_[left].per_robot || nodes_[right].per_robot,
              .left = left,
              .right = right});
}

FormulaReader::Index FormulaReader::Expression(int least_binding) {
  const Deeper deeper(depth_);
  if (depth_ > kDeepest) return Wrong(fmt::format("it is nested deeper than {}", kDeepest));
  const std::size_t begin = token_at_;
  TRY(std::size_t left, Operand(least_binding));
  for (const Infix* infix = FindInfix(token_); infix != nullptr && infix->binding >= least_binding;
       infix = FindInfix(token_)) {
    const bool of_truths = infix->binding < kPrefix;
    TRY(Need(of_truths, left, infix->word));
    TRY(Next());
    Window window;
    if (infix->binding == kUntil) {
      TRY(window, ReadWindow());
    }
    TRY(const std::size_t right, infix->word == "/"
                                     ? Reciprocal()
                                     : Expression(infix->binding + (infix->binding == kImplies ? 0 : 1)));
    TRY(Need(of_truths, right, infix->word));
    if (infix->binding == kImplies) left = Add(Operation::kNot, true, left, left);
    left = Add(infix->operation, infix->binding <= kComparison, left, right);
    nodes_[left].window = window;
    if (infix->binding == kComparison) nodes_[left].text = text_.substr(begin, last_end_ - begin);
    if (infix->binding == kUntil && nodes_[left].per_robot) return WrongOfRobots(infix->word);
  }
  return left;
}

// What has no range to scale by, a quotient by what may be 0, cannot be written.
FormulaReader::Index FormulaReader::Reciprocal() {
  TRY(const double divisor, Number());
  if (divisor == 0.0) return Wrong("it divides by 0");
  return Add({.operation = Operation::kNumber, .number = 1.0 / divisor});
}

Error FormulaReader::WrongOfRobots(std::string_view word) const {
  return Wrong(fmt::format("'{}' is of the swarm, not of each robot", word));
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

FormulaReader::Index FormulaReader::Operand(int least_binding) {
  const std::string_view word = token_;
  const std::optional<Operation> prefix = Meant(kPrefixes, word);
  if (prefix && least_binding > kPrefix) return Wrong(fmt::format("'{}' cannot stand here", word));
  if (prefix) {
    TRY(Next());
    Window window;
    if (*prefix != Operation::kNot) {
      TRY(window, ReadWindow());
    }
    TRY(const std::size_t of, Expression(kPrefix));
    TRY(Need(true, of, word));
    if (nodes_[of].per_robot && *prefix != Operation::kNot) return WrongOfRobots(word);
    const std::size_t node = Add(*prefix, true, of, of);
    nodes_[node].window = window;
    return node;
  }
  if (token_.empty()) return Wrong("it ends too early: a value or a bracket is missing");
  if (Takes("(")) {
    TRY(Next());
    TRY(const std::size_t inner, Expression(kImplies));
    TRY(Expect(")"));
    return inner;
  }
  if (Takes("-")) {
    TRY(Next());
    TRY(const std::size_t of, Expression(kTightest));
    TRY(Need(false, of, "-"));
    return Add(Operation::kNegative, false, of, of);
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
    if (within_robots_ && nodes_[sentence->node].truth) return WrongOfRobots(name);
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
  for (const auto& [word, operation] : kOfRobots) known.push_back(word);
  for (const MetricInfo& metric : metrics_) known.push_back(metric.name);
  return Wrong(UnknownName("measure", name, known));
}

FormulaReader::Index FormulaReader::OfNumbers(Operation operation) {
  const std::string name(token_);
  TRY(Next());
  TRY(Expect("("));
  TRY(std::size_t left, Expression(kImplies));
  TRY(Need(false, left, name));
  if (operation == Operation::kAbsolute) {
    left = Add(operation, false, left, left);
  } else if (!Takes(",")) {
    return Wrong(fmt::format("'{}' is of two values or more, separated by commas", name));
  }
  while (operation != Operation::kAbsolute && Takes(",")) {
    TRY(Next());
    TRY(const std::size_t right, Expression(kImplies));
    TRY(Need(false, right, name));
    left = Add(operation, false, left, right);
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
  const Index of = Expression(kImplies);
  within_robots_ = false;
  if (!of) return of;
  TRY(Need(operation == Operation::kCount, *of, name));
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
