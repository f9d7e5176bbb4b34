#include "controllers/requirements/robustness.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gauntlet::controllers::requirements {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool IsSmallerRobustness(const Truth& a, const Truth& b) {
  return a.robustness < b.robustness;
}
bool IsLargerRobustness(const Truth& a, const Truth& b) {
  return a.robustness > b.robustness;
}
// Whether `a` rather than `b` decides that all hold: the first that does not, else the last.
bool DecidesAll(const Truth& a, const Truth& b) {
  if (a.holds != b.holds) return !a.holds;
  return a.holds ? a.decided > b.decided : a.decided < b.decided;
}
// Likewise, that one of them holds.
bool DecidesOne(const Truth& a, const Truth& b) {
  if (a.holds != b.holds) return a.holds;
  return a.holds ? a.decided < b.decided : a.decided > b.decided;
}

// For each sample the first of the best ones in its window. A window of nothing gives signal.size().
template <typename Better>
std::vector<std::size_t> BestIn(std::span<const Truth> signal, const SampleWindow& window, Better better) {
  std::vector<std::size_t> best(signal.size(), signal.size());
  // From the best, at `oldest`, to the newest.
  std::vector<std::size_t> candidates;
  candidates.reserve(signal.size());
  std::size_t oldest = 0;
  for (std::size_t sample = signal.size(); sample-- > 0;) {
    if (window.first < signal.size() - sample) {
      const std::size_t next = sample + window.first;
      while (candidates.size() > oldest && !better(signal[candidates.back()], signal[next]))
        candidates.pop_back();
      candidates.push_back(next);
    }
    while (candidates.size() > oldest && candidates[oldest] - sample > window.last) ++oldest;
    if (candidates.size() > oldest) best[sample] = candidates[oldest];
  }
  return best;
}

std::vector<Truth> OverWindow(std::span<const Truth> signal, const SampleWindow& window, bool all) {
  const auto last = static_cast<std::int32_t>(signal.size()) - 1;
  const std::vector<std::size_t> extreme =
      BestIn(signal, window, all ? IsSmallerRobustness : IsLargerRobustness);
  const std::vector<std::size_t> decides = BestIn(signal, window, all ? DecidesAll : DecidesOne);
  std::vector<Truth> truths(signal.size(), {all ? 1.0 : -1.0, all, last, -1});
  for (std::size_t sample = 0; sample < signal.size(); ++sample) {
    if (extreme[sample] == signal.size()) continue;
    const Truth& of = signal[extreme[sample]];
    const Truth& decider = signal[decides[sample]];
    truths[sample] = {of.robustness, decider.holds, decider.decided, of.reason};
  }
  return truths;
}

Range Times(const Range& a, const Range& b) {
  const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}

Range RangeOfNumbers(Operation operation, const Range& a, const Range& b) {
  switch (operation) {
    case Operation::kAdd:
      return {a.low + b.low, a.high + b.high};
    case Operation::kSubtract:
      return {a.low - b.high, a.high - b.low};
    case Operation::kMultiply:
      return Times(a, b);
    case Operation::kNegative:
      return {-a.high, -a.low};
    case Operation::kSmaller:
      return {std::min(a.low, b.low), std::min(a.high, b.high)};
    case Operation::kLarger:
      return {std::max(a.low, b.low), std::max(a.high, b.high)};
    case Operation::kAbsolute:
      return {a.low <= 0.0 && a.high >= 0.0 ? 0.0 : std::min(std::abs(a.low), std::abs(a.high)),
              std::max(std::abs(a.low), std::abs(a.high))};
    default:
      return a;
  }
}

double NumberOf(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kNegative:
      return 0.0 - a;
    case Operation::kAbsolute:
      return std::abs(a);
    // What was not measured stays so.
    case Operation::kSmaller:
      return std::isnan(a) || a < b ? a : b;
    default:
      return std::isnan(a) || a > b ? a : b;
  }
}

// Of finite numbers; `difference` is a - b.
bool Compares(Operation operation, double difference) {
  switch (operation) {
    case Operation::kLess:
      return difference < 0.0;
    case Operation::kLessEqual:
      return difference <= 0.0;
    case Operation::kGreater:
      return difference > 0.0;
    case Operation::kGreaterEqual:
      return difference >= 0.0;
    case Operation::kEqual:
      return difference == 0.0;
    default:
      return difference != 0.0;
  }
}

double Distance(Operation operation, double difference) {
  switch (operation) {
    case Operation::kLess:
    case Operation::kLessEqual:
      return 0.0 - difference;
    case Operation::kGreater:
    case Operation::kGreaterEqual:
      return difference;
    case Operation::kEqual:
      return 0.0 - std::abs(difference);
    default:
      return std::abs(difference);
  }
}

// A node's values: numbers, for truths about each robot 0 and 1; or truths, one for each sample.
struct Signal {
  std::vector<double> numbers;  // one, one for each sample, or one for each robot of each sample
  std::vector<Truth> truths;
  Range range;
  bool known_at_end = false;  // not before
};

class Evaluation {
 public:
  Evaluation(std::span<const Node> nodes, const Trace& trace, std::span<const MetricInfo> metrics,
             std::span<const std::pair<std::string, double>> values)
      : nodes_(nodes), trace_(trace), metrics_(metrics), values_(values), samples_(trace.samples()) {
    signals_.reserve(nodes.size());
    for (std::size_t node = 0; node < nodes.size(); ++node) signals_.push_back(SignalOf(node));
  }

  const Truth& AtTheBeginning(std::size_t node) const { return signals_[node].truths.front(); }

 private:
  const Signal& Left(const Node& node) const { return signals_[node.left]; }
  const Signal& Right(const Node& node) const { return signals_[node.right]; }
  std::size_t SizeOf(const Node& node) const {
    return node.per_robot ? samples_ * trace_.robots.size() : samples_;
  }
  // `numbers` at a place of a signal of this size.
  static double At(const std::vector<double>& numbers, std::size_t place, std::size_t size) {
    return numbers.size() == size ? numbers[place] : numbers[place / (size / numbers.size())];
  }

  template <typename Of>
  std::vector<double> Elementwise(const Node& node, const Of& of) const {
    const std::vector<double>& left = Left(node).numbers;
    const std::vector<double>& right = Right(node).numbers;
    const std::size_t size = std::max(left.size(), right.size());
    std::vector<double> numbers(size);
    for (std::size_t i = 0; i < size; ++i) numbers[i] = of(At(left, i, size), At(right, i, size));
    return numbers;
  }

  Signal SignalOf(std::size_t index) const {
    const Node& node = nodes_[index];
    switch (node.operation) {
      case Operation::kNumber:
        return {{node.number}, {}, {node.number, node.number}, false};
      case Operation::kMeasure: {
        const MeasureRow& row = MeasureRows()[node.row];
        return {row.measure(trace_, node), {}, row.range_of(trace_), false};
      }
      case Operation::kMetric:
        return Metric(metrics_[node.row]);
      case Operation::kCount:
      case Operation::kLeast:
      case Operation::kGreatest:
      case Operation::kMean:
        return OverRobots(node);
      default:
        break;
    }
    if (!node.truth) {
      const auto of = [&](double a, double b) { return NumberOf(node.operation, a, b); };
      return {Elementwise(node, of),
              {},
              RangeOfNumbers(node.operation, Left(node).range, Right(node).range),
              Left(node).known_at_end || Right(node).known_at_end};
    }
    return node.per_robot ? TruthOfRobots(node) : TruthOf(index);
  }

  Signal Metric(const MetricInfo& info) const {
    const std::optional<double> value = ReportedValue(values_, info.name);
    const bool measured = value && std::isfinite(*value) && value != info.none;
    return {{measured ? *value : kNone}, {}, RangeOf(info, trace_), true};
  }

  Signal OverRobots(const Node& node) const {
    const Signal& of = Left(node);
    const std::size_t robots = trace_.robots.size();
    Signal signal{.range = of.range, .known_at_end = of.known_at_end};
    if (node.operation == Operation::kCount) signal.range = {0.0, static_cast<double>(robots)};
    for (std::size_t sample = 0; sample < samples_; ++sample) {
      const auto values = std::span(of.numbers).subspan(sample * robots, robots);
      double value = values[0];
      for (const double next : values.subspan(1)) {
        const bool sums = node.operation == Operation::kCount || node.operation == Operation::kMean;
        value = sums
                    ? value + next
                    : NumberOf(node.operation == Operation::kLeast ? Operation::kSmaller : Operation::kLarger,
                               value, next);
      }
      if (node.operation == Operation::kMean) value /= static_cast<double>(robots);
      signal.numbers.push_back(value);
    }
    return signal;
  }

  // 1 where it holds, else 0.
  Signal TruthOfRobots(const Node& node) const {
    const auto of = [&](double a, double b) {
      switch (node.operation) {
        case Operation::kNot:
          return 1.0 - a;
        case Operation::kAnd:
          return std::min(a, b);
        case Operation::kOr:
          return std::max(a, b);
        default:
          return std::isfinite(a - b) && Compares(node.operation, a - b) ? 1.0 : 0.0;
      }
    };
    return {Elementwise(node, of), {}, {0.0, 1.0}, Left(node).known_at_end || Right(node).known_at_end};
  }

  Signal TruthOf(std::size_t index) const {
    const Node& node = nodes_[index];
    Signal signal;
    const std::vector<Truth>& left = Left(node).truths;
    const std::vector<Truth>& right = Right(node).truths;
    switch (node.operation) {
      case Operation::kAlways:
        signal.truths = Always(left, SamplesIn(node.window, trace_.step));
        return signal;
      case Operation::kEventually:
        signal.truths = Eventually(left, SamplesIn(node.window, trace_.step));
        return signal;
      case Operation::kUntil:
        signal.truths = Until(left, right, SamplesIn(node.window, trace_.step));
        return signal;
      case Operation::kNot:
      case Operation::kAnd:
      case Operation::kOr:
        signal.truths.reserve(samples_);
        for (std::size_t i = 0; i < samples_; ++i) {
          signal.truths.push_back(node.operation == Operation::kNot   ? Not(left[i])
                                  : node.operation == Operation::kAnd ? And(left[i], right[i])
                                                                      : Or(left[i], right[i]));
        }
        return signal;
      default:
        signal.truths = Comparison(index);
        return signal;
    }
  }

  std::vector<Truth> Comparison(std::size_t index) const {
    const Node& node = nodes_[index];
    const Range range = RangeOfNumbers(Operation::kSubtract, Left(node).range, Right(node).range);
    const double width = range.high > range.low ? range.high - range.low : 1.0;
    const bool at_end = Left(node).known_at_end || Right(node).known_at_end;
    std::vector<Truth> truths(samples_);
    for (std::size_t i = 0; i < samples_; ++i) {
      const double difference = At(Left(node).numbers, i, samples_) - At(Right(node).numbers, i, samples_);
      Truth& truth = truths[i];
      truth.decided = static_cast<std::int32_t>(at_end ? samples_ - 1 : i);
      truth.reason = static_cast<std::int32_t>(index);
      truth.robustness = -1.0;
      if (!std::isfinite(difference)) continue;
      truth.holds = Compares(node.operation, difference);
      truth.robustness = std::clamp(Distance(node.operation, difference) / width, -1.0, 1.0);
    }
    return truths;
  }

  std::span<const Node> nodes_;
  const Trace& trace_;
  std::span<const MetricInfo> metrics_;
  std::span<const std::pair<std::string, double>> values_;
  std::size_t samples_ = 0;
  std::vector<Signal> signals_;
};

}  // namespace

Truth Not(const Truth& of) {
  return {0.0 - of.robustness, !of.holds, of.decided, of.reason};
}

Truth And(const Truth& left, const Truth& right) {
  const Truth& of = IsSmallerRobustness(right, left) ? right : left;
  const Truth& decider = DecidesAll(right, left) ? right : left;
  return {of.robustness, decider.holds, decider.decided, of.reason};
}

Truth Or(const Truth& left, const Truth& right) {
  const Truth& of = IsLargerRobustness(right, left) ? right : left;
  const Truth& decider = DecidesOne(right, left) ? right : left;
  return {of.robustness, decider.holds, decider.decided, of.reason};
}

SampleWindow SamplesIn(const Window& window, sim::Tick step) {
  // Seconds with decimals are whole ticks, but for rounding.
  constexpr double kRounding = 1e-6;
  const double seconds = step * sim::kTickSeconds;
  SampleWindow samples;
  samples.first = static_cast<std::size_t>(std::ceil(window.begin / seconds - kRounding));
  samples.last = window.Unbounded() ? std::numeric_limits<std::size_t>::max()
                                    : static_cast<std::size_t>(std::floor(window.end / seconds + kRounding));
  return samples;
}

std::vector<Truth> Always(std::span<const Truth> signal, const SampleWindow& window) {
  return OverWindow(signal, window, /*all=*/true);
}

std::vector<Truth> Eventually(std::span<const Truth> signal, const SampleWindow& window) {
  return OverWindow(signal, window, /*all=*/false);
}

std::vector<Truth> Until(std::span<const Truth> meanwhile, std::span<const Truth> goal,
                         const SampleWindow& window) {
  const auto last = static_cast<std::int32_t>(goal.size()) - 1;
  std::vector<Truth> truths(goal.size(), {-1.0, false, last, -1});
  const bool whole = window.first == 0 && window.last >= goal.size();
  for (std::size_t sample = goal.size(); sample-- > 0;) {
    if (whole) {
      truths[sample] = goal[sample];
      if (sample + 1 < goal.size())
        truths[sample] = Or(goal[sample], And(meanwhile[sample], truths[sample + 1]));
      continue;
    }
    std::optional<Truth> so_far;
    std::optional<Truth> found;
    for (std::size_t at = sample; at < goal.size() && at - sample <= window.last; ++at) {
      if (at - sample >= window.first) {
        const Truth here = so_far ? And(*so_far, goal[at]) : goal[at];
        found = found ? Or(*found, here) : here;
      }
      so_far = so_far ? And(*so_far, meanwhile[at]) : meanwhile[at];
    }
    if (found) truths[sample] = *found;
  }
  return truths;
}

std::vector<Truth> TruthsOf(std::span<const Node> nodes, std::span<const std::size_t> wanted,
                            const Trace& trace, std::span<const MetricInfo> metrics,
                            std::span<const std::pair<std::string, double>> values) {
  const Evaluation evaluation(nodes, trace, metrics, values);
  std::vector<Truth> truths;
  for (const std::size_t node : wanted) truths.push_back(evaluation.AtTheBeginning(node));
  return truths;
}

}  // namespace gauntlet::controllers::requirements
