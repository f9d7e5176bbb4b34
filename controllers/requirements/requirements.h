// What an experiment requires of its runs: the table [requirements], and what a run reports of it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "controllers/behaviour.h"
#include "controllers/requirements/measures.h"
#include "controllers/requirements/sentences.h"
#include "sim/run_result.h"

namespace gauntlet::controllers::requirements {

inline constexpr std::size_t kMostSentences = 100;
// Entries that are no sentences: what a failure is, and "second" or "tick", how often is looked.
inline constexpr std::string_view kFailure = "failure";
inline constexpr std::string_view kStep = "step";
// Metrics of a run; of a requirement its name stands behind a dot.
inline constexpr std::string_view kRobustness = "robustness";
inline constexpr std::string_view kViolatedAt = "violated_at";

// A run's answer.
struct Judgement {
  bool failed = false;
  std::vector<std::pair<std::string, double>> metrics;  // in the order of Requirements::Metrics
  std::vector<sim::Annotation> annotations;             // what was violated, when, and by which comparison
};

// A name and its formula, or a number, are an entry. Sentences that another sentence uses are parts; the
// others that hold or do not are the requirements.
class Requirements {
 public:
  // `metrics`: the scenario's.
  explicit Requirements(std::vector<MetricInfo> metrics) : metrics_(std::move(metrics)) {}

  // Of "NAME = FORMULA\n" lines (sim::RunSettings::requirements). Error: the entry, and what is wrong.
  static Result<Requirements> Parse(std::string_view text, std::vector<MetricInfo> metrics);
  // kStep comes first, kFailure last. Errors likewise.
  Status Add(const std::string& name, const std::string& formula);
  // Error: there is nothing that a run could violate.
  Status Check() const;

  // What a run reports beside the scenario's metrics: robustness, below 0 exactly when it failed but for
  // ties at 0, and of each requirement that and the time, s, from which on it was violated for good.
  std::vector<MetricInfo> Metrics() const;
  bool AsksFor(Place place) const;
  bool Measures() const;
  // Windows that reach beyond a run that lasts `longest` s, each with what then holds.
  std::vector<std::string> BeyondTheRun(double longest) const;

  // `values`: the run's of the scenario's metrics.
  Judgement Judge(Trace trace, std::span<const std::pair<std::string, double>> values) const;

 private:
  std::vector<const Sentence*> Required() const;

  std::vector<MetricInfo> metrics_;
  std::vector<Node> nodes_;
  std::vector<Sentence> sentences_;
  std::vector<Sentence> failure_;   // one, or none
  std::size_t failure_begins_ = 0;  // at this node
  sim::Tick step_ = sim::kTicksPerSecond;
};

// The entries in such a text, in their order.
std::vector<std::pair<std::string, std::string>> EntriesOf(std::string_view text);

}  // namespace gauntlet::controllers::requirements
