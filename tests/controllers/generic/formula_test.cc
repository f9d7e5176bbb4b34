#include "controllers/generic/formula.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>

namespace gauntlet::controllers::generic {
namespace {

const std::vector<std::string> kNames = {"robots", "largest_cluster", "zero"};
constexpr double kValues[] = {10.0, 4.0, 0.0};

Result<double> ValueOf(const std::string& text) {
  Result<Formula> formula = Formula::Compile(text, kNames);
  if (!formula.ok()) return formula.error();
  return formula->Evaluate(kValues);
}

std::string ErrorOf(const std::string& text) {
  const Result<double> value = ValueOf(text);
  return value.ok() ? "" : value.error().message;
}

TEST(Formula, HasTheOperationsThatItsHeaderNames) {
  const std::pair<const char*, double> cases[] = {
      {"largest_cluster < 0.5 * robots", 1.0},
      {"1 - 2 * 3 + 4", -1.0},
      {"2 - -1", 3.0},
      {"(1 + 2) * 3 / 2", 4.5},
      {"robots >= 10 && !(largest_cluster != 4)", 1.0},
      {"robots <= 9 || largest_cluster == 5", 0.0},
      {"robots > 10 ? 1 : largest_cluster", 4.0},
      {"min(robots, 3, 2) + max(robots, 3)", 12.0},
      {"sqrt(abs(-9))", 3.0},
      {"1.5e1", 15.0},
  };
  for (const auto& [text, value] : cases) {
    const Result<double> found = ValueOf(text);
    ASSERT_TRUE(found.ok()) << text << ": " << found.error().message;
    EXPECT_EQ(*found, value) << text;
  }
}

TEST(Formula, LooksOnlyAtTheBranchThatItTakes) {
  EXPECT_EQ(*ValueOf("zero > 0 ? robots / zero : 7"), 7.0);
}

TEST(Formula, NamesTheValuesOfWhatIsNoNumber) {
  EXPECT_EQ(ErrorOf("robots / zero"), "it divides 10 by 0, with robots = 10, zero = 0");
  EXPECT_EQ(ErrorOf("1 / zero > 3"), "it divides 1 by 0, with zero = 0");
  EXPECT_EQ(ErrorOf("sqrt(zero - robots)"), "it takes the square root of -10, with robots = 10, zero = 0");
  EXPECT_EQ(ErrorOf("1e300 * 1e300 * zero"), "a product is no finite number, with zero = 0");
}

TEST(Formula, SaysWhereItIsWrong) {
  EXPECT_EQ(ErrorOf("3 + largest_clutser"),
            "character 5: unknown measure 'largest_clutser'; did you mean 'largest_cluster'?");
  EXPECT_EQ(ErrorOf("heat"), "character 1: unknown measure 'heat'; known: robots, largest_cluster, zero");
  EXPECT_EQ(ErrorOf("sin(robots)"), "character 4: unknown function 'sin'; known: min, max, abs, sqrt");
  EXPECT_EQ(ErrorOf("min"), "character 1: behind 'min' stands '('");
  EXPECT_EQ(ErrorOf("robots +"), "character 9: it ends too early: a value or a bracket is missing");
  EXPECT_EQ(ErrorOf("(robots"), "character 8: it ends too early: a value or a bracket is missing");
  EXPECT_EQ(ErrorOf("robots ^ 2"),
            "character 8: '^' cannot stand here; a formula consists of measures, numbers, + - * /, < <= > >= "
            "== !=, && || !, condition ? a : b, brackets, min, max, abs and sqrt");
  EXPECT_EQ(ErrorOf("robots = 3"),
            "character 8: '=' cannot stand here; a formula consists of measures, numbers, + - * /, < <= > >= "
            "== !=, && || !, condition ? a : b, brackets, min, max, abs and sqrt");
  EXPECT_EQ(ErrorOf("robots robots"),
            "character 8: 'robots' cannot stand here; a formula consists of measures, numbers, + - * /, < <= "
            "> >= == !=, && || !, condition ? a : b, brackets, min, max, abs and sqrt");
  EXPECT_EQ(ErrorOf("robots, 3"), "it gives 2 values, separated by commas; one is expected");
  EXPECT_EQ(ErrorOf("robots\n"), "character 7 is none that a formula consists of");
  EXPECT_EQ(ErrorOf("\"a\""), "character 1 is none that a formula consists of");
  EXPECT_EQ(ErrorOf("  "), "the formula is empty");
  EXPECT_EQ(ErrorOf(std::string(1001, '1')), "a formula of 1001 characters; it may have 1000");
}

TEST(Formula, ReadsNumbersAlikeInEveryLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    std::setlocale(LC_ALL, locale);  // those that the machine has
    EXPECT_EQ(*ValueOf("0.5 * robots"), 5.0) << locale;
  }
  std::setlocale(LC_ALL, before.c_str());
}

}  // namespace
}  // namespace gauntlet::controllers::generic
