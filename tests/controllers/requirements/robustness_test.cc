// Robustness against a slow implementation of the definition that was written apart from it, on random
// formulas and runs; and the values that the definition gives by hand.
#include "controllers/requirements/robustness.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "controllers/requirements/formula_reader.h"
#include "tests/controllers/requirements/recorded_run.h"

namespace gauntlet::controllers::requirements {
namespace {

using testing_support::RecordedRun;

constexpr double kWidth = 5.9;  // m, of the arena's interior, and so of the range of x
constexpr int kRobots = 3;
constexpr int kLastTick = 15;

struct Answer {
  double robustness = 0.0;
  bool holds = false;
};

// A formula as text, and what it means, by the definition: word for word, one moment after the other.
struct Reference {
  std::string text;
  std::function<Answer(int tick)> at;
};

class RandomFormulas {
 public:
  RandomFormulas(std::mt19937_64& random, const std::vector<std::vector<double>>& x)
      : random_(random), x_(x) {}

  Reference Draw(int depth) {
    switch (depth == 0 ? 0 : Pick(8)) {
      case 0:
        return Comparison();
      case 1: {
        const Reference of = Draw(depth - 1);
        return {"not (" + of.text + ")", [of](int tick) {
                  const Answer answer = of.at(tick);
                  return Answer{-answer.robustness, !answer.holds};
                }};
      }
      case 2:
        return Both("and", depth, [](const Answer& a, const Answer& b) {
          return Answer{std::min(a.robustness, b.robustness), a.holds && b.holds};
        });
      case 3:
        return Both("or", depth, [](const Answer& a, const Answer& b) {
          return Answer{std::max(a.robustness, b.robustness), a.holds || b.holds};
        });
      case 4:
        return Both("implies", depth, [](const Answer& a, const Answer& b) {
          return Answer{std::max(-a.robustness, b.robustness), !a.holds || b.holds};
        });
      case 5:
        return Always(depth);
      case 6:
        return Eventually(depth);
      default:
        return Until(depth);
    }
  }

 private:
  int Pick(int below) { return static_cast<int>(random_() % static_cast<std::uint64_t>(below)); }

  Reference Comparison() {
    const bool greatest = Pick(2) == 0;
    const int sign = Pick(6);
    const double bound = (Pick(41) - 20) / 8.0;
    static const std::vector<std::string> kSigns = {" < ", " <= ", " > ", " >= ", " == ", " != "};
    const std::string bound_text = (bound < 0 ? "-" : "") + std::to_string(std::abs(bound));
    return {(greatest ? "greatest(x)" : "least(x)") + kSigns[static_cast<std::size_t>(sign)] + bound_text,
            [=, this](int tick) {
              const std::vector<double>& x = x_[static_cast<std::size_t>(tick)];
              const double value =
                  greatest ? *std::max_element(x.begin(), x.end()) : *std::min_element(x.begin(), x.end());
              const double over = value - bound;
              const bool holds[] = {over<0, over <= 0, over> 0, over >= 0, over == 0, over != 0};
              const double distance[] = {-over, -over, over, over, -std::abs(over), std::abs(over)};
              return Answer{std::clamp(distance[sign] / kWidth, -1.0, 1.0), holds[sign]};
            }};
  }

  template <typename Combine>
  Reference Both(const std::string& word, int depth, const Combine& combine) {
    const Reference left = Draw(depth - 1);
    const Reference right = Draw(depth - 1);
    return {"(" + left.text + ") " + word + " (" + right.text + ")",
            [=](int tick) { return combine(left.at(tick), right.at(tick)); }};
  }

  struct Ticks {
    std::string text;
    int first = 0;
    int last = kLastTick + 1;
  };
  Ticks DrawTicks() {
    if (Pick(4) == 0) return {""};
    const int first = Pick(4) == 0 ? Pick(20) : Pick(4);
    const int last = first + Pick(8);
    const auto seconds = [](int ticks) {
      return std::to_string(ticks / 10) + "." + std::to_string(ticks % 10);
    };
    return {"[" + seconds(first) + "," + seconds(last) + "]", first, last};
  }

  Reference Always(int depth) {
    const Ticks ticks = DrawTicks();
    const Reference of = Draw(depth - 1);
    return {"always" + ticks.text + " (" + of.text + ")", [=](int tick) {
              Answer all{1.0, true};
              for (int at = tick + ticks.first; at <= tick + ticks.last && at <= kLastTick; ++at) {
                const Answer one = of.at(at);
                all = {std::min(all.robustness, one.robustness), all.holds && one.holds};
              }
              return all;
            }};
  }

  Reference Eventually(int depth) {
    const Ticks ticks = DrawTicks();
    const Reference of = Draw(depth - 1);
    return {"eventually" + ticks.text + " (" + of.text + ")", [=](int tick) {
              Answer any{-1.0, false};
              for (int at = tick + ticks.first; at <= tick + ticks.last && at <= kLastTick; ++at) {
                const Answer one = of.at(at);
                any = {std::max(any.robustness, one.robustness), any.holds || one.holds};
              }
              return any;
            }};
  }

  Reference Until(int depth) {
    const Ticks ticks = DrawTicks();
    const Reference meanwhile = Draw(depth - 1);
    const Reference goal = Draw(depth - 1);
    return {"(" + meanwhile.text + ") until" + ticks.text + " (" + goal.text + ")", [=](int tick) {
              Answer any{-1.0, false};
              for (int at = tick + ticks.first; at <= tick + ticks.last && at <= kLastTick; ++at) {
                Answer all = goal.at(at);
                for (int before = tick; before < at; ++before) {
                  const Answer one = meanwhile.at(before);
                  all = {std::min(all.robustness, one.robustness), all.holds && one.holds};
                }
                any = {std::max(any.robustness, all.robustness), any.holds || all.holds};
              }
              return any;
            }};
  }

  std::mt19937_64& random_;
  const std::vector<std::vector<double>>& x_;
};

std::vector<std::vector<double>> RandomPlaces(std::mt19937_64& random) {
  std::vector<std::vector<double>> x(kLastTick + 1, std::vector<double>(kRobots));
  for (std::vector<double>& tick : x) {
    for (double& robot : tick) robot = (static_cast<int>(random() % 41) - 20) / 8.0;
  }
  return x;
}

RecordedRun RunOf(const std::vector<std::vector<double>>& x) {
  return {kRobots, kLastTick, [&](sim::Tick tick, int robot) {
            return sim::Vec2(x[static_cast<std::size_t>(tick)][static_cast<std::size_t>(robot)], 0.0);
          }};
}

// At tick 0 of a trace whose samples are ticks.
Truth TruthOf(const std::string& formula, const RecordedRun& run) {
  std::vector<Node> nodes;
  const std::vector<Sentence> none;
  const auto node = FormulaReader({}, none, nodes).Read(formula);
  if (!node) {
    ADD_FAILURE() << formula << ": " << node.error().message;
    return {};
  }
  return TruthsOf(nodes, std::vector{*node}, run.trace(1), {}, {}).front();
}

TEST(RobustnessTest, EqualsTheDefinitionToTheLastBit) {
  std::mt19937_64 random(61);
  int holding = 0;
  for (int i = 0; i < 10'000; ++i) {
    const auto x = RandomPlaces(random);
    const Reference reference = RandomFormulas(random, x).Draw(3);
    const Answer expected = reference.at(0);
    const Truth truth = TruthOf(reference.text, RunOf(x));
    ASSERT_EQ(truth.robustness, expected.robustness) << reference.text;
    ASSERT_EQ(truth.holds, expected.holds) << reference.text;
    holding += truth.holds ? 1 : 0;
    if (truth.robustness != 0.0) ASSERT_EQ(truth.holds, truth.robustness > 0.0) << reference.text;
  }
  EXPECT_GT(holding, 2000);
  EXPECT_LT(holding, 8000);
}

TEST(RobustnessTest, WhatComesAfterTheDecisionChangesNothing) {
  std::mt19937_64 random(62);
  int early = 0;
  for (int i = 0; i < 3'000; ++i) {
    auto x = RandomPlaces(random);
    const std::string formula = RandomFormulas(random, x).Draw(3).text;
    const Truth truth = TruthOf(formula, RunOf(x));
    if (truth.decided < kLastTick) ++early;
    const auto other = RandomPlaces(random);
    std::copy(other.begin() + truth.decided + 1, other.end(), x.begin() + truth.decided + 1);
    ASSERT_EQ(TruthOf(formula, RunOf(x)).holds, truth.holds) << formula << " decided at " << truth.decided;
  }
  EXPECT_GT(early, 1000);
}

TEST(RobustnessTest, KnownValues) {
  // One robot goes from x = 0 to 1.5 m, 0.1 m in each tick.
  const RecordedRun run(1, 15, [](sim::Tick tick, int) { return sim::Vec2(0.1 * tick, 0.0); });
  const Truth late = TruthOf("eventually[0,1] center_x >= 1.2", run);
  EXPECT_FALSE(late.holds);
  EXPECT_DOUBLE_EQ(late.robustness, -0.2 / 5.9);
  EXPECT_EQ(late.decided, 10);
  const Truth always = TruthOf("always center_x < 0.55", run);
  EXPECT_FALSE(always.holds);
  EXPECT_DOUBLE_EQ(always.robustness, (0.55 - 1.5) / 5.9);
  EXPECT_EQ(always.decided, 6) << "the first time";
  EXPECT_EQ(TruthOf("eventually[0.2,1] center_x >= 0", run).decided, 2);
  const Truth until = TruthOf("center_x < 1 until center_x > 0.75", run);
  EXPECT_TRUE(until.holds);
  EXPECT_EQ(until.decided, 8);
}

TEST(RobustnessTest, WindowsOverNothing) {
  const RecordedRun run(1, 15, [](sim::Tick, int) { return sim::Vec2(0.0, 0.0); });
  EXPECT_EQ(TruthOf("always[2,3] center_x > 1", run), (Truth{1.0, true, 15, -1}));
  EXPECT_EQ(TruthOf("eventually[2,3] center_x < 1", run), (Truth{-1.0, false, 15, -1}));
  EXPECT_EQ(TruthOf("center_x < 1 until[2,3] center_x < 1", run), (Truth{-1.0, false, 15, -1}));
}

TEST(RobustnessTest, IsCutToItsScale) {
  const RecordedRun run(1, 15, [](sim::Tick, int) { return sim::Vec2(0.0, 0.0); });
  EXPECT_EQ(TruthOf("center_x < 1000", run).robustness, 1.0);
  EXPECT_EQ(TruthOf("center_x > 1000", run).robustness, -1.0);
  EXPECT_EQ(TruthOf("2 > 1", run).robustness, 1.0) << "two numbers have no range: 1";
  EXPECT_DOUBLE_EQ(TruthOf("2 * center_x + 1 > 0", run).robustness, 1.0 / 11.8);
  EXPECT_DOUBLE_EQ(TruthOf("-center_x / 2 > -1", run).robustness, 1.0 / 2.95);
  EXPECT_DOUBLE_EQ(TruthOf("abs(center_x - 1) > 0", run).robustness, 1.0 / 3.95);
  EXPECT_DOUBLE_EQ(TruthOf("max(center_x, 0) < 1", run).robustness, 1.0 / 2.95);
  EXPECT_DOUBLE_EQ(TruthOf("min(center_x, 0) > -1", run).robustness, 1.0 / 2.95);
}

TEST(RobustnessTest, WhatWasNotMeasuredSatisfiesNothing) {
  const std::vector<MetricInfo> metrics = {{"reached_time", "s", kNotMeasured, ""}, {"items", "", {}, ""}};
  const RecordedRun run(4, 100, [](sim::Tick, int) { return sim::Vec2(0.0, 0.0); });
  std::vector<Node> nodes;
  const std::vector<Sentence> none;
  std::vector<std::size_t> wanted;
  for (const char* formula : {"reached_time < 5", "reached_time >= 5", "items > 1", "always items > 1"})
    wanted.push_back(FormulaReader(metrics, none, nodes).Read(formula).value());
  const std::vector<std::pair<std::string, double>> values = {{"reached_time", kNotMeasured}, {"items", 3.0}};
  const std::vector<Truth> truths = TruthsOf(nodes, wanted, run.trace(), metrics, values);
  for (const Truth& unmeasured : {truths[0], truths[1]}) {
    EXPECT_EQ(unmeasured.robustness, -1.0);
    EXPECT_FALSE(unmeasured.holds);
  }
  EXPECT_EQ(truths[2].robustness, 0.5) << "of four robots";
  EXPECT_EQ(truths[3].decided, 10) << "only the end tells what a metric is";
}

}  // namespace
}  // namespace gauntlet::controllers::requirements
