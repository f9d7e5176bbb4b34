#include "controllers/requirements/requirements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "base/nearest_name.h"
#include "base/number_text.h"
#include "controllers/requirements/formula_reader.h"
#include "controllers/requirements/robustness.h"

namespace gauntlet::controllers::requirements {
namespace {

bool IsName(std::string_view name) {
  const auto good = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name[0] >= 'a' && std::ranges::all_of(name, good) && name.size() <= 40;
}

bool IsWord(std::string_view name) {
  constexpr std::array<std::string_view, 17> kWords = {
      "always", "eventually", "until", "and",      "or",   "not",  "implies", "min",   "max",
      "abs",    "count",      "least", "greatest", "mean", "goal", "start",   "center"};
  return std::ranges::count(kWords, name) > 0;
}

bool HasWindow(const Node& node) {
  return node.operation == Operation::kAlways || node.operation == Operation::kEventually ||
         node.operation == Operation::kUntil;
}

std::string TextOf(const Window& window) {
  return fmt::format("[{},{}]", NumberText(window.begin), NumberText(window.end));
}

std::string MetricName(std::string_view metric, const std::string& name) {
  return fmt::format("{}.{}", metric, name);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> EntriesOf(std::string_view text) {
  std::vector<std::pair<std::string, std::string>> entries;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t equals = std::min(line.find(" = "), line.size());
    entries.emplace_back(line.substr(0, equals), line.substr(std::min(equals + 3, line.size())));
  }
  return entries;
}

Result<Requirements> Requirements::Parse(std::string_view text, std::vector<MetricInfo> metrics) {
  Requirements requirements(std::move(metrics));
  for (const auto& [name, formula] : EntriesOf(text)) {
    TRY(requirements.Add(name, formula));
  }
  TRY(requirements.Check());
  return requirements;
}

Status Requirements::Add(const std::string& name, const std::string& formula) {
  const auto wrong = [&](const std::string& why) {
    constexpr std::size_t kShown = 200;
    return InvalidInput(fmt::format("requirements.{} = \"{}{}\": {}", name, formula.substr(0, kShown),
                                    formula.size() > kShown ? "..." : "", why));
  };
  if (name == kStep) {
    if (formula != "second" && formula != "tick") return wrong("give second or tick");
    step_ = formula == "tick" ? 1 : sim::kTicksPerSecond;
    return Ok{};
  }
  if (!IsName(name) || IsWord(name))
    return wrong("a name is of up to 40 small letters, digits and _, and no word of the language");
  for (const MeasureRow& row : MeasureRows()) {
    if (row.name == name) return wrong("this is the name of a measure");
  }
  if (sentences_.size() >= kMostSentences)
    return wrong(fmt::format("there may be {} sentences", kMostSentences));
  const std::size_t first = nodes_.size();
  const Result<std::size_t> node = FormulaReader(metrics_, sentences_, nodes_).Read(formula);
  if (!node) return wrong(node.error().message);
  for (const Node& one : std::span(nodes_).subspan(first)) {
    if (const SampleWindow samples = SamplesIn(one.window, step_);
        HasWindow(one) && samples.last < samples.first)
      return wrong(fmt::format("no whole {} lies in the window {}", step_ == 1 ? "tick" : "second",
                               TextOf(one.window)));
    if (one.operation == Operation::kMeasure && step_ == 1 && MeasureRows()[one.row].each_second_only)
      return wrong(fmt::format("'{}' is measured each second; with step = \"tick\" give measures of places",
                               MeasureRows()[one.row].name));
  }
  const Sentence sentence{name, formula, *node};
  if (name != kFailure) {
    sentences_.push_back(sentence);
    return Ok{};
  }
  if (!nodes_[*node].truth) return wrong("a failure is something that holds or does not: compare it");
  failure_ = {sentence};
  failure_begins_ = first;
  return Ok{};
}

std::vector<const Sentence*> Requirements::Required() const {
  std::set<std::size_t> used;
  // A node that works on nothing names the first one, which is no truth.
  const std::size_t end = failure_.empty() ? nodes_.size() : failure_begins_;
  for (const Node& node : std::span(nodes_).first(end)) used.insert({node.left, node.right});
  std::vector<const Sentence*> required;
  for (const Sentence& sentence : sentences_) {
    if (nodes_[sentence.node].truth && !used.contains(sentence.node)) required.push_back(&sentence);
  }
  return required;
}

Status Requirements::Check() const {
  if (!failure_.empty() || !Required().empty()) return Ok{};
  return InvalidInput(
      "[requirements] has no sentence that could be violated: stay = \"always count(distance_to(goal) < 1) "
      ">= 8\"");
}

std::vector<MetricInfo> Requirements::Metrics() const {
  std::vector<MetricInfo> all = {
      {std::string(kRobustness), "", {}, "how far the run was from failing, -1 to 1; below 0 it failed"}};
  const std::vector<const Sentence*> required = Required();
  for (const Sentence* sentence : required)
    all.push_back({MetricName(kRobustness, sentence->name), "", {}, "of the requirement: " + sentence->text});
  for (const Sentence* sentence : required)
    all.push_back({MetricName(kViolatedAt, sentence->name), "s", kNotMeasured,
                   "when it was violated for good: " + sentence->text});
  return all;
}

bool Requirements::AsksFor(Place place) const {
  return std::ranges::any_of(nodes_, [&](const Node& node) {
    return node.operation == Operation::kMeasure && MeasureRows()[node.row].argument == Argument::kPlace &&
           node.place == place;
  });
}

bool Requirements::Measures() const {
  return std::ranges::count(nodes_, Operation::kMeasure, &Node::operation) > 0;
}

std::vector<std::string> Requirements::BeyondTheRun(double longest) const {
  std::vector<std::string> told;
  for (const Node& node : nodes_) {
    if (!HasWindow(node) || node.window.Unbounded() || node.window.end <= longest) continue;
    const bool always = node.operation == Operation::kAlways;
    told.push_back(fmt::format(
        "the window {} reaches beyond a run, which lasts {} s at the longest: it is cut there, and over "
        "nothing '{}' {}",
        TextOf(node.window), NumberText(longest),
        always                                ? "always"
        : node.operation == Operation::kUntil ? "until"
                                              : "eventually",
        always ? "holds" : "does not hold"));
  }
  return told;
}

Judgement Requirements::Judge(Trace trace, std::span<const std::pair<std::string, double>> values) const {
  trace.step = step_;
  const std::vector<const Sentence*> required = Required();
  std::vector<std::size_t> wanted;
  for (const Sentence* sentence : required) wanted.push_back(sentence->node);
  if (!failure_.empty()) wanted.push_back(failure_.front().node);
  const std::vector<Truth> truths = TruthsOf(nodes_, wanted, trace, metrics_, values);

  const std::span<const Truth> of_required = std::span(truths).first(required.size());
  Truth whole;
  if (!failure_.empty()) {
    whole = Not(truths.back());
  } else {
    whole = of_required.front();
    for (const Truth& truth : of_required.subspan(1)) whole = And(whole, truth);
  }
  Judgement judgement{.failed = !whole.holds, .metrics = {{std::string(kRobustness), whole.robustness}}};
  for (std::size_t i = 0; i < required.size(); ++i)
    judgement.metrics.emplace_back(MetricName(kRobustness, required[i]->name), of_required[i].robustness);
  for (std::size_t i = 0; i < required.size(); ++i) {
    const Truth& truth = of_required[i];
    const sim::Tick tick = truth.decided * step_;
    judgement.metrics.emplace_back(MetricName(kViolatedAt, required[i]->name),
                                   truth.holds ? kNotMeasured : tick * sim::kTickSeconds);
    if (truth.holds) continue;
    std::string label = required[i]->name;
    if (truth.reason >= 0) label += ": " + nodes_[static_cast<std::size_t>(truth.reason)].text;
    judgement.annotations.push_back({.kind = "violated", .label = label, .tick = tick});
  }
  return judgement;
}

}  // namespace gauntlet::controllers::requirements
