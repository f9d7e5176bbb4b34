// What a run must do, in signal temporal logic (Maler and Nickovic 2004, "Monitoring temporal properties of
// continuous signals"): comparisons of measures, and, or, not, implies, always, eventually and until over
// windows of time. Here as data: reading is formula_reader.h's, judging a run robustness.h's.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "sim/geometry/vec2.h"

namespace gauntlet::controllers::requirements {

enum class Operation {
  // Numbers.
  kNumber,
  kMeasure,
  kMetric,
  kAdd,
  kSubtract,
  kMultiply,
  kNegative,
  kSmaller,
  kLarger,
  kAbsolute,
  // Of a number or, kCount, a truth about each robot: a number.
  kCount,
  kLeast,
  kGreatest,
  kMean,
  // Truths. Of two numbers:
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kUnequal,
  // Of truths:
  kNot,
  kAnd,
  kOr,
  kAlways,
  kEventually,
  kUntil,
};

// In s from the moment that is looked at.
struct Window {
  double begin = 0.0;
  double end = std::numeric_limits<double>::infinity();

  bool Unbounded() const { return end == std::numeric_limits<double>::infinity(); }
};

enum class Place { kPoint, kGoal, kStart, kCenter };

// One operation. Those that it works on stand before it.
struct Node {
  Operation operation = Operation::kNumber;
  bool truth = false;
  bool per_robot = false;
  std::size_t left = 0;
  std::size_t right = 0;
  double number = 0.0;                  // kNumber; of a measure of links their range, m
  std::size_t row = 0;                  // kMeasure: in MeasureRows(); kMetric: in the scenario's metrics
  Place place = Place::kPoint;          // that a distance is measured to
  sim::Vec2 point = sim::Vec2::Zero();  // m
  Window window;
  std::string text;  // a comparison as it was written
};

// A named formula: its last node.
struct Sentence {
  std::string name;
  std::string text;
  std::size_t node = 0;
};

}  // namespace gauntlet::controllers::requirements
