#include "cli/output/study_output.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "proto/json_text.h"
#include "study/study_tables.h"

namespace gauntlet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kWidth = 110;

// Tells the parts of a study's report one after the other, for a terminal or as Markdown.
class StudyWriter {
 public:
  explicit StudyWriter(bool markdown) : markdown_(markdown) {}

  void Heading(const std::string& title, const std::string& name = "") {
    text_ += markdown_ ? fmt::format("## {}\n\n", title)
                       : fmt::format("{}{}\n\n", title, name.empty() ? "" : fmt::format(" ({})", name));
  }
  void Add(const Table& table) { text_ += markdown_ ? table.ToMarkdown() : table.ToText() + "\n"; }
  void Add(const std::string& sentence) {
    text_ += markdown_ ? sentence + "\n\n" : fmt::format("  {}\n", Wrapped(sentence, kWidth, 2));
  }

  void Add(const StudySection& section) {
    Heading(section.title, section.name);
    for (const Table& table : section.tables) Add(table);
    for (const std::string& sentence : section.sentences) Add(sentence);
    if (section.claim) {
      const auto& [claim, holds] = *section.claim;
      text_ += markdown_ ? fmt::format("**{}: {}.**\n\n", claim, holds ? "holds" : "does not hold")
                         : fmt::format("  {}: {}\n", claim, holds ? "holds" : "DOES NOT HOLD");
    }
    if (!markdown_) text_ += "\n";
    Add(section.published);
  }

  void Add(const std::vector<JudgedRow>& published) {
    if (published.empty()) return;
    PublishedNotes notes;
    const Table table = PublishedTable(published, notes);
    text_ += markdown_ ? table.ToMarkdown() : table.ToText();
    for (std::size_t i = 0; i < notes.all().size(); ++i) {
      const std::string& note = notes.all()[i];
      text_ += fmt::format("{}{}. {}\n", markdown_ ? "" : "  ", i + 1,
                           markdown_ ? note : Wrapped(note, kWidth, 5));
    }
    if (!markdown_ || !notes.all().empty()) text_ += "\n";
  }

  void AddElsewhere(const StudyReport& report) {
    if (report.elsewhere.empty()) return;
    Heading("Published figures that have no counterpart here");
    Add(report.elsewhere);
  }

  std::string text_;

 private:
  bool markdown_;
};

Json TuningJson(const StudySection& section) {
  const TuningResult& tuning = *section.tuning;
  Json parameters = Json::array();
  for (const TriedParameter& parameter : tuning.parameters) {
    parameters.push_back({{"key", parameter.key},
                          {"baseline", parameter.baseline},
                          {"recommended", parameter.recommended},
                          {"evidence", parameter.evidence},
                          {"values", ValueTable(parameter).ToJson()}});
  }
  return {{"analysis", section.name},
          {"parameters", std::move(parameters)},
          {"consistency", ConsistencyTable(tuning).ToJson()},
          {"enough", tuning.enough ? Json(*tuning.enough) : Json()},
          {"enough_in_words", tuning.enough_in_words},
          {"p_by", tuning.p_by}};
}

}  // namespace

std::string StudyText(const StudyReport& report) {
  StudyWriter writer(/*markdown=*/false);
  writer.text_ = fmt::format("{}: {}\n\n", report.name, report.description);
  for (const StudySection& section : report.sections) writer.Add(section);
  writer.AddElsewhere(report);
  writer.Heading("What it has cost");
  writer.Add(PartTable(report));
  writer.text_ += fmt::format("  {}\n\n", TimeInWords(report));
  if (const Table claims = ClaimTable(report); !claims.empty()) {
    writer.Heading("Claims");
    writer.Add(claims);
  }
  const std::string tally = TallyInWords(report);
  return tally.empty() ? writer.text_ : fmt::format("{}  {}\n", writer.text_, tally);
}

std::string StudyMarkdown(const StudyReport& report) {
  StudyWriter writer(/*markdown=*/true);
  writer.text_ = fmt::format("# {}\n\n{}\n\nWritten by `gauntlet {} --markdown FILE` (version {}).\n\n",
                             report.name, report.description, report.command, report.version);
  if (const Table claims = ClaimTable(report, /*with_figures=*/true); !claims.empty()) {
    writer.Heading("Claims");
    writer.Add(claims);
  }
  if (const std::string tally = TallyInWords(report); !tally.empty()) {
    writer.Add(tally);
    writer.text_ += "How a figure is judged:\n\n";
    for (const std::string& rule : RulesInWords()) writer.text_ += fmt::format("- {}\n", rule);
    writer.text_ += "\n";
  }
  writer.Heading("Cost");
  writer.text_ += PartTable(report).ToMarkdown();
  writer.Add(TimeInWords(report));
  for (const StudySection& section : report.sections) writer.Add(section);
  writer.AddElsewhere(report);
  return writer.text_.substr(0, writer.text_.find_last_not_of('\n') + 2);
}

std::string StudyJson(const StudyReport& report, const std::string& directory) {
  Json results = Json::array();
  Json tunings = Json::array();
  const auto add = [&](const std::vector<JudgedRow>& rows, const std::string& analysis) {
    PublishedNotes notes;
    for (Json& row : PublishedTable(rows, notes, analysis).ToJson()) results.push_back(std::move(row));
  };
  for (const StudySection& section : report.sections) {
    add(section.published, section.name);
    if (section.tuning) tunings.push_back(TuningJson(section));
  }
  add(report.elsewhere, "");
  Json figures = Json::object();
  for (const auto& [name, figure] : report.figures) {
    figures[name] = JsonValue(figure.value);
  }
  return JsonText({{"study", report.name},
                   {"directory", directory},
                   {"version", report.version},
                   {"claims", ClaimTable(report).ToJson()},
                   {"results", std::move(results)},
                   {"figures", std::move(figures)},
                   {"tunings", std::move(tunings)},
                   {"parts", PartTable(report, /*with_all=*/false).ToJson()},
                   {"search_seconds", report.searching.seconds},
                   {"evaluation_seconds", report.evaluating.seconds}});
}

}  // namespace gauntlet
