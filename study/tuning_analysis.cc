#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "base/number_text.h"
#include "study/study_report.h"
#include "study/study_tables.h"

namespace gauntlet {
namespace {

constexpr double kHolmLevel = 0.05;           // over all values together (Holm)
constexpr std::size_t kSets = 20;             // of each size (Spartan's manual)
constexpr std::size_t kFewestEvolutions = 5;  // from which sets are drawn

// What came of a part: one value for each evolution.
struct Evolutions {
  std::vector<double> values;
  std::uint64_t simulations = 0;  // of one of them
};

Result<Evolutions> EvolutionsOf(StudyRuns& runs, const std::string& part, StudySection& section) {
  TRY(const auto set, runs.Set(AgainPart(part), "fitness"));
  section.sentences.insert(section.sentences.end(), set.notes.begin(), set.notes.end());
  TRY(const auto cost, runs.CostOf(part));
  Evolutions evolutions;
  evolutions.simulations = cost.runs / std::max<std::uint64_t>(cost.searches, 1);
  for (const std::vector<double>& population : set.values.clusters) {
    const double sum = std::accumulate(population.begin(), population.end(), 0.0);
    evolutions.values.push_back(sum / static_cast<double>(population.size()));
  }
  if (evolutions.values.empty()) return InvalidInput(part + ": no evolution gave a result");
  return evolutions;
}

TriedValue Describe(const std::string& value, const Evolutions& evolutions) {
  TriedValue tried;
  tried.value = value;
  tried.evolutions = evolutions.values.size();
  tried.simulations = evolutions.simulations;
  const analysis::Description description = analysis::Describe(evolutions.values);
  tried.mean = description.mean;
  tried.median = description.median;
  return tried;
}

void AddConsistency(const std::vector<double>& baseline, const Tuning& tuning, TuningResult& result) {
  const std::vector<std::size_t>& sizes = tuning.sizes;
  if (baseline.size() < kFewestEvolutions) {
    result.enough_in_words = fmt::format(
        "Consistency analysis needs at least {} evolutions of the baseline; "
        "there are {}.",
        kFewestEvolutions, baseline.size());
    return;
  }
  for (const std::size_t size : sizes) {
    result.consistency.push_back(
        analysis::AnalyseConsistency(analysis::DrawSets(baseline, size, kSets, size)));
  }
  result.enough = analysis::EnoughRepeats(result.consistency);
  const std::string drawn = fmt::format(
      "({} sets of each size, drawn with replacement from the {} "
      "evolutions of the baseline)",
      kSets, baseline.size());
  result.enough_in_words =
      result.enough
          ? fmt::format(
                "Enough repeats: {}. From there on no two sets of evolutions with the same "
                "parameters differ by a large A {}.",
                *result.enough, drawn)
          : fmt::format(
                "More than {} repeats are needed: even of that size, sets of evolutions with the same "
                "parameters differ by a large A {}.",
                sizes.back(), drawn);
}

std::string AText(const TriedValue& value) {
  return fmt::format(
      "{} (A {:.2f}{})", value.value, value.a,
      value.interval ? fmt::format(", {:.2f} to {:.2f}", value.interval->low, value.interval->high) : "");
}

std::string Join(const std::vector<const TriedValue*>& values) {
  std::string text;
  for (const TriedValue* value : values) text += (text.empty() ? "" : ", ") + AText(*value);
  return text;
}

// Of values that are no worse by a large A than the one that is recommended, the one that costs least.
std::string CheaperValue(const TriedParameter& parameter) {
  const auto kept = std::ranges::find(parameter.values, parameter.recommended, &TriedValue::value);
  const TriedValue* cheapest = &*kept;
  for (const TriedValue& value : parameter.values) {
    const bool worse = value.exceeds && value.a < 0.5;
    if (!worse && value.simulations < cheapest->simulations) cheapest = &value;
  }
  if (cheapest == &*kept || !kept->is_baseline) return "";
  return fmt::format(" {} costs {} simulations instead of {} and is not worse by a large A.",
                     AText(*cheapest), FormatCount(cheapest->simulations), FormatCount(kept->simulations));
}

// The toughest value that differs from the baseline by a large A beyond chance; else the baseline's.
void Recommend(TriedParameter& parameter) {
  const TriedValue* best = nullptr;
  std::vector<const TriedValue*> tougher;
  std::vector<const TriedValue*> easier;
  std::vector<const TriedValue*> uncertain;
  for (const TriedValue& value : parameter.values) {
    if (value.is_baseline || !value.exceeds) continue;
    if (value.p_holm >= kHolmLevel) {
      uncertain.push_back(&value);
      continue;
    }
    (value.a > 0.5 ? tougher : easier).push_back(&value);
    if (value.a > 0.5 && (best == nullptr || value.a > best->a)) best = &value;
  }
  parameter.recommended = best != nullptr ? best->value : parameter.baseline;
  std::string& words = parameter.evidence;
  if (best != nullptr) {
    words = fmt::format(
        "{} instead of {}: its cases are tougher by a large A beyond chance: {}, p {:.2g} "
        "after Holm's correction.",
        best->value, parameter.baseline, AText(*best), best->p_holm);
    if (tougher.size() > 1) words += fmt::format(" So are those of {}.", Join(tougher));
  } else if (easier.empty() && uncertain.empty()) {
    words = fmt::format("{} stays: no other value differs from it by a large A.", parameter.baseline);
  } else {
    words =
        fmt::format("{} stays: no other value is tougher by a large A beyond chance.", parameter.baseline);
  }
  if (!easier.empty()) words += fmt::format(" Easier beyond chance: {}.", Join(easier));
  if (!uncertain.empty()) {
    words += fmt::format(
        " A is large, but may be a matter of chance with so few repeats (p at least {:.2g} "
        "after Holm's correction): {}.",
        std::ranges::min(uncertain, {}, &TriedValue::p_holm)->p_holm, Join(uncertain));
  }
  words += CheaperValue(parameter);
}

void AddTables(const Tuning& tuning, const TuningResult& result, StudySection& section) {
  for (const TriedParameter& parameter : result.parameters) section.tables.push_back(ValueTable(parameter));
  if (!result.consistency.empty()) section.tables.push_back(ConsistencyTable(result));
  Table recommended({"parameter", "baseline", "recommended"});
  std::string changes;
  for (const TriedParameter& one : result.parameters) {
    recommended.AddRow({one.key, one.baseline, one.recommended});
    if (one.recommended != one.baseline) changes += fmt::format(" --set {}={}", one.key, one.recommended);
  }
  section.tables.push_back(std::move(recommended));
  section.sentences.push_back(fmt::format(
      "An evolution counts once: by the mean fitness of its final population, simulated again with fresh "
      "seeds. "
      "A is the probability that an evolution of the baseline ends with a higher fitness than one with the "
      "changed value: above 0.5 the value finds tougher cases. A exceeds what Spartan takes for the same "
      "behaviour "
      "from 0.71 on, and from 0.29 downwards. {} evolutions of each value; p by Mann and Whitney's test "
      "({}).",
      tuning.repeats, result.p_by));
  if (tuning.budget > 0) {
    section.sentences.push_back(fmt::format("Each evolution has as many generations as {} runs pay for.",
                                            FormatCount(tuning.budget)));
  }
  for (const TriedParameter& one : result.parameters)
    section.sentences.push_back(fmt::format("{}: {}", one.key, one.evidence));
  section.sentences.push_back(result.enough_in_words);
  section.sentences.push_back(
      changes.empty()
          ? "Recommended: the baseline as it is."
          : fmt::format("Recommended:{}. Each was changed alone: their combination was not tried.", changes));
}

}  // namespace

Result<StudySection> AnalyseTuning(const StudyAnalysis& analysis, StudyRuns& runs, StudyFigures& figures) {
  const Tuning& tuning = *analysis.tuning;
  StudySection section;
  section.name = analysis.name;
  section.title = tuning.title;
  TRY(const auto baseline, EvolutionsOf(runs, tuning.baseline_part, section));
  TuningResult& result = section.tuning.emplace();
  std::vector<std::vector<double>> changed;
  for (const TunedParameter& parameter : tuning.parameters) {
    TriedParameter& tried = result.parameters.emplace_back();
    tried.key = parameter.key;
    tried.baseline = parameter.baseline;
    for (const TunedValue& value : parameter.values) {
      if (value.part == tuning.baseline_part) {
        tried.values.push_back(Describe(value.value, baseline));
        tried.values.back().is_baseline = true;
        continue;
      }
      TRY(const auto evolutions, EvolutionsOf(runs, value.part, section));
      tried.values.push_back(Describe(value.value, evolutions));
      changed.push_back(evolutions.values);
    }
  }
  TRY(const auto robustness, analysis::AnalyseRobustness(baseline.values, changed));
  auto next = robustness.begin();
  for (TriedParameter& parameter : result.parameters) {
    for (TriedValue& value : parameter.values) {
      if (value.is_baseline) continue;
      const analysis::Comparison& comparison = next->comparison;
      value.a = comparison.test.a;
      value.interval = comparison.interval;
      value.effect = comparison.effect;
      value.exceeds = next->exceeds;
      value.p = comparison.p.value();
      value.p_holm = next->p_holm;
      result.p_by = comparison.p_by;
      ++next;
    }
    Recommend(parameter);
    figures[fmt::format("{}.{}", analysis.name, parameter.key)] = parameter.recommended;
  }
  AddConsistency(baseline.values, tuning, result);
  figures[analysis.name + ".enough"] = result.enough ? WholeCell(*result.enough) : "not known";
  AddTables(tuning, result, section);
  return section;
}

}  // namespace gauntlet
