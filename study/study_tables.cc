#include "study/study_tables.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/duration_text.h"
#include "base/number_text.h"

namespace gauntlet {

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
  return fmt::format(
      "Of {} published figures {} agree with ours, {} differ, {} stand beside ours without being judged, and "
      "{} have no counterpart here.",
      all, tally["agrees"], tally["differs"], tally["not judged"], tally["not computed"]);
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

StudyTable ClaimTable(const StudyReport& report) {
  StudyTable table{{"claim", "verdict", "figures"}, {}};
  for (const StudySection& section : report.sections) {
    if (!section.claim) continue;
    table.rows.push_back({section.claim->text, section.claim->holds ? "holds" : "DOES NOT HOLD",
                          section.sentences.empty() ? "" : section.sentences.front()});
  }
  return table;
}

StudyTable PartTable(const StudyReport& report) {
  StudyTable table{{"part", ">searches", ">runs", ">distinct cases", ">CPU time of its runs"}, {}};
  PartCost all{"all"};
  for (const PartCost& part : report.parts) all += part;
  const auto add = [&](const PartCost& part) {
    table.rows.push_back({part.part, FormatCount(part.searches), FormatCount(part.runs),
                          FormatCount(part.distinct_cases), FormatDuration(part.cpu_seconds)});
  };
  for (const PartCost& part : report.parts) add(part);
  if (report.parts.size() > 1) add(all);
  return table;
}

std::string PublishedNotes::Mark(const std::string& note) {
  if (note.empty()) return "";
  const auto found = std::ranges::find(notes_, note);
  const auto number = found - notes_.begin() + 1;
  if (found == notes_.end()) notes_.push_back(note);
  return fmt::format("{}", number);
}

StudyTable PublishedTable(const std::vector<JudgedRow>& rows, PublishedNotes& notes) {
  StudyTable table{{"published in", "what", "of", ">published", ">ours", "verdict", ">note"}, {}};
  for (const JudgedRow& row : rows) {
    table.rows.push_back({row.row.section, row.row.quantity, row.row.condition, row.row.value,
                          row.ours.empty() ? "-" : row.ours, row.verdict, notes.Mark(row.note)});
  }
  return table;
}

}  // namespace gauntlet
