// Reads formulas of requirements as people write them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "controllers/requirements/sentences.h"

namespace gauntlet::controllers::requirements {

inline constexpr std::size_t kMostCharacters = 2000;  // of a formula
inline constexpr int kDeepest = 100;                  // brackets and operations within one another

// Grammar, from what binds least to what binds most; windows are in s:
//   implies | or || | and && | until[A,B] | not !, always[A,B], eventually[A,B] | < <= > >= == !=
//   | + - | * | -, numbers, measures, metrics, names of sentences before, (), min(,) max(,) abs()
//   | count(TRUTH), least(NUMBER), greatest(NUMBER), mean(NUMBER) of robots
// A name is a sentence's, else a measure's, else a metric's.
class FormulaReader {
 public:
  // All outlive it; nodes of what is read are added to `nodes`.
  FormulaReader(std::span<const MetricInfo> metrics, const std::vector<Sentence>& sentences,
                std::vector<Node>& nodes)
      : metrics_(metrics), sentences_(sentences), nodes_(nodes) {}

  // The node of the formula. Error: "character N: " and what is wrong there.
  Result<std::size_t> Read(std::string_view text);

 private:
  using Index = Result<std::size_t>;

  Status Next();
  bool Takes(std::string_view word);
  Status Expect(std::string_view word);
  Error Wrong(const std::string& what) const;
  Error WrongOfRobots(std::string_view word) const;
  Status Need(bool truth, std::size_t node, std::string_view of) const;
  std::size_t Add(Node node);
  std::size_t Add(Operation operation, bool truth, std::size_t left, std::size_t right);

  // Up to what binds less.
  Index Expression(int least_binding);
  Index Operand(int least_binding);
  Index Reciprocal();
  Index Named(const std::string& name);
  Index OfNumbers(Operation operation);
  Index OfRobots(Operation operation);
  Index Measure(std::size_t row);
  Result<Window> ReadWindow();
  Result<double> Number();
  Result<double> Second();

  std::span<const MetricInfo> metrics_;
  const std::vector<Sentence>& sentences_;
  std::vector<Node>& nodes_;
  std::string_view text_;
  std::string_view token_;  // "" at the end
  std::size_t token_at_ = 0;
  std::size_t rest_ = 0;      // behind the token
  std::size_t last_end_ = 0;  // of the token before
  int depth_ = 0;
  bool within_robots_ = false;
};

}  // namespace gauntlet::controllers::requirements
