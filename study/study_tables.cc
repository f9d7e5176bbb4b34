#include "study/study_tables.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/duration_text.h"
#include "base/number_text.h"

namespace gauntlet {
namespace {

// What a published figure says, by the rule that judges it: the mean or the standard deviation of a set, or
// the size of a comparison's effect. The same for a set that is printed in several tables, and for the rank
// sums, mean ranks, U and A of a comparison, which follow from each other. "" of any other figure.
std::string QuantityOf(const StudySection& section, const PublishedRow& row) {
  const std::string rule = row.rule.substr(0, row.rule.find(' '));
  if (rule == "effect") return section.name;
  if ((rule != "mean" && rule != "sd") || !section.compared) return "";
  const bool first = row.figure.find(".first.") != std::string::npos;
  return rule + " of " + section.compared->sets[first ? 0 : 1].name;
}

}  // namespace

std::string TallyInWords(const StudyReport& report) {
  std::map<std::string, int> tally;
  int all = 0;
  const auto count = [&](const std::vector<JudgedRow>& rows) {
    for (const JudgedRow& row : rows) ++tally[row.verdict];
    all += static_cast<int>(rows.size());
  };
  for (const StudySection& section : report.sections) count(section.published);
  count(report.elsewhere);
  if (all == 0) return "";
  std::string words = fmt::format(
      "Of {} published figures {} agree with ours, {} differ, {} stand beside ours without being judged, and "
      "{} have no counterpart here.",
      all, tally["agrees"], tally["differs"], tally["not judged"], tally["not computed"]);
  std::map<std::string, bool> quantities;  // whether they agree, where they are printed first
  for (const StudySection& section : report.sections) {
    for (const JudgedRow& row : section.published) {
      if (const std::string quantity = QuantityOf(section, row.row); !quantity.empty())
        quantities.emplace(quantity, row.verdict == "agrees");
    }
  }
  if (quantities.empty()) return words;
  const auto agree = std::ranges::count(quantities, true, [](const auto& one) { return one.second; });
  return words + fmt::format(
                     " Many of them say the same: of {} means, standard deviations and effect sizes, each "
                     "counted once, {} agree.",
                     quantities.size(), agree);
}

std::string TimeInWords(const StudyReport& report) {
  const auto words = [](const ClockTime& time) {
    return (time.at_least ? "at least " : "") + FormatDuration(time.seconds);
  };
  const bool killed = report.searching.at_least || report.evaluating.at_least;
  return fmt::format(
      "By the clock the searches took {}, the re-simulations {}{}. All parts share the workers.",
      words(report.searching), words(report.evaluating),
      killed ? " (a master was killed; how long it had lived is not known)" : "");
}

Table ClaimTable(const StudyReport& report, bool with_figures) {
  std::vector<Column> columns = {ForPrograms("analysis"), {"claim", "claim"}, {"verdict", "holds"}};
  if (with_figures) columns.emplace_back("figures");
  Table table(columns);
  for (const StudySection& section : report.sections) {
    if (!section.claim) continue;
    const auto& [claim, holds] = *section.claim;
    std::vector<Cell> row = {section.name, claim, {holds ? "holds" : "DOES NOT HOLD", holds}};
    if (with_figures && !section.sentences.empty()) row.emplace_back(section.sentences.front());
    table.AddRow(std::move(row));
  }
  return table;
}

Table PartTable(const StudyReport& report, bool with_all) {
  Table table({{"part", "part"},
               {">searches", "searches"},
               {">runs", "runs"},
               {">distinct cases", "distinct_cases"},
               {">CPU time of its runs", "cpu_seconds"}});
  PartCost all{"all"};
  const auto add = [&](const PartCost& part) {
    table.AddRow({part.part, CountCell(part.searches), CountCell(part.runs), CountCell(part.distinct_cases),
                  Cell(FormatDuration(part.cpu_seconds), part.cpu_seconds)});
  };
  for (const PartCost& part : report.parts) {
    add(part);
    all += part;
  }
  if (with_all && report.parts.size() > 1) add(all);
  return table;
}

Table ValueTable(const TriedParameter& parameter) {
  Table table({{parameter.key, "value"},
               ForPrograms("baseline"),
               {">simulations each", "simulations"},
               {">evolutions", "evolutions"},
               {">median", "median"},
               {">mean", "mean"},
               {">A", "a?"},
               {">95 % interval", "a_interval?"},
               {"difference"},
               ForPrograms("effect?"),
               {"exceeds", "exceeds?"},
               ForPrograms("p_two_sided?"),
               {">p (Holm)", "p_holm?"}});
  const Cell none = TextCell("");
  for (const TriedValue& value : parameter.values) {
    std::vector<Cell> row = {value.value,      value.is_baseline,         CountCell(value.simulations),
                             value.evolutions, FitnessCell(value.median), FitnessCell(value.mean)};
    if (value.is_baseline) {
      row.insert(row.end(), {none, none, "baseline", none, none, none, none});
    } else {
      row.insert(row.end(), {FitnessCell(value.a), IntervalCell(value.interval), value.effect, value.effect,
                             value.exceeds, value.p, DigitsCell(value.p_holm, 2)});
    }
    table.AddRow(std::move(row));
  }
  return table;
}

Table ConsistencyTable(const TuningResult& tuning) {
  Table table(
      {{">repeats in a set", "repeats"}, {">median A", "median_a"}, {">largest A", "max_a"}, {"difference"}});
  for (const analysis::Consistency& one : tuning.consistency)
    table.AddRow(
        {one.size, FitnessCell(one.median_a), FitnessCell(one.max_a), analysis::EffectOf(one.max_a)});
  return table;
}

std::string PublishedNotes::Mark(const std::string& note) {
  if (note.empty()) return "";
  const auto found = std::ranges::find(notes_, note);
  const auto number = found - notes_.begin() + 1;
  if (found == notes_.end()) notes_.push_back(note);
  return fmt::format("{}", number);
}

Table PublishedTable(const std::vector<JudgedRow>& rows, PublishedNotes& notes, const std::string& analysis) {
  Table table({{"published in", "section"},
               {"what", "quantity"},
               {"of", "condition"},
               {">published", "published"},
               {">ours", "ours"},
               {"verdict", "verdict"},
               {">note", "note"},
               ForPrograms("analysis")});
  for (const JudgedRow& row : rows) {
    table.AddRow({row.row.section, row.row.quantity, row.row.condition, row.row.value,
                  row.ours.empty() ? Cell() : row.ours, row.verdict,
                  Cell(notes.Mark(row.note), TextValue(row.note)), TextCell(analysis)});
  }
  return table;
}

}  // namespace gauntlet
