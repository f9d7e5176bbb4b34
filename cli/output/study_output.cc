#include "cli/output/study_output.h"

#include <algorithm>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/output/table.h"
#include "cli/output/tuning_output.h"
#include "proto/json_text.h"
#include "study/study_tables.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kWidth = 110;

std::string TextOf(const StudyTable& table) {
  Table text(table.headers);
  for (const auto& row : table.rows) text.AddRow(row);
  return text.ToText();
}

std::string Escaped(const std::string& cell) {
  std::string text;
  for (const char c : cell) {
    if (c == '|') text += '\\';
    text += c;
  }
  return text;
}

std::string MarkdownOf(const StudyTable& table) {
  std::string names;
  std::string line;
  for (const std::string& header : table.headers) {
    const bool right = header.starts_with('>');
    names += fmt::format("| {} ", right ? header.substr(1) : header);
    line += right ? "|---:" : "|---";
  }
  std::string text = names + "|\n" + line + "|\n";
  for (const auto& row : table.rows) {
    for (const std::string& cell : row) text += fmt::format("| {} ", Escaped(cell));
    text += "|\n";
  }
  return text + "\n";
}

std::string NotesText(const PublishedNotes& notes, std::size_t indent) {
  std::string text;
  for (std::size_t i = 0; i < notes.all().size(); ++i) {
    text += fmt::format("{}{}. {}\n", std::string(indent, ' '), i + 1,
                        indent > 0 ? Wrapped(notes.all()[i], kWidth, indent + 3) : notes.all()[i]);
  }
  return text;
}

}  // namespace

std::string StudyText(const StudyReport& report) {
  std::string text = fmt::format("{}: {}\n\n", report.name, report.description);
  for (const StudySection& section : report.sections) {
    text += fmt::format("{} ({})\n\n", section.title, section.name);
    for (const StudyTable& table : section.tables) text += TextOf(table) + "\n";
    for (const std::string& sentence : section.sentences) {
      text += fmt::format("  {}\n", Wrapped(sentence, kWidth, 2));
    }
    if (section.claim) {
      text +=
          fmt::format("  {}: {}\n", section.claim->text, section.claim->holds ? "holds" : "DOES NOT HOLD");
    }
    text += "\n";
    if (section.published.empty()) continue;
    PublishedNotes notes;
    text += TextOf(PublishedTable(section.published, notes)) + NotesText(notes, 2) + "\n";
  }
  if (!report.elsewhere.empty()) {
    PublishedNotes notes;
    text += "Published figures that have no counterpart here\n\n" +
            TextOf(PublishedTable(report.elsewhere, notes)) + NotesText(notes, 2) + "\n";
  }
  text += "What it has cost\n\n" + TextOf(PartTable(report)) + "\n  " + TimeInWords(report) + "\n\n";
  StudyTable claims = ClaimTable(report);
  for (auto& row : claims.rows) row.pop_back();
  claims.headers.pop_back();
  if (!claims.rows.empty()) text += "Claims\n\n" + TextOf(claims) + "\n";
  if (const std::string tally = TallyInWords(report); !tally.empty()) text += fmt::format("  {}\n", tally);
  return text;
}

std::string StudyMarkdown(const StudyReport& report) {
  std::string text = fmt::format("# {}\n\n{}\n\nWritten by `gauntlet {} --markdown FILE` (version {}).\n\n",
                                 report.name, report.description, report.command, report.version);
  if (const StudyTable claims = ClaimTable(report); !claims.rows.empty())
    text += "## Claims\n\n" + MarkdownOf(claims);
  if (const std::string tally = TallyInWords(report); !tally.empty()) {
    text += tally + "\n\nHow a figure is judged:\n\n";
    for (const std::string& rule : RulesInWords()) text += fmt::format("- {}\n", rule);
    text += "\n";
  }
  text += fmt::format("## Cost\n\n{}{}\n\n", MarkdownOf(PartTable(report)), TimeInWords(report));
  for (const StudySection& section : report.sections) {
    text += fmt::format("## {}\n\n", section.title);
    for (const StudyTable& table : section.tables) text += MarkdownOf(table);
    for (const std::string& sentence : section.sentences) text += sentence + "\n\n";
    if (section.claim) {
      text +=
          fmt::format("**{}: {}.**\n", section.claim->text, section.claim->holds ? "holds" : "does not hold");
      text += "\n";
    }
    if (section.published.empty()) continue;
    PublishedNotes notes;
    text += MarkdownOf(PublishedTable(section.published, notes));
    if (!notes.all().empty()) text += NotesText(notes, 0) + "\n";
  }
  if (report.elsewhere.empty()) return text;
  PublishedNotes notes;
  text += "## Published figures that have no counterpart here\n\n" +
          MarkdownOf(PublishedTable(report.elsewhere, notes));
  return text + NotesText(notes, 0);
}

std::string StudyJson(const StudyReport& report, const std::string& directory) {
  Json claims = Json::array();
  Json results = Json::array();
  const auto add = [&](const std::string& analysis, const std::vector<JudgedRow>& rows) {
    for (const JudgedRow& row : rows) {
      results.push_back({{"section", row.row.section},
                         {"quantity", row.row.quantity},
                         {"condition", row.row.condition},
                         {"published", row.row.value},
                         {"ours", row.ours.empty() ? Json() : Json(row.ours)},
                         {"verdict", row.verdict},
                         {"note", row.note.empty() ? Json() : Json(row.note)},
                         {"analysis", analysis.empty() ? Json() : Json(analysis)}});
    }
  };
  for (const StudySection& section : report.sections) {
    if (section.claim)
      claims.push_back(
          {{"analysis", section.name}, {"claim", section.claim->text}, {"holds", section.claim->holds}});
    add(section.name, section.published);
  }
  add("", report.elsewhere);
  Json tunings = Json::array();
  for (const StudySection& section : report.sections) {
    if (section.tuning) tunings.push_back(TuningJson(section));
  }
  Json figures = Json::object();
  for (const auto& [name, figure] : report.figures) {
    figures[name] = figure.number ? Json(*figure.number) : Json(figure.text);
  }
  Json parts = Json::array();
  for (const PartCost& part : report.parts) {
    parts.push_back({{"part", part.part},
                     {"searches", part.searches},
                     {"runs", part.runs},
                     {"distinct_cases", part.distinct_cases},
                     {"cpu_seconds", part.cpu_seconds}});
  }
  return JsonText({{"study", report.name},
                   {"directory", directory},
                   {"version", report.version},
                   {"claims", std::move(claims)},
                   {"results", std::move(results)},
                   {"figures", std::move(figures)},
                   {"tunings", std::move(tunings)},
                   {"parts", std::move(parts)},
                   {"search_seconds", report.searching.seconds},
                   {"evaluation_seconds", report.evaluating.seconds}});
}

}  // namespace gauntlet
