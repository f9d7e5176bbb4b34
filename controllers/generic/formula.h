// Formulas over named numbers, as users write them: + - * /, comparisons, && || !, "condition ? a : b", min,
// max, abs and sqrt. True is 1, false is 0. Each of these operations is exact to the last bit by IEEE 754, so
// that a formula gives the same number on every machine; there is nothing else for that reason.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"

namespace gauntlet::controllers::generic {

inline constexpr std::size_t kMaxFormulaLength = 1000;  // characters

class Formula {
 public:
  // `names`: what it may use. Error: what is wrong and at which character; of an unknown name the nearest
  // one.
  static Result<Formula> Compile(const std::string& text, const std::vector<std::string>& names);

  Formula(Formula&& other) noexcept;
  Formula& operator=(Formula&& other) noexcept;
  ~Formula();

  // `values`: in the order of the names. Error: it divides by zero, or a step of it is no finite number;
  // names the values that the formula uses.
  Result<double> Evaluate(std::span<const double> values);

 private:
  struct Compiled;
  explicit Formula(std::unique_ptr<Compiled> compiled);

  std::unique_ptr<Compiled> compiled_;
};

}  // namespace gauntlet::controllers::generic
